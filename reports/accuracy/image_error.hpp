// How far a picture is from its truth.
//
// Modelled: root mean square, mean and worst error; for shadows also what kind of error it is; on request how many
// pixels a viewer would tell apart (Yee's metric of OpenImageIO). Pixels at silhouettes are left out, as rays and
// rasterizer may rightly see different surfaces there (specification 004, section 10.4 and check S6), and counted.
// Hazards are never judged by this: they are differences to the frame in submission order.
#pragma once

#include "pipeline/frame.hpp"
#include "reports/truth/truth.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace reports {

struct ImageError {
    std::uint64_t compared = 0, excluded = 0; ///< pixels
    double rmse = 0, mean = 0, worst = 0;     ///< of light, 1 = all of it; of colours: over red, green and blue
    std::optional<std::uint64_t> visible;     ///< pixels that a viewer tells apart; not with --no-images
    bool shadows = false;                     ///< the shares below are known; of `compared`
    double acne = 0;                          ///< lit points (truth >= 0.95) that lost more than a quarter of the light
    double too_dark = 0;   ///< further points that lost more than a tenth: shadows too large or too deep
    double too_bright = 0; ///< points with more than a tenth too much: light bleeding, shadows moved away
};

/// Distances to the eye may jump by this much between neighbours without being a silhouette.
inline constexpr double silhouette_jump = 0.02;
/// Pixels left out on either side of one.
inline constexpr std::uint32_t silhouette_band = 2;

/// 1 for pixels of surfaces away from silhouettes. `depth`: window depths of the frame's view.
std::vector<std::uint8_t> inner_pixels(const pipeline::View& view, std::span<const float> depth);

/// The light that each point sees: `picture` in its alpha, one float per pixel in `truth`. Pixels of `mask` only.
ImageError shadow_error(std::span<const float> picture, std::span<const float> truth,
                        std::span<const std::uint8_t> mask);

/// RGBA floats per pixel. Doubtful pixels of the truth are left out.
ImageError picture_error(std::span<const float> picture, const Truth& truth);

} // namespace reports
