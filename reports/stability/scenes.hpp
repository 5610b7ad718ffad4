// Small scenes that cases state themselves, and what becomes of them before any hardware.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/functional/front_end.hpp"
#include "reports/images.hpp"
#include "traces/scene.hpp"

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace reports::stability {

/// Corners: x and y in pixels from the top left corner of the viewport, z the window depth.
struct ScreenTriangle {
    glm::vec3 a, b, c;
};

/// One draw of these triangles, in this order, each with a colour of its own; not indexed.
traces::Scene screen_scene(const std::vector<ScreenTriangle>& triangles);

/// The two triangles of [x0,x1] x [y0,y1] at a depth.
std::array<ScreenTriangle, 2> rectangle(float x0, float y0, float x1, float y1, float depth);

/// Layers of the whole viewport at these depths, one behind the other in this order.
traces::Scene layers_of(std::uint32_t width, std::uint32_t height, std::span<const float> depths);

/// One draw of triangles in world space: three positions each, double-sided, unlit and white.
traces::Scene world_scene(const std::vector<glm::vec3>& positions);

/// Pixels are clip space: x_clip = 2 x / width - 1 ..., for triangles that are given in pixels and window depth.
pipeline::View pixel_view(std::uint32_t width, std::uint32_t height);
/// From the origin along -z; `far` of 0 is none.
pipeline::View perspective_view(std::uint32_t width, std::uint32_t height, double fovy_degrees, double near,
                                double far);

/// All draws, rasterized and shaded; the scene need not have been finished.
pipeline::FragmentStream rasterized(traces::Scene& scene, const pipeline::View& view);

/// Covered fragments of every pixel; the most of them, and their sum.
std::vector<std::uint32_t> coverage(const pipeline::FragmentStream& stream);
std::uint32_t most_covered(const pipeline::FragmentStream& stream);

/// Depths in [0,1] and colours that are finite, of covered and uncovered pixels alike.
bool all_finite(const pipeline::FragmentStream& stream);

/// Fragments per pixel: none grey, one white, more red.
Picture coverage_picture(const pipeline::FragmentStream& stream);
/// Linear RGBA.
Picture picture_of(std::uint32_t width, std::uint32_t height, std::span<const float> rgba);

} // namespace reports::stability
