// How far a picture is from its truth.
//
// Modelled: root mean square, mean and worst error; for shadows also what kind of error it is. Not modelled: what a
// viewer would notice; the one perceptual measure at hand, compare_Yee of OpenImageIO 2.4, tells no two pictures apart.
// Pixels at silhouettes are left out, as rays and
// rasterizer may rightly see different surfaces there (specification 004, section 10.4 and check S6), and counted.
// Hazards are never judged by this: they are differences to the frame in submission order.
#pragma once

#include "pipeline/frame.hpp"
#include "reports/truth/truth.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace reports {

struct ImageError {
    std::uint64_t compared = 0, excluded = 0; ///< pixels; the background is neither, of shadows
    double rmse = 0, mean = 0, worst = 0;     ///< of light, 1 = all of it; of colours: over red, green and blue
    bool shadows = false;                     ///< the shares below are known; of `compared`
    double acne = 0;                          ///< lit points (truth >= 0.95) that lost more than a quarter of the light
    double too_dark = 0;   ///< further points that lost more than a tenth: shadows too large or too deep
    double too_bright = 0; ///< points with more than a tenth too much: light bleeding, shadows moved away
};

/// A pixel may be this much nearer or farther than its neighbours on both sides say, as if they lay in one plane,
/// without being at a silhouette or in a crease.
inline constexpr double silhouette_jump = 0.02;
/// Neighbours that are asked.
inline constexpr int silhouette_band = 2;

enum class PixelKind : std::uint8_t { background, silhouette, inner };

/// What each pixel shows. `depth`: window depths of the frame's view.
std::vector<PixelKind> kinds_of_pixels(const pipeline::View& view, std::span<const float> depth);

enum class ShadowErrorKind : std::uint8_t { small, acne, too_dark, too_bright };
/// As the shares of ImageError count them.
ShadowErrorKind shadow_error_kind(float seen, float truth);

/// The light that each inner pixel's point sees: `picture` in its alpha, one float per pixel in `truth`.
ImageError shadow_error(std::span<const float> picture, std::span<const float> truth, std::span<const PixelKind> kinds);

/// RGBA floats per pixel. Doubtful pixels of the truth are left out.
ImageError picture_error(std::span<const float> picture, const Truth& truth);

} // namespace reports
