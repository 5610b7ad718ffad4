#include "reports/run_values.hpp"

#include "reports/flatten.hpp"
#include "reports/result.hpp"

#include <algorithm>
#include <cmath>

namespace reports {

namespace {

constexpr std::size_t channels = 3, floats_per_pixel = 4; // of a composite, RGBA

// All, where fragments were counted in the view of a light.
std::vector<std::size_t> drawn_pixels(const Comparison& comparison) {
    std::vector<std::size_t> pixels;
    for (std::size_t i = 0; i < comparison.frame->view.pixels(); ++i)
        if (comparison.has_light_view() || comparison.depth_complexity[i] != 0) pixels.push_back(i);
    return pixels;
}

double over(double sum, std::size_t count) { return count == 0 ? 0.0 : sum / static_cast<double>(count); }

} // namespace

RunValues::RunValues(const Comparison& comparison, std::size_t run) {
    const nlohmann::ordered_json document = result_json(comparison);
    for (const auto& [path, leaf] : flatten(document.at("designs").at(run)))
        if (leaf.is_number()) numbers_[path] = leaf.get<double>();
    read_picture(comparison, run);
}

void RunValues::read_picture(const Comparison& comparison, std::size_t run) {
    const std::vector<float>& picture = comparison.pixels.at(run).composite;
    const std::vector<float>& reference = comparison.reference.composite;
    const std::vector<std::size_t> drawn = drawn_pixels(comparison);
    double sum = 0, worst = 0;
    for (const std::size_t pixel : drawn)
        for (std::size_t i = pixel * floats_per_pixel; i < pixel * floats_per_pixel + channels; ++i) {
            const double difference = std::abs(static_cast<double>(picture.at(i)) - reference.at(i));
            sum += difference;
            worst = std::max(worst, difference);
        }
    numbers_["wrong_share"] = over(static_cast<double>(comparison.runs.at(run).wrong_pixels), drawn.size());
    numbers_["colour_error"] = over(sum, drawn.size() * channels);
    numbers_["colour_error_worst"] = worst;
}

std::optional<double> RunValues::number(const std::string& name) const {
    const auto found = numbers_.find(name);
    return found == numbers_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> RunValues::at(std::string_view value) const {
    constexpr std::string_view by = " / ";
    const std::size_t quotient = value.find(by);
    if (quotient == std::string_view::npos) return number(std::string(value));
    const auto above = number(std::string(value.substr(0, quotient)));
    const auto below = number(std::string(value.substr(quotient + by.size())));
    if (!above || !below || *below == 0) return std::nullopt;
    return *above / *below;
}

std::vector<std::string> RunValues::names() const {
    std::vector<std::string> list;
    for (const auto& [name, number] : numbers_) list.push_back(name);
    return list;
}

void FrameChange::add(const Comparison& comparison, std::size_t run) {
    const std::vector<float>& picture = comparison.pixels.at(run).composite;
    const bool first = drawn_.empty();
    if (first) drawn_ = drawn_pixels(comparison);
    if (first) low_.assign(drawn_.size() * channels, INFINITY);
    if (first) high_.assign(drawn_.size() * channels, -INFINITY);
    for (std::size_t i = 0; i < low_.size(); ++i) {
        const float value = picture.at(drawn_[i / channels] * floats_per_pixel + i % channels);
        low_[i] = std::min(low_[i], value);
        high_[i] = std::max(high_[i], value);
    }
}

float FrameChange::change(std::size_t pixel) const {
    float largest = 0;
    for (std::size_t i = pixel * channels; i < (pixel + 1) * channels; ++i)
        largest = std::max(largest, high_[i] - low_[i]);
    return largest;
}

double FrameChange::mean() const {
    double sum = 0;
    for (std::size_t pixel = 0; pixel < drawn_.size(); ++pixel) sum += static_cast<double>(change(pixel));
    return over(sum, drawn_.size());
}

double FrameChange::worst() const {
    float largest = 0;
    for (std::size_t pixel = 0; pixel < drawn_.size(); ++pixel) largest = std::max(largest, change(pixel));
    return static_cast<double>(largest);
}

} // namespace reports
