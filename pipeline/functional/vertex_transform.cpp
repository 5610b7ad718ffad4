#include "pipeline/functional/vertex_transform.hpp"

#include "pipeline/functional/number_formats.hpp"

#include <limits>

namespace pipeline {

namespace {

/// Pixels to sub-pixel units, to nearest even.
std::int32_t snap(float pixels) {
    return static_cast<std::int32_t>(round_even(static_cast<double>(pixels * subpixel_one)));
}

/// Depths that are clamped later are finite all the same.
constexpr float largest_depth = 1e18F;

PixelBounds bounds_of(const PixelRectangle& rectangle, const PixelBounds& within) {
    const auto end = [](std::int32_t begin, std::uint32_t size, std::int32_t from, std::int32_t to) {
        return static_cast<std::int32_t>(std::clamp<std::int64_t>(std::int64_t{begin} + size, from, to));
    };
    const std::int32_t left = std::clamp(rectangle.x, within.left, within.right);
    const std::int32_t top = std::clamp(rectangle.y, within.top, within.bottom);
    return {left, top, end(rectangle.x, rectangle.width, left, within.right),
            end(rectangle.y, rectangle.height, top, within.bottom)};
}

} // namespace

bool is_usable(const PixelRectangle& viewport) {
    const auto near_view = [](std::int32_t begin) { return begin >= -farthest_viewport && begin <= farthest_viewport; };
    const auto sized = [](std::uint32_t size) { return size >= 1 && size <= largest_viewport; };
    return near_view(viewport.x) && near_view(viewport.y) && sized(viewport.width) && sized(viewport.height);
}

bool is_usable(const DepthState& state) {
    const auto good = [](float depth) { return depth >= 0.0F && depth <= 1.0F; }; // false for NaN
    return good(state.range_near) && good(state.range_far);
}

Viewport::Viewport(std::uint32_t view_width, std::uint32_t view_height, const RasterState& state)
    : half_depth_((state.depth.range_far - state.depth.range_near) * 0.5F),
      middle_depth_((state.depth.range_near + state.depth.range_far) * 0.5F),
      least_depth_(std::min(state.depth.range_near, state.depth.range_far)),
      greatest_depth_(std::max(state.depth.range_near, state.depth.range_far)),
      clamps_depth_(state.depth.clamp) {
    const PixelRectangle whole{0, 0, view_width, view_height};
    const PixelRectangle viewport = state.viewport.value_or(whole);
    const PixelBounds view{0, 0, static_cast<std::int32_t>(view_width), static_cast<std::int32_t>(view_height)};
    visible_ = bounds_of(viewport, view);
    drawn_ = bounds_of(state.scissor.value_or(whole), visible_);
    scissored_ = bounds_of(state.scissor.value_or(whole), view);
    half_width_ = static_cast<float>(viewport.width) * 0.5F;
    half_height_ = static_cast<float>(viewport.height) * 0.5F;
    middle_x_ = static_cast<float>(viewport.x) + half_width_;
    middle_y_ = static_cast<float>(viewport.y) + half_height_;
    guard_x_ = guard_band_pixels / half_width_;
    guard_y_ = guard_band_pixels / half_height_;
}

std::uint32_t Viewport::outcode(const glm::vec4& clip) const {
    constexpr float largest = std::numeric_limits<float>::max();
    const float x = clip.x, y = clip.y, z = clip.z, w = clip.w;
    const auto finite = [](float value) { return std::fabs(value) <= largest; }; // false for NaN
    if (!(finite(x) && finite(y) && finite(z) && finite(w))) return outside::not_finite;

    const auto when = [](bool condition, std::uint32_t bit) { return condition ? bit : 0U; };
    std::uint32_t code = when(x < -w, outside::left) | when(x > w, outside::right) | when(y < -w, outside::bottom) |
                         when(y > w, outside::top) | when(z < -w, outside::near) | when(z > w, outside::far);
    if (clamps_depth_) code &= ~(outside::near | outside::far);
    if (code == 0) return 0;
    // In binary64 the products are exact, so the clipper finds the same corners outside.
    const double band_x = static_cast<double>(guard_x_) * static_cast<double>(w);
    const double band_y = static_cast<double>(guard_y_) * static_cast<double>(w);
    code |= when(static_cast<double>(x) < -band_x, outside::guard_left) |
            when(static_cast<double>(x) > band_x, outside::guard_right) |
            when(static_cast<double>(y) < -band_y, outside::guard_bottom) |
            when(static_cast<double>(y) > band_y, outside::guard_top);
    return code;
}

void Viewport::project(ScreenVertex& vertex) const {
    const float inverse = 1.0F / std::max(vertex.clip.w, smallest_w);
    // Row 0 is the top row: y is negated before the viewport, where negation is exact. Pixel centres lie at halves.
    vertex.window.x = std::fma(vertex.clip.x * inverse, half_width_, middle_x_) - 0.5F;
    vertex.window.y = std::fma(-(vertex.clip.y * inverse), half_height_, middle_y_) - 0.5F;
    const float depth = std::fma(vertex.clip.z * inverse, half_depth_, middle_depth_);
    vertex.x = snap(vertex.window.x);
    vertex.y = snap(vertex.window.y);
    vertex.depth = clamps_depth_ ? std::clamp(depth, -largest_depth, largest_depth)
                                 : std::clamp(depth, least_depth_, greatest_depth_);
}

glm::mat4 clip_matrix(const View& view, const glm::mat4& model) {
    return glm::mat4(glm::dmat4(view.projection) * glm::dmat4(view.view) * glm::dmat4(model));
}

} // namespace pipeline
