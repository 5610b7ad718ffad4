// What the rasterizer's fragment shader makes of the hits of pixel rays: the same shader, with weights that come from
// rays instead of edge functions. The footprint of a texture comes from the rays of the pixel's 2x2 block, as there.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/functional/shader.hpp"
#include "reports/truth/pixel_rays.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace reports {

class HitShading {
  public:
    /// For the colours that the frame needs. All three outlive it.
    HitShading(const pipeline::Frame& frame, const RayScene& scene, const PixelRays& rays);

    struct Shaded {
        glm::vec4 colour{0.0F}; ///< linear RGBA; a cosine where the frame asks for it; 0 where it needs none
        glm::dvec3 normal{0.0}; ///< in the world, of unit length or 0; 0 where the frame needs none
        bool alive = true;      ///< not discarded by the alpha test
        std::array<glm::vec4, 4> texcoords{}; ///< these three: see traces::FrameSurface
        glm::vec4 tangent{0.0F};
        std::uint32_t lane = 0;
    };
    Shaded operator()(const RayHit& hit, std::uint32_t x, std::uint32_t y) const;
    /// Of any ray, textures read in their finest level.
    Shaded operator()(const RayHit& hit) const;

  private:
    pipeline::CornerWeights weights(const RayHit& hit, std::uint32_t x, std::uint32_t y) const;
    Shaded shaded(const RayHit& hit, const pipeline::CornerWeights& weights, std::uint32_t lane) const;

    const RayScene& scene_;
    const PixelRays& rays_;
    glm::dmat3 to_world_;                           ///< of normals
    std::vector<pipeline::FragmentShader> shaders_; ///< by mesh
};

} // namespace reports
