// The fragments of a frame as rays find them: all of a pixel, from front to back, however many there are.
//
// Modelled: which draws each pass has, culling, alpha test, shading; an opaque surface hides what lies behind it.
// Not modelled: depth formats and the coverage rule; a pixel sees what the ray through its centre meets.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/functional/cull_and_clip.hpp"
#include "reports/truth/hit_shading.hpp"

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace reports {

using traces::FrameSurface;
using traces::PixelSurfaces;

/// Hits nearer to an edge than this, in barycentric coordinates, are doubtful; and those with a smaller |cos|.
inline constexpr double doubtful_edge = 1e-3;
inline constexpr float doubtful_cosine = 0.02F;

class FrameSurfaces {
  public:
    /// See traces::TruthMethod.
    using Hides = std::function<bool(const FrameSurface&)>;

    /// The first three outlive it.
    FrameSurfaces(const pipeline::Frame& frame, const RayScene& scene, const PixelRays& rays, Hides hides = {});

    /// `hits`: of the pixel's ray, nearest first. `surfaces` is overwritten.
    void find(std::span<const RayHit> hits, std::uint32_t x, std::uint32_t y, PixelSurfaces& surfaces) const;
    /// What a view along the ray sees at a hit; see traces::Rays.
    std::optional<FrameSurface> along_ray(const RayHit& hit) const;

  private:
    enum class Role : std::uint8_t { none, layer, opaque };
    struct DrawRole {
        Role role = Role::none;
        bool both_faces = false;
    };
    bool culled(const RayHit& hit, bool counter_clockwise) const;

    std::vector<DrawRole> roles_;            ///< by draw
    std::vector<pipeline::Culling> culling_; ///< by mesh, where not both faces are drawn
    bool view_mirrors_;
    const PixelRays& rays_;
    HitShading shading_;
    Hides hides_;
};

} // namespace reports
