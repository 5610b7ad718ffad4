// What a point of an accuracy measurement looks like beside the truth.
#pragma once

#include "reports/accuracy/image_error.hpp"
#include "reports/images.hpp"

#include <span>
#include <string>

namespace reports {

/// Three panels side by side: the light that each point sees, the same by ray tracing, and where they differ by more
/// than image_error.hpp lets pass, with a legend below.
Picture shadow_error_picture(const pipeline::View& view, std::span<const float> picture, std::span<const float> truth,
                             std::span<const PixelKind> kinds, const std::string& title);

/// The picture, the truth, and the largest difference of a channel times `difference_gain`, as heat; doubtful pixels
/// are chequered.
inline constexpr float difference_gain = 8.0F;
Picture picture_error_picture(std::span<const float> picture, const Truth& truth, const std::string& title);

} // namespace reports
