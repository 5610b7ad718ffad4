// Which lines of memory a vertex lies in: the bytes of the attributes that are read, in order of address.
#pragma once

#include "pipeline/frame.hpp"

#include <cstdint>
#include <vector>

namespace pipeline {

/// True when a frame with these needs reads the attribute in draws of `material`.
bool reads_attribute(const Needs& needs, const Material& material, Semantic semantic);

/// Lists the lines of one vertex after the other. Lines that neighbouring attributes share are listed once.
class VertexLines {
  public:
    VertexLines() = default;
    /// @param line bytes of a line; a power of two
    /// @param instance whose elements attributes with a divisor have
    VertexLines(const Resources& resources, const Geometry& geometry, const Material& material, const Needs& needs,
                std::uint32_t line, std::uint32_t instance = 0);

    void begin(std::uint32_t vertex);
    /// Ends the list of the present vertex.
    void end() { stream_ = streams_.size(), line_ = end_line_ = 0; }
    /// Whether there is a further line; then line() is its number, the address divided by the size of a line.
    bool more();
    std::uint64_t line() const { return line_; }
    void next() { ++line_; }

    std::size_t streams() const { return streams_.size(); }
    /// Lines that a vertex lies in, on average over all places that its attributes can have within a line.
    double mean_lines() const;

  private:
    /// Bytes of vertex 0 of one attribute, and the distance to those of vertex 1: 0 where it advances by instances.
    struct Stream {
        std::uint64_t address = 0;
        std::uint32_t stride = 0;
        std::uint32_t bytes = 0;
    };

    std::vector<Stream> streams_; ///< by address
    unsigned line_shift_ = 0;
    std::uint32_t vertex_ = 0;
    std::size_t stream_ = 0;     ///< first stream whose lines are not listed yet
    std::uint64_t line_ = 0;     ///< next line
    std::uint64_t end_line_ = 0; ///< one past the last line of the stream before stream_
};

} // namespace pipeline
