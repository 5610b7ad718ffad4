#include "pipeline/functional/depth_format.hpp"

#include "pipeline/functional/number_formats.hpp"

namespace pipeline {

namespace {

constexpr double steps_of(DepthFormat format) { return format == DepthFormat::d16 ? 65535.0 : 16777215.0; }

} // namespace

DepthCode depth_code(DepthFormat format, float depth) {
    const float clamped = !(depth > 0.0F) ? 0.0F : (depth < 1.0F ? depth : 1.0F);
    // Non-negative floats order as their bits do; +0 is written for -0.
    if (format == DepthFormat::d32f) return std::bit_cast<std::uint32_t>(clamped);
    return static_cast<DepthCode>(round_even(static_cast<double>(clamped) * steps_of(format))); // the product is exact
}

float depth_value(DepthFormat format, DepthCode code) {
    if (format == DepthFormat::d32f) return std::bit_cast<float>(code);
    return static_cast<float>(static_cast<double>(code) / steps_of(format));
}

DepthCode farthest_depth(DepthFormat format) { return depth_code(format, 1.0F); }

} // namespace pipeline
