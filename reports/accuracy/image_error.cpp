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

std::vector<std::uint8_t> inner_pixels(const pipeline::View& view, std::span<const float> depth) {
    CHECK(depth.size() == view.pixels());
    const pipeline::EyeDepth distance(view.projection);
    const auto width = static_cast<int>(view.width), height = static_cast<int>(view.height);
    std::vector<double> distances;
    for (const float window : depth) distances.push_back(window < 1.0F ? distance.distance(window) : INFINITY);
    std::vector<std::uint8_t> inner(depth.size());
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * view.width +
               static_cast<std::size_t>(std::clamp(x, 0, width - 1));
    };
    constexpr int band = static_cast<int>(silhouette_band);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double here = distances[at(x, y)];
            bool whole = here < INFINITY;
            for (int dy = -band; whole && dy <= band; ++dy)
                for (int dx = -band; whole && dx <= band; ++dx) {
                    const double there = distances[at(x + dx, y + dy)];
                    whole = std::abs(there - here) <= silhouette_jump * band * std::min(here, there);
                }
            inner[at(x, y)] = whole ? 1 : 0;
        }
    return inner;
}

ImageError shadow_error(std::span<const float> picture, std::span<const float> truth,
                        std::span<const std::uint8_t> mask) {
    CHECK(picture.size() == 4 * truth.size() && mask.size() == truth.size());
    ImageError error;
    error.shadows = true;
    std::uint64_t acne = 0, dark = 0, bright = 0;
    Sums sums;
    for (std::size_t pixel = 0; pixel < truth.size(); ++pixel) {
        if (mask[pixel] == 0) {
            ++error.excluded;
            continue;
        }
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
