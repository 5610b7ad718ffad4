#include "cli/options.hpp"

#include "cli/command_line.hpp"
#include "models/kbuffers/library.hpp"
#include "models/programs/mlab.hpp"
#include "pipeline/geometry/host.hpp"
#include "reports/frame_size.hpp"
#include "reports/result.hpp"
#include "sim/check.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <sstream>
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

template <class Request>
void parse_size(const std::string& text, Request& request) {
    const reports::FrameSize size = size_of(text);
    request.width = size.width;
    request.height = size.height;
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
        throw sim::InputError(fmt::format("--threads: expected a whole number from 1 to {}, got '{}'", most, text));
    return *number;
}

std::uint64_t parse_seed(const std::string& text) {
    const auto seed = parse<std::uint64_t>(text);
    if (!seed) throw sim::InputError(fmt::format("--seed: expected a whole number from 0 to 2^64 - 1, got '{}'", text));
    return *seed;
}

std::uint32_t parse_count(std::string_view option, const std::string& text, std::uint32_t most) {
    const auto number = parse<std::uint32_t>(text);
    if (!number || *number < 1 || *number > most)
        throw sim::InputError(fmt::format("{}: expected a whole number from 1 to {}, got '{}'", option, most, text));
    return *number;
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

std::optional<traces::SquareLight> parse_light(const std::string& text) {
    if (text.empty()) return std::nullopt;
    std::vector<double> numbers;
    for (const std::string& part : split(text, "--light"))
        if (const auto number = parse<double>(part); number && std::isfinite(*number)) numbers.push_back(*number);
    if (numbers.size() != 9)
        throw sim::InputError(fmt::format("--light: expected nine numbers: centre x,y,z and two half edges x,y,z each; "
                                          "got '{}'",
                                          text));
    const auto vector = [&](std::size_t i) { return glm::dvec3(numbers[i], numbers[i + 1], numbers[i + 2]); };
    return traces::SquareLight{vector(0), vector(3), vector(6)};
}

std::vector<std::string> settings_of(const ParameterValues& parameters) {
    std::vector<std::string> settings;
    for (const auto& [name, value] : parameters)
        if (!value.empty()) settings.push_back(fmt::format("{}={}", name, value));
    return settings;
}

// "key=value key=value"; a word without = belongs to the value before it. The key `workload` names another method.
std::optional<reports::Rival> parse_rival(const std::string& text) {
    if (text.empty()) return std::nullopt;
    std::vector<std::string> settings;
    std::istringstream words(text);
    for (std::string word; words >> word;)
        if (const std::size_t equals = word.find('='); equals != std::string::npos && equals != 0)
            settings.push_back(word);
        else if (settings.empty())
            throw sim::InputError(fmt::format("--against: expected KEY=VALUE KEY=VALUE ..., got '{}'", text));
        else
            settings.back() += " " + word;
    reports::Rival rival;
    constexpr std::string_view workload = "workload=";
    for (const std::string& setting : settings)
        if (setting.starts_with(workload))
            rival.workload = setting.substr(workload.size());
        else
            rival.settings.push_back(setting);
    return rival;
}

std::vector<std::string> parse_designs(std::string_view text) {
    // What the protected designs are compared with differs most in when a store becomes visible.
    if (text.empty())
        return {"existing?visibility=rop_cache",
                "existing?visibility=writeback",
                "existing?visibility=never_until_flush",
                "scoreboard",
                "blender",
                "multipass"};
    if (text != "all") return reports::split_variants(text, "--designs");
    std::vector<std::string> names;
    for (const models::DesignInfo& design : models::designs()) names.emplace_back(design.id);
    return names;
}

// Which of two values was meant, nobody can know.
void expect_each_once(const std::vector<std::string>& settings) {
    std::map<std::string, std::string> seen;
    for (const std::string& setting : settings) {
        std::string key = setting.substr(0, setting.find('='));
        std::erase_if(key, [](char c) { return c == ' ' || c == '\t'; });
        const auto [first, is_new] = seen.emplace(key, setting);
        if (!is_new)
            throw sim::InputError(
                fmt::format("--set: '{}' is set twice, by '{}' and '{}'", key, first->second, setting));
    }
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
    request.workload_settings = settings_of(options.parameters);
    constexpr std::string_view workload = "workload.";
    expect_each_once(options.settings);
    for (const std::string& setting : options.settings)
        if (setting.starts_with(workload))
            request.workload_settings.push_back(setting.substr(workload.size()));
        else
            request.gpu_settings.push_back(setting);
    request.seed = parse_seed(options.seed);
    if (!options.threads.empty()) request.threads = parse_threads(options.threads);
    return request;
}

reports::ComparisonRequest request_of(const CompareCommand& command) {
    reports::ComparisonRequest request = request_of(command.frame, command.designs);
    if (command.equal_area.empty()) return request;
    constexpr std::uint64_t most = std::uint64_t{1} << 40U;
    request.equal_area =
        command.equal_area == "largest" ? std::optional<std::uint64_t>(0) : parse<std::uint64_t>(command.equal_area);
    if (!request.equal_area || *request.equal_area > most || command.equal_area == "0")
        throw sim::InputError(fmt::format("--equal-area: expected bytes from 1 to 2^40, or nothing for as many as the "
                                          "largest design has; got '{}'",
                                          command.equal_area));
    return request;
}

reports::ComparisonRequest request_of(const ReplayCommand& command) {
    reports::ComparisonRequest request = request_of(static_cast<const CompareCommand&>(command));
    if (!request.workload_settings.empty())
        throw sim::InputError(
            fmt::format("--set: expected a number of the GPU or of a design, got workload.{}: a trace has its own "
                        "(ropsim compare draws its scene in any way)",
                        request.workload_settings.front()));
    request.replay = true;
    request.replayed = {command.frames, command.kbuffer, parse_count("--k", command.k, models::most_mlab_nodes),
                        command.cold};
    return request;
}

traces::CaptureRequest request_of(const CaptureCommand& command) {
    const reports::ComparisonRequest frame = request_of(command.frame, "");
    if (!frame.gpu_settings.empty())
        throw sim::InputError(fmt::format("--set: expected workload.KEY=VALUE, got '{}'", frame.gpu_settings.front()));
    return {.scene = frame.scene,
            .camera = frame.camera,
            .width = frame.width,
            .height = frame.height,
            .samples = frame.samples,
            .workload = frame.workload.name(),
            .settings = frame.workload_settings,
            .writer = "ropsim " + reports::version_text(),
            .name = command.name,
            .licence = command.licence};
}

reports::TruthRequest request_of(const TruthCommand& command) {
    constexpr std::uint32_t most_rays = 1'000'000;
    reports::TruthRequest request;
    request.scene = command.scene;
    request.camera = command.camera;
    request.workload = command.workload;
    parse_size(command.size, request);
    request.workload_settings = settings_of(command.parameters);
    constexpr std::string_view workload = "workload.";
    expect_each_once(command.settings);
    for (const std::string& setting : command.settings) {
        if (!setting.starts_with(workload))
            throw sim::InputError(fmt::format("--set: expected workload.KEY=VALUE, got '{}'", setting));
        request.workload_settings.push_back(setting.substr(workload.size()));
    }
    request.plan.layers = parse_count("--layers", command.layers, 64);
    request.plan.light = parse_light(command.light);
    request.plan.sampling.rays = parse_count("--rays", command.rays, most_rays);
    request.plan.sampling.seed = parse_seed(command.seed);
    if (!command.threads.empty()) request.threads = parse_threads(command.threads);
    request.check = command.check;
    request.use_cache = !command.no_cache;
    return request;
}

reports::SensitivityRequest request_of(const SensitivityCommand& command) {
    constexpr double most = 1000;
    reports::SensitivityRequest request;
    request.comparison = request_of(command.frame, command.designs);
    if (!command.parameters.empty()) request.parameters = split(command.parameters, "--parameters");
    const auto factor = parse<double>(command.factor);
    if (!factor || !(*factor > 1) || *factor > most)
        throw sim::InputError(
            fmt::format("--factor: expected a number above 1, at most {}, got '{}'", most, command.factor));
    request.factor = *factor;
    return request;
}

reports::AccuracyRequest request_of(const AccuracyCommand& command) {
    constexpr std::uint32_t most_rays = 1'000'000, most_lights = 4096;
    reports::AccuracyRequest request;
    request.comparison = request_of(command.frame, command.design);
    if (command.design.empty()) {
        request.comparison.designs = {"multipass", "blender", "interlock"};
        request.comparison.only_able_designs = false;
        request.comparison.first_able_design = true;
    } else if (request.comparison.designs.size() != 1) {
        throw sim::InputError(fmt::format("--design: expected one design, got '{}'", command.design));
    }
    for (const std::string& sweep : command.sweep) {
        const std::size_t equals = sweep.find('=');
        if (equals == 0 || equals == std::string::npos)
            throw sim::InputError(fmt::format("--sweep: expected KNOB=VALUE,VALUE..., got '{}'", sweep));
        request.sweep.push_back({sweep.substr(0, equals), split(sweep.substr(equals + 1), "--sweep")});
    }
    request.sampling.rays = parse_count("--rays", command.rays, most_rays);
    request.sampling.seed = request.comparison.seed;
    if (!command.averaged.empty()) request.averaged = parse_count("--averaged", command.averaged, most_lights);
    request.against = parse_rival(command.against);
    request.pictures = !command.output.directory.empty() && !command.output.no_images;
    request.use_cache = !command.no_cache;
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
    expect_each_once(command.settings);
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

unsigned folds_of(const std::string& text) {
    constexpr std::uint32_t most_folds = 1000;
    const std::uint32_t folds = parse_count("--folds", text, most_folds);
    if (folds < 2)
        throw sim::InputError(fmt::format("--folds: expected a whole number from 2 to {}, got {}", most_folds, folds));
    return folds;
}

std::uint64_t seed_of(const std::string& text) { return parse_seed(text); }

std::vector<std::string> list_of(const std::string& text) {
    return text.empty() ? std::vector<std::string>{} : split(text, "--gpus");
}

std::vector<std::uint32_t> lights_of(const std::string& text) {
    std::vector<std::uint32_t> counts;
    if (text.empty()) return counts;
    for (const std::string& one : split(text, "--lights")) {
        const auto count = parse<std::uint32_t>(one);
        if (!count) throw sim::InputError(fmt::format("--lights: expected numbers of lights, got '{}'", one));
        counts.push_back(*count);
    }
    return counts;
}

traces::CutRange range_of(const std::string& option, const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon != std::string::npos) {
        const auto first = parse<std::uint32_t>(std::string_view(text).substr(0, colon));
        const auto end = parse<std::uint32_t>(std::string_view(text).substr(colon + 1));
        if (first && end) return {*first, *end};
    }
    throw UsageError(fmt::format("{}: expected two numbers as in 2:5, got '{}'", option, text));
}

reports::FrameSize size_of(const std::string& text) {
    const auto size = reports::frame_size(text);
    if (!size)
        throw sim::InputError(fmt::format("--size: expected WIDTHxHEIGHT with 1 to {} pixels each, got '{}'",
                                          reports::largest_side, text));
    return *size;
}

} // namespace cli
