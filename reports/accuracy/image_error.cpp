#include "reports/accuracy/image_error.hpp"

#include "pipeline/functional/eye_depth.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace reports {

namespace {

class Sums {
  public:
    void add(double error) {
        square_ += error * error;
        absolute_ += std::abs(error);
        worst_ = std::max(worst_, std::abs(error));
        ++count_;
    }
    void write(ImageError& error) const {
        if (count_ == 0) return;
        error.rmse = std::sqrt(square_ / static_cast<double>(count_));
        error.mean = absolute_ / static_cast<double>(count_);
        error.worst = worst_;
    }

  private:
    double square_ = 0, absolute_ = 0, worst_ = 0;
    std::uint64_t count_ = 0;
};

} // namespace

std::vector<PixelKind> kinds_of_pixels(const pipeline::View& view, std::span<const float> depth) {
    CHECK(depth.size() == view.pixels());
    const pipeline::EyeDepth distance(view.projection);
    const auto width = static_cast<int>(view.width), height = static_cast<int>(view.height);
    std::vector<double> inverse; // of distances: linear along any line of pixels of a plane
    for (const float window : depth) inverse.push_back(window < 1.0F ? 1.0 / distance.distance(window) : 0.0);
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * view.width +
               static_cast<std::size_t>(std::clamp(x, 0, width - 1));
    };
    const auto is_inner = [&](int x, int y) {
        const double here = inverse[at(x, y)];
        for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}})
            for (int step = 1; step <= silhouette_band; ++step) {
                const double a = inverse[at(x + step * dx, y + step * dy)],
                             b = inverse[at(x - step * dx, y - step * dy)];
                if (a == 0.0 || b == 0.0 || std::abs((a + b) / 2.0 - here) > silhouette_jump * here) return false;
            }
        return true;
    };
    std::vector<PixelKind> kinds(depth.size(), PixelKind::background);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (inverse[at(x, y)] != 0.0) kinds[at(x, y)] = is_inner(x, y) ? PixelKind::inner : PixelKind::silhouette;
    return kinds;
}

ShadowErrorKind shadow_error_kind(float seen, float truth) {
    const float excess = seen - truth;
    if (truth >= 0.95F && excess < -0.25F) return ShadowErrorKind::acne;
    if (excess < -0.1F) return ShadowErrorKind::too_dark;
    return excess > 0.1F ? ShadowErrorKind::too_bright : ShadowErrorKind::small;
}

ImageError shadow_error(std::span<const float> picture, std::span<const float> truth,
                        std::span<const PixelKind> kinds) {
    CHECK(picture.size() == 4 * truth.size() && kinds.size() == truth.size());
    ImageError error;
    error.shadows = true;
    std::array<std::uint64_t, 4> kind{};
    Sums sums;
    for (std::size_t pixel = 0; pixel < truth.size(); ++pixel) {
        if (kinds[pixel] == PixelKind::silhouette) ++error.excluded;
        if (kinds[pixel] != PixelKind::inner) continue;
        ++error.compared;
        const float seen = picture[4 * pixel + 3];
        sums.add(static_cast<double>(seen) - static_cast<double>(truth[pixel]));
        ++kind[static_cast<std::size_t>(shadow_error_kind(seen, truth[pixel]))];
    }
    sums.write(error);
    const auto share = [&](ShadowErrorKind one) {
        return static_cast<double>(kind[static_cast<std::size_t>(one)]) /
               std::max(1.0, static_cast<double>(error.compared));
    };
    error.acne = share(ShadowErrorKind::acne);
    error.too_dark = share(ShadowErrorKind::too_dark);
    error.too_bright = share(ShadowErrorKind::too_bright);
    return error;
}

ImageError picture_error(std::span<const float> picture, const Truth& truth) {
    CHECK(picture.size() == 4 * truth.pixels() && truth.colours.size() == picture.size());
    ImageError error;
    Sums sums;
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel) {
        if (truth.doubtful(pixel)) {
            ++error.excluded;
            continue;
        }
        ++error.compared;
        for (std::size_t i = 4 * pixel; i < 4 * pixel + 3; ++i)
            sums.add(static_cast<double>(picture[i]) - static_cast<double>(truth.colours[i]));
    }
    sums.write(error);
    return error;
}

} // namespace reports
