#include "pipeline/functional/interpolation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace pipeline {

namespace {

/// Extrapolated weights beyond this are noise.
constexpr double largest_weight = 1e6;

constexpr double pixels(std::int32_t subpixels) { return static_cast<double>(subpixels) / subpixel_one; }

struct Position {
    double x, y;
};

Position before_snapping(const ScreenVertex& vertex) {
    return {static_cast<double>(vertex.window.x), static_cast<double>(vertex.window.y)};
}

Position after_snapping(const ScreenVertex& vertex) {
    return {static_cast<double>(vertex.x) / subpixel_one, static_cast<double>(vertex.y) / subpixel_one};
}

double signed_area(const Position& a, const Position& b, const Position& c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/// A corner's weight times the common factor at each pixel.
using Shares = std::array<double, 4>;

/// Pixels that are extrapolated beyond the eye plane, or near it, get the shares of the first covered pixel.
void replace_unusable(std::array<Shares, 3>& shares, unsigned covered) {
    const auto first = static_cast<std::size_t>(std::countr_zero(covered));
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
        if (((covered >> pixel) & 1U) != 0) continue;
        const double a = shares[0][pixel], b = shares[1][pixel], c = shares[2][pixel];
        const double largest = std::max({std::fabs(a), std::fabs(b), std::fabs(c)});
        if (largest < (a + b + c) * largest_weight) continue;
        for (Shares& corner : shares) corner[pixel] = corner[first];
    }
}

CornerWeights normalized(Shares s0, Shares s1, Shares s2) {
    CornerWeights weights;
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
        const double inverse = 1.0 / (s0[pixel] + s1[pixel] + s2[pixel]);
        weights.of1[pixel] = static_cast<float>(s1[pixel] * inverse);
        weights.of2[pixel] = static_cast<float>(s2[pixel] * inverse);
    }
    return weights;
}

} // namespace

DepthPlane::DepthPlane(const RasterTriangle& raster, const std::array<ScreenVertex, 3>& corners) {
    std::array<Position, 3> at{before_snapping(corners[0]), before_snapping(corners[1]), before_snapping(corners[2])};
    double area = signed_area(at[0], at[1], at[2]);
    // A sliver that only snapping gave an area, or turned over.
    if (raster.reversed ? !(area < 0.0) : !(area > 0.0)) {
        at = {after_snapping(corners[0]), after_snapping(corners[1]), after_snapping(corners[2])};
        area = signed_area(at[0], at[1], at[2]);
    }
    x_ = at[0].x;
    y_ = at[0].y;
    depth_ = static_cast<double>(corners[0].depth);
    // Differences to corner 0: a triangle of constant depth has exactly that depth everywhere.
    const double to1 = static_cast<double>(corners[1].depth) - depth_;
    const double to2 = static_cast<double>(corners[2].depth) - depth_;
    if (to1 != 0.0 || to2 != 0.0) {
        step_x_ = (to1 * (at[2].y - at[0].y) - to2 * (at[1].y - at[0].y)) / area;
        step_y_ = (to2 * (at[1].x - at[0].x) - to1 * (at[2].x - at[0].x)) / area;
    }
    least_ = std::min({corners[0].depth, corners[1].depth, corners[2].depth});
    greatest_ = std::max({corners[0].depth, corners[1].depth, corners[2].depth});
}

Lanes DepthPlane::at(std::int32_t x, std::int32_t y, SampleOffset from_centre) const {
    const double dx = x + pixels(from_centre.x) - x_, dy = y + pixels(from_centre.y) - y_;
    const double here = depth_ + (step_x_ * dx + step_y_ * dy);
    const std::array<double, 4> depths{here, here + step_x_, here + step_y_, here + (step_x_ + step_y_)};
    Lanes result;
    // Clamped before it is rounded: the plane of a sliver may be out of the range of binary32.
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const double depth = std::clamp(depths[lane], static_cast<double>(least_), static_cast<double>(greatest_));
        result[lane] = static_cast<float>(std::clamp(depth + bias_, lowest_, highest_));
    }
    return result;
}

void DepthPlane::add_bias(const DepthState& state, double step) {
    const auto slope = static_cast<double>(state.bias_slope), constant = static_cast<double>(state.bias_constant);
    constexpr int fraction_bits = std::numeric_limits<float>::digits - 1;
    if (step == 0.0 && greatest_ > 0.0F) step = std::ldexp(1.0, std::ilogb(greatest_) - fraction_bits);
    bias_ = constant * step;
    if (slope != 0.0) bias_ += slope * std::max(std::fabs(step_x_), std::fabs(step_y_));
}

AttributePlanes::AttributePlanes(const RasterTriangle& raster, const std::array<ScreenVertex, 3>& corners) {
    const auto w_of = [&](std::size_t i) { return static_cast<double>(std::max(corners[i].clip.w, smallest_w)); };
    const double nearest_w = std::min({w_of(0), w_of(1), w_of(2)});
    const double inverse_area = 1.0 / static_cast<double>(raster.area);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t edge = raster.reversed && i != 0 ? 3 - i : i;
        const double scale = inverse_area * (nearest_w / w_of(i));
        constant_[i] = static_cast<double>(raster.constant[edge]);
        step_x_[i] = static_cast<double>(raster.step_x[edge]);
        step_y_[i] = static_cast<double>(raster.step_y[edge]);
        scale_[i] = scale;
    }
}

CornerWeights AttributePlanes::at(std::int32_t x, std::int32_t y, unsigned covered) const {
    // Integers below 2^53 until they are scaled: exact, so that covered pixels have no negative weight.
    std::array<Shares, 3> shares;
    for (std::size_t i = 0; i < 3; ++i) {
        const double here = constant_[i] + step_x_[i] * x + step_y_[i] * y;
        shares[i] = {here * scale_[i], (here + step_x_[i]) * scale_[i], (here + step_y_[i]) * scale_[i],
                     (here + (step_x_[i] + step_y_[i])) * scale_[i]};
    }
    if (covered != 15U) replace_unusable(shares, covered);
    return normalized(shares[0], shares[1], shares[2]);
}

CornerWeights AttributePlanes::at(std::int32_t x, std::int32_t y, unsigned covered,
                                  const std::array<SampleOffset, 4>& from_centres) const {
    std::array<Shares, 3> shares;
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
        const std::size_t column = pixel % 2, row = pixel / 2;
        const double px = x + static_cast<double>(column) + pixels(from_centres[pixel].x);
        const double py = y + static_cast<double>(row) + pixels(from_centres[pixel].y);
        for (std::size_t i = 0; i < 3; ++i)
            shares[i][pixel] = (constant_[i] + step_x_[i] * px + step_y_[i] * py) * scale_[i];
    }
    if (covered != 15U) replace_unusable(shares, covered);
    return normalized(shares[0], shares[1], shares[2]);
}

} // namespace pipeline
