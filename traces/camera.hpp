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
///   32 numbers            view and projection matrix, column by column, as view_text() writes them
/// The projection is that of OpenGL (-w <= z <= w, y up); the pipeline makes the top row number 0. Planes of a scene's
/// camera that are so far apart that the scene has fewer than 4,096 distinct depths of 24 bits between them are moved
/// to what encloses the scene; `notes`, where there are any, then gets a line. Throws sim::InputError for an unknown
/// camera, impossible numbers, or a size outside 1 to 16384 pixels.
pipeline::View make_view(const Scene& scene, const std::string& camera, std::uint32_t width, std::uint32_t height,
                         std::vector<std::string>* notes = nullptr);

/// The view as make_view() takes it: for the same size, the same picture.
std::string view_text(const pipeline::View& view);

} // namespace traces
