#include "traces/workloads/lens_blur.hpp"

#include <algorithm>
#include <cmath>

namespace traces {

namespace {

constexpr double steps_per_pixel = 4.0; // of diameters

// Less than this is what rounding leaves of sums that should be none.
constexpr double least_weight = 1e-6;

double coverage(double radius, int x, int y) {
    return std::clamp(radius + 0.5 - std::sqrt(static_cast<double>(x * x + y * y)), 0.0, 1.0);
}

} // namespace

double Lens::circle_of_confusion(double distance) const {
    const double blur = aperture * std::fabs(distance - focus) / (distance * (focus - focal_length));
    return std::isfinite(blur) ? blur * pixels_per_slope : 0.0;
}

DiscAccumulator::DiscAccumulator(std::uint32_t width, std::uint32_t height)
    : width_(width), height_(height), steps_(std::size_t{width + 1} * height) {}

// Pixels of equal weight in a row are one run: all those inside, and each of those on the border.
const std::vector<DiscAccumulator::Run>& DiscAccumulator::disc(double diameter) {
    const int key = static_cast<int>(std::lround(diameter * steps_per_pixel));
    std::vector<Run>& runs = discs_[key];
    if (!runs.empty()) return runs;
    const double radius = std::max(key / steps_per_pixel, 1.0) / 2.0;
    const int reach = static_cast<int>(std::ceil(radius + 0.5)) - 1;
    double sum = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach;) {
            Run run{y, x, x, coverage(radius, x, y)};
            for (++x; x <= reach && run.weight == 1.0 && coverage(radius, x, y) == 1.0; ++x) run.last = x;
            if (run.weight > 0.0) runs.push_back(run);
            sum += run.weight * (run.last - run.first + 1);
        }
    for (Run& run : runs) run.weight /= sum;
    return runs;
}

void DiscAccumulator::add(std::uint32_t x, std::uint32_t y, double diameter, const glm::vec3& colour) {
    const int columns = static_cast<int>(width_), rows = static_cast<int>(height_);
    for (const Run& run : disc(diameter)) {
        const int row = static_cast<int>(y) + run.row;
        const int first = std::max(static_cast<int>(x) + run.first, 0);
        const int last = std::min(static_cast<int>(x) + run.last, columns - 1);
        if (row < 0 || row >= rows || first > last) continue;
        const glm::dvec4 value = run.weight * glm::dvec4(colour, 1.0);
        glm::dvec4* const steps = steps_.data() + static_cast<std::size_t>(row) * (width_ + 1);
        steps[first] += value;
        steps[last + 1] -= value;
    }
}

std::vector<glm::vec4> DiscAccumulator::picture() const {
    std::vector<glm::vec4> pixels;
    pixels.reserve(std::size_t{width_} * height_);
    for (std::uint32_t y = 0; y < height_; ++y) {
        glm::dvec4 sum(0.0);
        for (std::uint32_t x = 0; x < width_; ++x) {
            sum += steps_[std::size_t{y} * (width_ + 1) + x];
            const bool seen = sum.w > least_weight;
            pixels.emplace_back(
                seen ? glm::vec4(glm::vec3(glm::dvec3(sum) / sum.w), static_cast<float>(std::min(sum.w, 1.0)))
                     : glm::vec4(0.0F));
        }
    }
    return pixels;
}

} // namespace traces
