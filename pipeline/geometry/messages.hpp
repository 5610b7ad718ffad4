// What travels between the stages of the geometry front.
//
// A `range` is one instance of one draw: an index into the ranges of the pass (geometry_pass.hpp). Primitives and
// triangles are numbered as in the stream. A shaded vertex is known by its sequence number: the running count of vertex
// shader runs, beginning with 1.
#pragma once

#include <array>
#include <cstdint>

namespace pipeline {

/// Command processor -> index fetch.
struct DrawCommand {
    std::uint32_t range = 0;
};

/// Index fetch -> vertex reuse: a primitive with the numbers of its vertices within the draw's geometry.
struct IndexedPrimitive {
    std::uint32_t primitive = 0;
    std::uint32_t range = 0;
    std::array<std::uint32_t, 3> vertices{}; ///< lines and points repeat their last one
    std::uint32_t index_bytes = 0;           ///< read for this primitive and not for the one before
};

/// Vertex reuse -> vertex fetch: a vertex that has to be shaded, or only index bytes that pass the input port.
struct VertexRequest {
    std::uint32_t sequence = 0; ///< 0: no vertex
    std::uint32_t range = 0;
    std::uint32_t vertex = 0;
    std::uint32_t index_bytes = 0; ///< read since the request before this one
};

/// Vertex reuse -> primitive assembly: a primitive with the sequence numbers of its shaded vertices.
struct ReusedPrimitive {
    std::uint32_t primitive = 0;
    std::uint32_t range = 0;
    std::array<std::uint32_t, 3> sequences{};
};

/// Vertex fetch -> vertex shader -> primitive assembly; in order of the sequence numbers.
struct VertexTask {
    std::uint32_t sequence = 0;
    std::uint32_t instructions = 0; ///< of its shader; 0: of the fixed transformation. Not behind the shader units
};

/// Primitive assembly -> clipping and culling.
struct AssembledPrimitive {
    std::uint32_t primitive = 0;
    std::uint32_t range = 0;
};

/// Clipping and culling -> triangle setup -> rasterizer: an index into FragmentStream::triangles.
struct TriangleTask {
    std::uint32_t triangle = 0;
};

} // namespace pipeline
