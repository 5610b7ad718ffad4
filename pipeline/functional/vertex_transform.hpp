// The position part of the vertex shader, the division by w and the viewport: from model space to the sub-pixel grid.
//
// Rounding is part of the contract, because coverage is exact: the order of operations is that of Mesa's llvmpipe
// (README, "Conventions"), so the two agree in every pixel.
#pragma once

#include "pipeline/draw.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace pipeline {

inline constexpr int subpixel_bits = 8;
inline constexpr int subpixel_one = 1 << subpixel_bits; ///< sub-pixel units in a pixel

inline constexpr std::uint32_t largest_viewport = 16384; ///< pixels along one side
/// No vertex lies farther than this from the middle of the viewport, in pixels: what does is clipped.
inline constexpr float guard_band_pixels = 24576.0F;

/// Divisors are at least this: a vertex in the eye's own plane that survives near-plane clipping has w = z = 0.
inline constexpr float smallest_w = 0x1p-96F;

/// Where a vertex lies outside. The first six are the view volume; the others ask for clipping.
namespace outside {
inline constexpr std::uint32_t left = 1, right = 2, bottom = 4, top = 8, near = 16, far = 32;
inline constexpr std::uint32_t guard_left = 64, guard_right = 128, guard_bottom = 256, guard_top = 512;
inline constexpr std::uint32_t not_finite = 1024;
inline constexpr std::uint32_t view_volume = left | right | bottom | top | near | far;
inline constexpr std::uint32_t must_clip = near | far | guard_left | guard_right | guard_bottom | guard_top;
} // namespace outside

/// A transformed vertex.
struct ScreenVertex {
    glm::vec4 clip{};          ///< clip coordinates, y up
    std::int32_t x = 0, y = 0; ///< sub-pixel units from the centre of pixel (0, 0), y down; valid unless must_clip
    glm::vec2 window{};        ///< the same in pixels, before it was snapped
    float depth = 0;           ///< window depth in [0,1]
    std::uint32_t outside = 0; ///< bits of namespace outside
};

class Viewport {
  public:
    /// width and height in pixels, 1 to largest_viewport.
    Viewport(std::uint32_t width, std::uint32_t height)
        : width_(width),
          height_(height),
          half_width_(static_cast<float>(width) * 0.5F),
          half_height_(static_cast<float>(height) * 0.5F),
          guard_x_(guard_band_pixels / half_width_),
          guard_y_(guard_band_pixels / half_height_) {}

    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    /// The guard band in units of w: |x| <= guard_x() * w is rasterized without clipping.
    float guard_x() const { return guard_x_; }
    float guard_y() const { return guard_y_; }

    std::uint32_t outcode(const glm::vec4& clip) const;

    /// Divides by w, applies the viewport and snaps. clip.w may be anything; the vertex must not need clipping.
    void project(ScreenVertex& vertex) const;

  private:
    std::uint32_t width_, height_;
    float half_width_, half_height_;
    float guard_x_, guard_y_;
};

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

/// The whole vertex: transform, classify and, where no clipping is needed, project.
inline ScreenVertex transform_vertex(const glm::mat4& matrix, const Viewport& viewport, const glm::vec4& position) {
    ScreenVertex vertex;
    vertex.clip = to_clip(matrix, position);
    vertex.outside = viewport.outcode(vertex.clip);
    if ((vertex.outside & (outside::must_clip | outside::not_finite)) == 0) viewport.project(vertex);
    return vertex;
}

} // namespace pipeline
