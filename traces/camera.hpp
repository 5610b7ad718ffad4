// From where a scene is seen.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/scene.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

/// Finite numbers with commas between them; nothing when the text is anything else.
std::optional<std::vector<double>> numbers_in(std::string_view text);

/// The view on a scene. `camera` is one of
///   auto                  the scene's first camera; without one, a camera that sees the whole bounding sphere
///   (vertical
///                         field of view 45 degrees); a screen-space scene is mapped to the pixels it names
///   N                     camera number N of the scene, counted from 0
///   ex,ey,ez,tx,ty,tz,fovy  eye, target and vertical field of view in degrees; y is up; near and far enclose the scene
/// The projection is that of OpenGL (-w <= z <= w, y up); the pipeline makes the top row number 0.
/// Throws sim::InputError for an unknown camera, impossible numbers, or a size outside 1 to 16384 pixels.
pipeline::View make_view(const Scene& scene, const std::string& camera, std::uint32_t width, std::uint32_t height);

} // namespace traces
