#include "reports/run_numbers.hpp"

#include "reports/numbers.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

double milliseconds(const pipeline::RunResult& run) {
    return run.sort_milliseconds + (run.core_mhz > 0 ? static_cast<double>(run.cycles) / (run.core_mhz * 1e3) : 0.0);
}

double frames_per_second(const pipeline::RunResult& run) { return run.cycles > 0 ? 1e3 / milliseconds(run) : 0.0; }

namespace {

double per_million(std::uint64_t count, const pipeline::RunResult& run) {
    return run.fragments == 0 ? 0.0 : 1e6 * static_cast<double>(count) / static_cast<double>(run.fragments);
}

} // namespace

double hazards_per_million(const pipeline::RunResult& run) { return per_million(run.hazards.total(), run); }

double hazards_per_million(const pipeline::RunResult& run, pipeline::HazardKind kind) {
    return per_million(run.hazards.of(kind), run);
}

std::optional<double> on_chip_bytes(const pipeline::RunResult& run) {
    const auto found = run.area->find("total_bytes");
    if (found == run.area->end()) return std::nullopt;
    return found->get<double>();
}

double cycles_per_second(const pipeline::RunResult& run) {
    return run.host_seconds > 0 ? static_cast<double>(run.cycles) / run.host_seconds : 0.0;
}

double cycles_per_cpu_second(const pipeline::RunResult& run) {
    return run.cpu_seconds > 0 ? static_cast<double>(run.cycles) / run.cpu_seconds : 0.0;
}

std::string samples_text(const Comparison& comparison) {
    return comparison.samples() == 1 ? "" : fmt::format(", {} per pixel", counted(comparison.samples(), "sample"));
}

std::optional<double> bytes_over(const pipeline::RunResult& run, std::string_view link) {
    const auto found = run.bytes->find(link);
    if (found == run.bytes->end() || !found->contains("bytes")) return std::nullopt;
    return (*found)["bytes"].get<double>();
}

std::optional<double> bytes_per_fragment(const pipeline::RunResult& run, std::string_view link) {
    const auto bytes = bytes_over(run, link);
    if (!bytes || run.fragments == 0) return std::nullopt;
    return *bytes / static_cast<double>(run.fragments);
}

std::uint64_t overflow_pixels(const Comparison& comparison) {
    if (!comparison.frame->program) return 0;
    const std::uint32_t k = comparison.frame->program->k();
    const auto& counts = comparison.depth_complexity;
    return static_cast<std::uint64_t>(
        std::count_if(counts.begin(), counts.end(), [k](std::uint32_t fragments) { return fragments > k; }));
}

} // namespace reports
