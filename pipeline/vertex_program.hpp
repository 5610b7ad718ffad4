// The contract of a vertex program: what it makes of the vertices of a draw, in place of the matrices of its instances.
//
// Modelled: positions, sizes of points, distances to the user's planes, varyings, instructions, of which the time of
// the vertex shader units follows (geometry/vertex_shader.hpp). It must be a pure function of what it was made of.
#pragma once

#include "pipeline/functional/clip.hpp"

#include <cstdint>
#include <glm/vec4.hpp>
#include <span>

namespace pipeline {

inline constexpr std::uint32_t most_varyings = 64;

struct VertexProgramShape {
    std::uint32_t varyings = 0;      ///< vectors that fragments are given, interpolated; at most `most_varyings`
    std::uint64_t flat = 0;          ///< bit i: fragments take varying i from the provoking vertex
    std::uint64_t linear = 0;        ///< bit i: else varying i is linear on the screen, not in perspective
    std::uint8_t clip_distances = 0; ///< bit i: it measures the distance to plane i
    bool point_size = false;         ///< it gives points their size
};

/// What it makes of some vertices, each list with as many as there are vertices, or as many for each.
struct ProgramVertices {
    std::span<glm::vec4> positions;     ///< in clip space
    std::span<glm::vec4> varyings;      ///< as many for each as the shape says
    std::span<float> point_sizes;       ///< empty where the shape has none
    std::span<ClipDistances> distances; ///< 0 on entry; empty where no plane cuts
    /// That each took; 0 on entry, and of programs that do not count. Empty where nobody asks.
    std::span<std::uint32_t> instructions{};
};

class VertexProgram {
  public:
    virtual ~VertexProgram() = default;
    virtual VertexProgramShape shape() const = 0;
    /// Vertices from number `first` on, of an instance; by several threads at the same time.
    virtual void run(std::uint32_t instance, std::uint32_t first, const ProgramVertices& vertices) const = 0;
};

} // namespace pipeline
