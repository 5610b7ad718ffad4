// The position part of the vertex shader, the division by w and the viewport: from model space to the sub-pixel grid.
//
// Rounding is part of the contract, because coverage is exact: the order of operations is that of Mesa's llvmpipe
// (README, "Conventions"), so the two agree in every pixel.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/raster_state.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace pipeline {

inline constexpr int subpixel_bits = 8;
inline constexpr int subpixel_one = 1 << subpixel_bits; ///< sub-pixel units in a pixel

inline constexpr std::uint32_t largest_viewport = 16384; ///< pixels along one side
/// A viewport may begin so many pixels before and behind the view's first pixel.
inline constexpr std::int32_t farthest_viewport = 16384;
/// No vertex lies farther than this from the middle of the viewport, in pixels: what does is clipped.
inline constexpr float guard_band_pixels = 24576.0F;

/// Divisors are at least this: a vertex in the eye's own plane that survives near-plane clipping has w = z = 0.
inline constexpr float smallest_w = 0x1p-96F;

/// Where a vertex lies outside. The first six are the view volume; the others ask for clipping.
namespace outside {
inline constexpr std::uint32_t left = 1, right = 2, bottom = 4, top = 8, near = 16, far = 32;
inline constexpr std::uint32_t guard_left = 64, guard_right = 128, guard_bottom = 256, guard_top = 512;
inline constexpr std::uint32_t not_finite = 1024;
/// Where the distance to user plane i is negative.
constexpr std::uint32_t user_plane(std::uint32_t i) { return 2048U << i; }
inline constexpr std::uint32_t user_planes = user_plane(most_clip_distances) - user_plane(0);
inline constexpr std::uint32_t view_volume = left | right | bottom | top | near | far;
inline constexpr std::uint32_t must_clip =
    near | far | guard_left | guard_right | guard_bottom | guard_top | user_planes;
} // namespace outside

/// A transformed vertex.
struct ScreenVertex {
    glm::vec4 clip{};          ///< clip coordinates, y up
    std::int32_t x = 0, y = 0; ///< sub-pixel units from the centre of pixel (0, 0), y down; valid unless must_clip
    glm::vec2 window{};        ///< the same in pixels, before it was snapped
    float depth = 0;           ///< window depth within the state's range, of any size where depths are clamped
    std::uint32_t outside = 0; ///< bits of namespace outside
};

/// Pixels [left, right) x [top, bottom); none where an end does not lie behind its begin.
struct PixelBounds {
    std::int32_t left = 0, top = 0, right = 0, bottom = 0;

    bool empty() const { return left >= right || top >= bottom; }
    bool operator==(const PixelBounds&) const = default;
};

/// Where clip coordinates come to lie on the screen, and which of its pixels may be drawn.
class Viewport {
  public:
    /// One that fills a view of this size in pixels, 1 to largest_viewport.
    Viewport(std::uint32_t width, std::uint32_t height) : Viewport(width, height, RasterState{}) {}
    /// The viewport, scissor, depth range and depth clamp of a state, which is_usable(), in a view.
    Viewport(std::uint32_t view_width, std::uint32_t view_height, const RasterState& state);

    /// The pixels of the view that lie in the viewport: what is wholly outside of them is culled.
    const PixelBounds& visible() const { return visible_; }
    /// Those of them that the scissor leaves.
    const PixelBounds& drawn() const { return drawn_; }
    /// The pixels of the view that the scissor leaves, outside of the viewport, too.
    const PixelBounds& scissored() const { return scissored_; }
    bool clamps_depth() const { return clamps_depth_; }
    /// The guard band in units of w: |x| <= guard_x() * w is rasterized without clipping.
    float guard_x() const { return guard_x_; }
    float guard_y() const { return guard_y_; }

    std::uint32_t outcode(const glm::vec4& clip) const;

    /// Divides by w, applies the viewport and snaps. clip.w may be anything; the vertex must not need clipping.
    void project(ScreenVertex& vertex) const;

    bool operator==(const Viewport&) const = default;

  private:
    PixelBounds visible_, drawn_, scissored_;
    float half_width_, half_height_;
    float middle_x_, middle_y_; ///< pixels from the view's top left corner
    float guard_x_, guard_y_;
    float half_depth_, middle_depth_;    ///< from the middle of the depth range to the far plane
    float least_depth_, greatest_depth_; ///< of what is not clamped later
    bool clamps_depth_;
};

/// True where the viewport of a state is one that coordinates on the sub-pixel grid have room for.
bool is_usable(const PixelRectangle& viewport);
/// True where both ends of the depth range lie within 0 and 1.
bool is_usable(const DepthState& state);

/// projection * view * model, multiplied in binary64 and rounded once.
glm::mat4 clip_matrix(const View& view, const glm::mat4& model);

/// matrix * (position, 1): the sum over the columns from left to right, every product and every sum rounded.
inline glm::vec4 to_clip(const glm::mat4& matrix, const glm::vec4& position) {
    glm::vec4 result;
    for (int row = 0; row < 4; ++row)
        result[row] = ((matrix[0][row] * position.x + matrix[1][row] * position.y) + matrix[2][row] * position.z) +
                      matrix[3][row];
    return result;
}

/// A vertex in clip space: classified and, where no clipping is needed, projected.
inline ScreenVertex place_vertex(const Viewport& viewport, const glm::vec4& clip) {
    ScreenVertex vertex;
    vertex.clip = clip;
    vertex.outside = viewport.outcode(vertex.clip);
    if ((vertex.outside & (outside::must_clip | outside::not_finite)) == 0) viewport.project(vertex);
    return vertex;
}

/// The whole vertex.
inline ScreenVertex transform_vertex(const glm::mat4& matrix, const Viewport& viewport, const glm::vec4& position) {
    return place_vertex(viewport, to_clip(matrix, position));
}

} // namespace pipeline
