#include "cli/options.hpp"

#include "models/kbuffers/library.hpp"
#include "pipeline/geometry/host.hpp"
#include "reports/frame_size.hpp"
#include "sim/check.hpp"
#include "sim/suggest.hpp"

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
    const auto size = reports::frame_size(text);
    if (!size)
        throw sim::InputError(fmt::format("--size: expected WIDTHxHEIGHT with 1 to {} pixels each, got '{}'",
                                          reports::largest_side, text));
    request.width = size->width;
    request.height = size->height;
}

std::uint32_t parse_samples(const std::string& text) {
    const auto samples = reports::sample_count(text);
    if (!samples) throw sim::InputError(fmt::format("--samples: expected 1, 4 or 8, got '{}'", text));
    return *samples;
}

unsigned parse_threads(const std::string& text) {
    constexpr unsigned most = 1024;
    const auto number = parse<unsigned>(text);
    if (!number || *number < 1 || *number > most)
        throw sim::InputError(fmt::format("--threads: expected 1 to {}, got '{}'", most, text));
    return *number;
}

std::uint64_t parse_seed(const std::string& text) {
    const auto seed = parse<std::uint64_t>(text);
    if (!seed) throw sim::InputError(fmt::format("--seed: expected a whole number from 0 to 2^64 - 1, got '{}'", text));
    return *seed;
}

std::vector<std::string> split(std::string_view text, std::string_view option) {
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        names.emplace_back(text.substr(begin, end - begin));
        if (names.back().empty())
            throw sim::InputError(fmt::format("{}: expected names separated by commas, got '{}'", option, text));
        begin = end + 1;
    }
    return names;
}

template <class E>
E parse_choice(std::string_view option, const std::string& text) {
    const auto& names = sim::EnumNames<E>::names;
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        throw sim::InputError(fmt::format("{}: expected one of {}; got '{}'{}", option, fmt::join(names, ", "), text,
                                          sim::did_you_mean(text, {names.begin(), names.end()})));
    return static_cast<E>(found - names.begin());
}

std::vector<std::string> parse_designs(std::string_view text) {
    if (text.empty()) return {"existing", "scoreboard", "blender", "multipass"};
    if (text != "all") return split(text, "--designs");
    std::vector<std::string> names;
    for (const models::DesignInfo& design : models::designs()) names.emplace_back(design.id);
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
    request.only_able_designs = designs.empty() || designs == "all";
    parse_size(options.size, request);
    request.samples = parse_samples(options.samples);
    if (!options.k.empty()) request.workload_settings.push_back("k=" + options.k);
    if (!options.entry.empty()) request.workload_settings.push_back("entry=" + options.entry);
    if (!options.program.empty()) request.workload_settings.push_back("program=" + options.program);
    constexpr std::string_view workload = "workload.";
    for (const std::string& setting : options.settings)
        if (setting.starts_with(workload))
            request.workload_settings.push_back(setting.substr(workload.size()));
        else
            request.gpu_settings.push_back(setting);
    request.seed = parse_seed(options.seed);
    if (!options.threads.empty()) request.threads = parse_threads(options.threads);
    return request;
}

reports::GeometryRequest request_of(const GeometryCommand& command) {
    reports::GeometryRequest request;
    request.experiment.scene = command.scene;
    request.experiment.prepare = command.prepare;
    request.experiment.submission = parse_choice<pipeline::Submission>("--submission", command.submission);
    if (command.reads != "all" && command.reads != "position")
        throw sim::InputError(fmt::format("--reads: expected all or position, got '{}'", command.reads));
    request.experiment.reads_all = command.reads == "all";
    request.gpu = command.gpu;
    request.gpu_settings = command.settings;
    request.seed = parse_seed(command.seed);
    return request;
}

reports::Fidelity fidelity_of(const std::string& text) { return parse_choice<reports::Fidelity>("--fidelity", text); }

reports::PeelingFidelity peeling_fidelity_of(const std::string& text) {
    return text.empty() ? reports::PeelingFidelity::sampled
                        : parse_choice<reports::PeelingFidelity>("--fidelity", text);
}

unsigned threads_of(const std::string& text) { return text.empty() ? reports::core_count() : parse_threads(text); }

std::vector<std::string> list_of(const std::string& text) {
    return text.empty() ? std::vector<std::string>{} : split(text, "--gpus");
}

} // namespace cli
