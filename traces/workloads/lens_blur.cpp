#include "traces/workloads/lens_blur.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cmath>

namespace traces {

namespace {

constexpr double steps_per_pixel = 4.0; // of diameters

// Less than this is what rounding leaves of sums that should be none.
constexpr double least_weight = 1e-6;

std::size_t disc_number(double diameter) { return static_cast<std::size_t>(std::lround(diameter * steps_per_pixel)); }

double disc_radius(std::size_t number) { return std::max(static_cast<double>(number) / steps_per_pixel, 1.0) / 2.0; }

int disc_reach(double radius) { return static_cast<int>(std::ceil(radius + 0.5)) - 1; }

double coverage(double radius, int x, int y) {
    return std::clamp(radius + 0.5 - std::sqrt(static_cast<double>(x * x + y * y)), 0.0, 1.0);
}

// All pixels inside of a row are one run, and each of those on the border.
std::vector<Discs::Run> disc_runs(double radius) {
    const int reach = disc_reach(radius);
    std::vector<Discs::Run> runs;
    double sum = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach;) {
            Discs::Run run{y, x, x, coverage(radius, x, y)};
            for (++x; x <= reach && run.weight == 1.0 && coverage(radius, x, y) == 1.0; ++x) run.last = x;
            if (run.weight > 0.0) runs.push_back(run);
            sum += run.weight * (run.last - run.first + 1);
        }
    for (Discs::Run& run : runs) run.weight /= sum;
    return runs;
}

} // namespace

double Lens::circle_of_confusion(double distance) const {
    const double blur = aperture * std::fabs(distance - focus) / (distance * (focus - focal_length));
    return std::isfinite(blur) ? blur * pixels_per_slope : 0.0;
}

Discs::Discs(double largest_diameter) : discs_(disc_number(largest_diameter) + 1) {}

std::span<const Discs::Run> Discs::disc(double diameter) const {
    const std::size_t number = disc_number(diameter);
    CHECK(number < discs_.size());
    Disc& disc = discs_[number];
    std::call_once(disc.made, [&] { disc.runs = disc_runs(disc_radius(number)); });
    return disc.runs;
}

std::uint32_t Discs::reach() const { return static_cast<std::uint32_t>(disc_reach(disc_radius(discs_.size() - 1))); }

DiscAccumulator::DiscAccumulator(const Discs& discs, std::uint32_t width, std::uint32_t first_row, std::uint32_t rows)
    : discs_(&discs), width_(width), first_row_(first_row), rows_(rows), steps_(std::size_t{width + 1} * rows) {}

void DiscAccumulator::add(std::uint32_t x, std::uint32_t y, double diameter, const glm::vec3& colour) {
    const int columns = static_cast<int>(width_), rows = static_cast<int>(rows_);
    const int row = static_cast<int>(y) - static_cast<int>(first_row_);
    const std::span<const Discs::Run> runs = discs_->disc(diameter);
    auto run = std::lower_bound(runs.begin(), runs.end(), -row,
                                [](const Discs::Run& one, int least) { return one.row < least; });
    for (; run != runs.end() && row + run->row < rows; ++run) {
        const int first = std::max(static_cast<int>(x) + run->first, 0);
        const int last = std::min(static_cast<int>(x) + run->last, columns - 1);
        if (first > last) continue;
        const glm::dvec4 value = run->weight * glm::dvec4(colour, 1.0);
        glm::dvec4* const steps = steps_.data() + static_cast<std::size_t>(row + run->row) * (width_ + 1);
        steps[first] += value;
        steps[last + 1] -= value;
    }
}

std::vector<glm::vec4> DiscAccumulator::picture() const {
    std::vector<glm::vec4> pixels;
    pixels.reserve(std::size_t{width_} * rows_);
    for (std::uint32_t y = 0; y < rows_; ++y) {
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
