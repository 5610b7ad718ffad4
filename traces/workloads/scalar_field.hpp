// Scenes as fields: a scalar at the vertices, in the red of their colours.
#pragma once

#include "pipeline/frame.hpp"
#include "traces/scene.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace traces {

struct ScalarRange {
    float lo = 0, hi = 0;
};

/// Least and largest scalar of the drawn geometries. Throws sim::InputError, beginning with `place`, when one of them
/// has no vertex colours, or scalars that a colour cannot hold.
ScalarRange scalar_range(const pipeline::Frame& frame, std::string_view place);

/// A parameter in the scene's own scalars as the scalar of a fragment.
float fragment_scalar(const Scene& scene, float value);

/// Iso-values as scalars of fragments, the middle of the range for none. Those that no surface can have, outside of the
/// range, are noted in the frame.
std::vector<float> iso_values_of(pipeline::Frame& frame, const Scene& scene, const std::vector<float>& wanted,
                                 ScalarRange range);

/// Changes the frame's resources (its own from now on) so that fragments carry their scalar unchanged: materials are
/// unlit, white, opaque and without textures. With `sorted`, the triangles of every draw are in the order of the
/// distance of their centroids, the nearest first; those of several instances in the order of the first one (Bavoil
/// 2007, section 6.3; specification 004, A8).
void prepare_scalars(pipeline::Frame& frame, bool sorted);

/// The longest edge of a drawn triangle, in world space: no gap between two faces of a tetrahedron is longer.
float longest_edge(const pipeline::Frame& frame);

/// Blue over yellow to red for shares from 0 to 1; linear RGB.
glm::vec3 colour_of_share(double share);

} // namespace traces
