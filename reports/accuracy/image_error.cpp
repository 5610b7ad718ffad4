#include "reports/accuracy/image_error.hpp"

#include "pipeline/functional/eye_depth.hpp"
#include "sim/check.hpp"

#include <algorithm>
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

ImageError shadow_error(std::span<const float> picture, std::span<const float> truth,
                        std::span<const PixelKind> kinds) {
    CHECK(picture.size() == 4 * truth.size() && kinds.size() == truth.size());
    ImageError error;
    error.shadows = true;
    std::uint64_t acne = 0, dark = 0, bright = 0;
    Sums sums;
    for (std::size_t pixel = 0; pixel < truth.size(); ++pixel) {
        if (kinds[pixel] == PixelKind::silhouette) ++error.excluded;
        if (kinds[pixel] != PixelKind::inner) continue;
        ++error.compared;
        const double excess = static_cast<double>(picture[4 * pixel + 3]) - static_cast<double>(truth[pixel]);
        sums.add(excess);
        if (truth[pixel] >= 0.95F && excess < -0.25)
            ++acne;
        else if (excess < -0.1)
            ++dark;
        else if (excess > 0.1)
            ++bright;
    }
    sums.write(error);
    const double pixels = std::max(1.0, static_cast<double>(error.compared));
    error.acne = static_cast<double>(acne) / pixels;
    error.too_dark = static_cast<double>(dark) / pixels;
    error.too_bright = static_cast<double>(bright) / pixels;
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
