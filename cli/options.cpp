#include "cli/options.hpp"

#include "models/kbuffers/library.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <string_view>

namespace cli {

namespace {

template <class Number>
std::optional<Number> parse(std::string_view text) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

void parse_size(const std::string& text, reports::ComparisonRequest& request) {
    const std::size_t x = text.find('x');
    const auto width = parse<std::uint32_t>(std::string_view(text).substr(0, x));
    const auto height =
        x == std::string::npos ? std::nullopt : parse<std::uint32_t>(std::string_view(text).substr(x + 1));
    constexpr std::uint32_t largest = 16384;
    const auto good = [](std::optional<std::uint32_t> side) { return side && *side >= 1 && *side <= largest; };
    if (!good(width) || !good(height))
        throw sim::InputError(
            fmt::format("--size: expected WIDTHxHEIGHT with 1 to {} pixels each, got '{}'", largest, text));
    request.width = *width;
    request.height = *height;
}

unsigned parse_threads(const std::string& text) {
    constexpr unsigned most = 1024;
    const auto number = parse<unsigned>(text);
    if (!number || *number < 1 || *number > most)
        throw sim::InputError(fmt::format("--threads: expected 1 to {}, got '{}'", most, text));
    return *number;
}

// "all" stands for every design.
std::vector<std::string> parse_designs(std::string_view text) {
    std::vector<std::string> names;
    if (text == "all") {
        for (const models::DesignInfo& design : models::designs()) names.emplace_back(design.id);
        return names;
    }
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        names.emplace_back(text.substr(begin, end - begin));
        if (names.back().empty())
            throw sim::InputError(fmt::format("--designs: expected names separated by commas, got '{}'", text));
        begin = end + 1;
    }
    return names;
}

} // namespace

reports::ComparisonRequest request_of(const FrameOptions& options, const std::string& designs) {
    reports::ComparisonRequest request;
    request.scene = options.scene;
    request.camera = options.camera;
    request.workload = options.workload;
    request.gpu = options.gpu;
    request.designs = parse_designs(designs);
    parse_size(options.size, request);
    if (!options.k.empty()) request.workload_settings.push_back("k=" + options.k);
    if (!options.entry.empty()) request.workload_settings.push_back("entry=" + options.entry);
    constexpr std::string_view workload = "workload.";
    for (const std::string& setting : options.settings)
        if (setting.starts_with(workload))
            request.workload_settings.push_back(setting.substr(workload.size()));
        else
            request.gpu_settings.push_back(setting);
    const auto seed = parse<std::uint64_t>(options.seed);
    if (!seed)
        throw sim::InputError(
            fmt::format("--seed: expected a whole number from 0 to 2^64 - 1, got '{}'", options.seed));
    request.seed = *seed;
    if (!options.threads.empty()) request.threads = parse_threads(options.threads);
    return request;
}

} // namespace cli
