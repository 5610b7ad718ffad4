// The vertices of a draw, as geometries of a recording.
#pragma once

#include "traces/recording/import/surfaces.hpp"

#include <functional>
#include <map>
#include <string>
#include <unordered_map>

namespace traces::recorded {

struct GeometryRequest {
    bool flat = false;     ///< the last vertex of each of a quad's triangles is to be the quad's
    bool numbers = false;  ///< the shader asks for the number of its vertex
    std::uint32_t fog = 0; ///< pipeline::Semantic of the fog coordinate
};

class GeometryImport {
  public:
    GeometryImport(pipeline::Resources& resources, const Blobs& blobs, const Count& count)
        : resources_(resources), blobs_(blobs), count_(count) {}

    /// Number of the geometry, the same for equal vertices; nothing for what cannot be drawn, which is counted.
    std::optional<std::uint32_t> number_of(const record_stream::Geometry& geometry, const GeometryRequest& request);

  private:
    struct Indices;

    std::optional<std::uint32_t> make(const record_stream::Geometry& geometry, const GeometryRequest& request);
    Indices read_indices(const record_stream::Geometry& geometry) const;
    void set_indices(pipeline::Geometry& result, const record_stream::Geometry& geometry, const Indices& indices);
    bool add_array(pipeline::Geometry& result, const record_stream::Geometry& geometry,
                   const record_stream::Array& array, const GeometryRequest& request);
    std::uint32_t buffer_of(std::int32_t blob);
    std::uint32_t add_buffer(std::vector<std::byte> bytes);

    pipeline::Resources& resources_;
    const Blobs& blobs_;
    const Count& count_;
    std::map<std::int32_t, std::uint32_t> buffers_;
    std::unordered_map<std::string, std::optional<std::uint32_t>> known_;
};

/// pipeline::Semantic of an attribute.
std::uint32_t semantic_of(std::uint32_t slot, std::uint32_t fog);

} // namespace traces::recorded
