// Pixels of which neither rays nor a rasterizer can say for certain what they show.
#pragma once

#include "pipeline/frame.hpp"
#include "reports/truth/ray_scene.hpp"
#include "reports/truth/truth.hpp"

#include <cstdint>
#include <span>

namespace reports {

/// A silhouette this near to a pixel's centre may lie on its other side for a rasterizer, whose corners lie on a grid
/// of this size [pixels].
inline constexpr double silhouette_grid = 1.0 / 256.0;
/// Surfaces that lie within this share of their distance of each other are coplanar: which comes first is a tie.
inline constexpr double coplanar_share = 1e-5;

/// Marks those of `pixels` as doubtful whose ray sees other surfaces when it is moved by the grid in any of four
/// directions, or two surfaces that are coplanar. `scene` has the draws of the frame.
void mark_uncertain(Truth& truth, const pipeline::Frame& frame, const RayScene& scene,
                    const traces::TruthMethod& method, std::span<const std::uint32_t> pixels);

} // namespace reports
