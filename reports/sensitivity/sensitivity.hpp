// How much the answers of a comparison depend on its assumptions: one parameter at a time, up and down.
//
// The frame is shaded once and replayed on every machine. A conclusion is the order of a pair of designs that are
// correct in every run; it survives if no run reverses it by more than `tolerance` of the time.
#pragma once

#include "pipeline/output/hazards.hpp"
#include "reports/comparison.hpp"
#include "reports/csv.hpp"
#include "reports/terminal_table.hpp"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace reports {

struct SensitivityRequest {
    ComparisonRequest comparison;
    /// Paths, or sections for all that lies below them; empty: everything assumed that the runs read.
    std::vector<std::string> parameters;
    double factor = 2; ///< above 1
};

/// Two runs are as fast as each other within this share of the time.
inline constexpr double order_tolerance = 0.01;

/// What is kept of one run.
struct SensitivityRun {
    sim::Cycle cycles = 0;
    double milliseconds = 0;
    std::uint64_t fragments = 0;
    pipeline::HazardCounts hazards;
    std::uint64_t wrong_pixels = 0, tied_pixels = 0, lost_fragments = 0;
    std::uint32_t rank = 0; ///< 1 is the fastest of the designs

    /// As the reference, but for the order of fragments of equal depth.
    bool correct() const { return wrong_pixels == tied_pixels && (lost_fragments == 0 || wrong_pixels > 0); }
};

enum class Direction : std::uint8_t { down, up, other };

/// One value of one parameter.
struct SensitivityStep {
    std::string value;
    Direction direction = Direction::other;
    std::vector<SensitivityRun> runs; ///< by design; empty where the value was refused
    std::string refused;              ///< why it could not be run
};

struct SensitivityParameter {
    std::string path, value, unit, text;
    std::vector<SensitivityStep> steps;

    /// Largest change of a design's time, as a share of it.
    double largest_change(const std::vector<SensitivityRun>& base) const;
};

/// The first design is the faster one as the GPU is; `ratio` is the other's time over its own.
struct Conclusion {
    std::size_t faster = 0, slower = 0;
    double ratio = 1;
    double worst_ratio = 1;                   ///< smallest over all runs
    std::string worst_parameter, worst_value; ///< where that was
    bool survives() const { return worst_ratio >= 1 - order_tolerance; }
};

struct Sensitivity {
    SceneFacts scene;
    std::string gpu, workload;
    std::uint32_t width = 0, height = 0;
    double factor = 2;
    std::uint64_t seed = 1;
    std::vector<VariantFacts> designs;
    std::vector<SensitivityRun> base; ///< by design
    std::string nothing_drawn;        ///< why no fragment was drawn; empty where any was
    std::vector<SensitivityParameter> parameters;
    std::vector<std::pair<std::string, std::string>> skipped; ///< parameters that were not asked for by name, and why
    std::vector<Conclusion> conclusions;                      ///< pairs of correct designs, in the order of the designs
    std::vector<std::size_t> by_effect() const;               ///< parameters, the one that matters most first
};

/// Throws sim::InputError as prepare() does, and for parameters that there are not. Equal for any number of threads.
Sensitivity measure_sensitivity(const SensitivityRequest& request, const Supervision& supervision = {});

/// What has to be said behind the table: where nothing was drawn, that; then the notes of the scene.
std::vector<std::string> remarks(const Sensitivity& result);

std::string sensitivity_text(const Sensitivity& result, TerminalStyle style);
nlohmann::ordered_json sensitivity_json(const Sensitivity& result);
/// One row per parameter, value and design; the first rows are the GPU as it is.
Table sensitivity_table(const Sensitivity& result);
Table conclusions_table(const Sensitivity& result);
std::string sensitivity_page(const Sensitivity& result);

} // namespace reports
