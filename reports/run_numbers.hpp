// Numbers of a run that several parts of a report derive.
#pragma once

#include "pipeline/run_result.hpp"
#include "reports/comparison_result.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace reports {

/// Simulated frames per second: core clock over cycles.
double frames_per_second(const pipeline::RunResult& run);
/// Simulated milliseconds of the frame, with what sorting its triangles takes before.
double milliseconds(const pipeline::RunResult& run);
/// Hazards in a million fragments: all, and those of a kind.
double hazards_per_million(const pipeline::RunResult& run);
double hazards_per_million(const pipeline::RunResult& run, pipeline::HazardKind kind);
/// On-chip bytes of the design; nothing where the run does not say.
std::optional<double> on_chip_bytes(const pipeline::RunResult& run);
/// Simulated core cycles per second of host time; 0 when it was not measured.
double cycles_per_second(const pipeline::RunResult& run);
/// The same per second of the thread that ran it, which does not count the time it waited for a core.
double cycles_per_cpu_second(const pipeline::RunResult& run);
/// Bytes over a link (a key of RunResult::bytes, for example "dram") per fragment; nothing when there is no such link.
std::optional<double> bytes_per_fragment(const pipeline::RunResult& run, std::string_view link);
/// All bytes over a link.
std::optional<double> bytes_over(const pipeline::RunResult& run, std::string_view link);
/// ", 4 samples per pixel"; empty when there is one.
std::string samples_text(const Comparison& comparison);
/// Pixels onto which more than k fragments are drawn; 0 without a k-buffer.
std::uint64_t overflow_pixels(const Comparison& comparison);

} // namespace reports
