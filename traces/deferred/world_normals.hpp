// What the shaders of deferred shading share: normals in the world, and what counts as transparent.
#pragma once

#include "pipeline/functional/number_formats.hpp"
#include "pipeline/shader.hpp"
#include "traces/deferred/shaders.hpp"

#include <array>

namespace traces {

constexpr unsigned even_rows = 0b0011; ///< of a quad

/// As eight bits keep it.
inline bool is_transparent(float opacity) { return pipeline::float_to_unorm8(opacity) < 255; }

inline unsigned transparent_pixels(const pipeline::QuadTexels& colours) {
    unsigned pixels = 0;
    for (std::size_t i = 0; i < 4; ++i) pixels |= (is_transparent(colours[i].a) ? 1U : 0U) << i;
    return pixels;
}

inline pipeline::QuadTexels with_opacity(pipeline::QuadTexels colours, const DeferredDraw& draw) {
    for (glm::vec4& colour : colours) colour.a *= draw.opacity;
    return colours;
}

/// Normals of the surfaces of a frame, in the world, from [-1,1] to [0,1]; back faces of double-sided ones turned over.
class WorldNormals {
  public:
    explicit WorldNormals(const pipeline::Frame& frame) : to_world_(glm::transpose(glm::mat3(frame.view.view))) {}

    /// `normals`: of the quad, in eye space.
    std::array<glm::vec3, 4> codes(const pipeline::QuadTexels& normals, bool front, const DeferredDraw& draw) const {
        const float side = draw.turned_over(front) ? -0.5F : 0.5F;
        std::array<glm::vec3, 4> codes;
        for (std::size_t i = 0; i < 4; ++i) codes[i] = to_world_ * glm::vec3(normals[i]) * side + 0.5F;
        return codes;
    }

  private:
    glm::mat3 to_world_;
};

} // namespace traces
