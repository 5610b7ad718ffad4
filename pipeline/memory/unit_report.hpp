// How one unit, or several parallel ones, appear in a run's result: params, counters, and cycles by activity.
#pragma once

#include "sim/component.hpp"
#include "sim/described_json.hpp"

#include <nlohmann/json.hpp>

namespace pipeline {

/// Cycles of its clock that a component spent in each activity so far, added to `cycles`.
inline void add_activity(nlohmann::ordered_json& cycles, const sim::Component& component) {
    for (std::size_t i = 0; i < sim::activity_count; ++i) {
        nlohmann::ordered_json& sum = cycles[std::string(sim::activity_names[i])];
        const sim::Cycle before = sum.is_number() ? sum.get<sim::Cycle>() : 0;
        sum = before + component.activity_times()[i] / component.clock().period;
    }
}

template <class Component>
nlohmann::ordered_json unit_report(const Component& component) {
    nlohmann::ordered_json report;
    if constexpr (requires { component.params(); }) report["params"] = sim::to_json(component.params());
    report["counters"] = sim::to_json(component.stats());
    add_activity(report["activity"], component);
    return report;
}

} // namespace pipeline
