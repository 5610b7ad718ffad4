#include "pipeline/functional/interpolation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pipeline {

namespace {

/// Extrapolated weights beyond this are noise.
constexpr double largest_weight = 1e6;

} // namespace

TriangleInterpolator::TriangleInterpolator(const RasterTriangle& raster, const std::array<ScreenVertex, 3>& corners) {
    const auto area = static_cast<double>(raster.area);
    const auto w_of = [&](std::size_t i) { return static_cast<double>(std::max(corners[i].clip.w, smallest_w)); };
    const double nearest_w = std::min({w_of(0), w_of(1), w_of(2)});
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t edge = raster.reversed && i != 0 ? 3 - i : i;
        // Integers below 2^53: exact.
        constant_[i] = static_cast<double>(raster.constant[edge]);
        step_x_[i] = static_cast<double>(raster.step_x[edge]);
        step_y_[i] = static_cast<double>(raster.step_y[edge]);
        depth_[i] = static_cast<double>(corners[i].depth);
        inverse_w_[i] = nearest_w / w_of(i);
    }
    inverse_area_ = 1.0 / area;
    least_depth_ = std::min({corners[0].depth, corners[1].depth, corners[2].depth});
    greatest_depth_ = std::max({corners[0].depth, corners[1].depth, corners[2].depth});
    affine_ = inverse_w_[0] == inverse_w_[1] && inverse_w_[1] == inverse_w_[2];
}

void TriangleInterpolator::screen_weights(std::int32_t x, std::int32_t y, QuadWeights& weights) const {
    for (std::size_t i = 0; i < 3; ++i) {
        const double here = constant_[i] + step_x_[i] * x + step_y_[i] * y;
        weights.screen[i][0] = here * inverse_area_;
        weights.screen[i][1] = (here + step_x_[i]) * inverse_area_;
        weights.screen[i][2] = (here + step_y_[i]) * inverse_area_;
        weights.screen[i][3] = (here + step_x_[i] + step_y_[i]) * inverse_area_;
    }
}

Lanes TriangleInterpolator::depth(const QuadWeights& weights) const {
    // Differences to corner 0, so that a triangle of constant depth has exactly that depth everywhere.
    const double to1 = depth_[1] - depth_[0];
    const double to2 = depth_[2] - depth_[0];
    Lanes result;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const double depth = depth_[0] + (weights.screen[1][lane] * to1 + weights.screen[2][lane] * to2);
        result[lane] = std::clamp(static_cast<float>(depth), least_depth_, greatest_depth_);
    }
    return result;
}

void TriangleInterpolator::perspective_weights(unsigned covered, QuadWeights& weights) const {
    if (affine_) {
        for (std::size_t corner = 0; corner < 3; ++corner)
            for (std::size_t lane = 0; lane < 4; ++lane)
                weights.perspective[corner][lane] = static_cast<float>(weights.screen[corner][lane]);
        return;
    }
    unsigned bad = 0;
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const double w0 = weights.screen[0][lane] * inverse_w_[0];
        const double w1 = weights.screen[1][lane] * inverse_w_[1];
        const double w2 = weights.screen[2][lane] * inverse_w_[2];
        const double sum = w0 + w1 + w2;
        const double reach = sum * largest_weight;
        const bool good = std::fabs(w0) < reach && std::fabs(w1) < reach && std::fabs(w2) < reach;
        const double scale = good ? 1.0 / sum : 0.0;
        if (!good) bad |= 1U << lane;
        weights.perspective[0][lane] = static_cast<float>(w0 * scale);
        weights.perspective[1][lane] = static_cast<float>(w1 * scale);
        weights.perspective[2][lane] = static_cast<float>(w2 * scale);
    }
    bad &= ~covered;
    if (bad == 0) return;
    const auto first = static_cast<std::size_t>(std::countr_zero(covered));
    for (std::size_t lane = 0; lane < 4; ++lane)
        if (((bad >> lane) & 1U) != 0)
            for (Lanes& corner : weights.perspective) corner[lane] = corner[first];
}

} // namespace pipeline
