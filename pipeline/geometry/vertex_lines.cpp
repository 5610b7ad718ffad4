#include "pipeline/geometry/vertex_lines.hpp"

#include <algorithm>
#include <bit>

namespace pipeline {

bool reads_attribute(const Needs& needs, const Material& material, Semantic semantic) {
    if ((needs.attributes & mask_of(semantic)) != 0) return true;
    switch (slot_of(semantic)) {
    case Slot::position:
        return true;
    case Slot::normal:
        return needs.normals;
    case Slot::colour:
        return needs.vertex_colours && semantic == Semantic::colour;
    case Slot::texcoord:
        return (needs.texcoords && semantic == texcoord(material.texcoord)) ||
               (needs.map_texcoords && material.maps.read(static_cast<std::uint32_t>(semantic) -
                                                          static_cast<std::uint32_t>(Semantic::texcoord0)));
    case Slot::generic:
        break;
    }
    return false;
}

VertexLines::VertexLines(const Resources& resources, const Geometry& geometry, const Material& material,
                         const Needs& needs, std::uint32_t line, std::uint32_t instance)
    : line_shift_(static_cast<unsigned>(std::countr_zero(line))) {
    for (const VertexAttribute& attribute : geometry.attributes) {
        if (!reads_attribute(needs, material, attribute.semantic)) continue;
        Stream stream{resources.buffers[attribute.buffer].address + attribute.offset, attribute.stride,
                      attribute.bytes()};
        if (attribute.divisor != 0) {
            stream.address += std::uint64_t{attribute.stride} * (instance / attribute.divisor);
            stream.stride = 0;
        }
        streams_.push_back(stream);
    }
    // Attributes that lie side by side share lines; in order of address a shared one is the last line listed.
    std::sort(streams_.begin(), streams_.end(), [](const Stream& a, const Stream& b) { return a.address < b.address; });
}

void VertexLines::begin(std::uint32_t vertex) {
    vertex_ = vertex;
    stream_ = 0;
    line_ = end_line_ = 0;
}

bool VertexLines::more() {
    while (line_ == end_line_) {
        if (stream_ == streams_.size()) return false;
        const Stream& stream = streams_[stream_];
        const std::uint64_t first = stream.address + std::uint64_t{vertex_} * stream.stride;
        const std::uint64_t end = ((first + stream.bytes - 1) >> line_shift_) + 1;
        line_ = first >> line_shift_;
        if (stream_ > 0 && line_ + 1 == end_line_) ++line_; // listed for the attribute before
        end_line_ = end;
        ++stream_;
    }
    return true;
}

double VertexLines::mean_lines() const {
    const double line = static_cast<double>(std::uint64_t{1} << line_shift_);
    double lines = 0;
    for (std::size_t i = 0; i < streams_.size(); ++i) {
        const Stream& stream = streams_[i];
        if (stream.stride == 0) continue; // one line for all vertices
        const bool beside = i > 0 && stream.stride == streams_[i - 1].stride &&
                            stream.address - streams_[i - 1].address < stream.stride;
        // A record of b bytes at any multiple of its alignment lies in 1 + (b - alignment) / line lines; one that
        // follows another in the same line adds its bytes only.
        lines += beside ? stream.bytes / line : 1 + (stream.bytes - std::min<double>(4, stream.bytes)) / line;
    }
    return lines;
}

} // namespace pipeline
