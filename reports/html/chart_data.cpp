#include "reports/html/sections.hpp"
#include "reports/run_numbers.hpp"
#include "sim/activity.hpp"

#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;
using pipeline::RunResult;

namespace {

// Stage -> fractions of time, in the order of sim::activity_names.
ordered_json stalls_json(const RunResult& run) {
    ordered_json stages = ordered_json::array();
    for (const auto& stage : run.stalls->items()) {
        ordered_json fractions = ordered_json::array();
        for (const std::string_view activity : sim::activity_names)
            fractions.push_back(stage.value().value(activity, 0.0));
        stages.push_back({{"stage", stage.key()}, {"fractions", std::move(fractions)}});
    }
    return stages;
}

ordered_json bytes_json(const RunResult& run) {
    ordered_json links = ordered_json::object();
    for (const auto& link : run.bytes->items())
        if (const auto bytes = bytes_per_fragment(run, link.key())) links[link.key()] = *bytes;
    return links;
}

} // namespace

ordered_json chart_data(const Comparison& comparison) {
    ordered_json designs = ordered_json::array();
    for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
        const RunResult& run = comparison.runs[i];
        designs.push_back({{"id", comparison.variants.at(i).label},
                           {"cycles", run.cycles},
                           {"hazards", run.hazards.by},
                           {"on_chip", on_chip_bytes(run).value_or(0.0)},
                           {"wrong_pixels", run.wrong_pixels},
                           {"stalls", stalls_json(run)},
                           {"bytes", bytes_json(run)},
                           {"distance", run.hazard_distance}});
    }
    return {{"activities", sim::activity_names}, {"designs", std::move(designs)}};
}

} // namespace reports
