#include "reports/run_values.hpp"

#include "reports/flatten.hpp"
#include "reports/result.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

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
    read_passes(comparison, comparison.runs.at(run));
}

namespace {

struct PassSums {
    double cycles = 0, bytes = 0;
};

// "light layer 2" is a part of the frame's pass "light".
PassSums sums_of(const pipeline::RunResult& run, const std::string& pass) {
    PassSums sums;
    for (const pipeline::PassResult& part : run.passes) {
        if (part.name != pass && !part.name.starts_with(pass + " ")) continue;
        sums.cycles += static_cast<double>(part.cycles);
        for (const auto& [path, leaf] : flatten(part.counters))
            if (path.starts_with("memory.bytes.")) sums.bytes += leaf.get<double>();
    }
    return sums;
}

// Designs that peel clear their layers within the pass, others in a pass before it.
PassSums clears_of_kbuffer(const pipeline::Frame& frame, const pipeline::RunResult& run) {
    PassSums sums;
    for (const pipeline::Pass& pass : frame.passes) {
        if (pass.clears != std::vector<pipeline::SurfaceId>{frame.main_kbuffer()}) continue;
        const PassSums cleared = sums_of(run, pass.name);
        sums.cycles += cleared.cycles;
        sums.bytes += cleared.bytes;
    }
    return sums;
}

} // namespace

void RunValues::read_passes(const Comparison& comparison, const pipeline::RunResult& run) {
    const double milliseconds_per_cycle = run.core_mhz > 0.0 ? 1.0 / (run.core_mhz * 1000.0) : 0.0;
    for (const pipeline::Pass& pass : comparison.frame->passes) {
        if (!pass.rasterizes()) continue;
        auto [cycles, bytes] = sums_of(run, pass.name);
        const auto write = [&, &cycles = cycles, &bytes = bytes](const std::string& prefix) {
            const double ms = cycles * milliseconds_per_cycle;
            numbers_[prefix + "ms"] = ms;
            numbers_[prefix + "share"] = run.cycles == 0 ? 0.0 : cycles / static_cast<double>(run.cycles);
            numbers_[prefix + "dram_mb"] = bytes / 1e6;
            if (ms > 0.0)
                numbers_[prefix + "mtriangles_per_s"] =
                    static_cast<double>(comparison.scene.triangles_drawn) / ms / 1e3;
        };
        write(fmt::format("pass.{}.", pass.name));
        if (!pass.runs_program()) continue;
        const PassSums cleared = clears_of_kbuffer(*comparison.frame, run);
        cycles += cleared.cycles;
        bytes += cleared.bytes;
        write("kbuffer.");
        const double layers = comparison.frame->program->k();
        const double ms = numbers_["kbuffer.ms"];
        numbers_["kbuffer.ms_per_layer"] = ms / layers;
        numbers_["kbuffer.dram_mb_per_layer"] = bytes / 1e6 / layers;
        if (ms > 0.0)
            numbers_["kbuffer.mtexels_per_s"] =
                layers * static_cast<double>(comparison.frame->view_of_kbuffer().pixels()) / ms / 1e3;
    }
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
