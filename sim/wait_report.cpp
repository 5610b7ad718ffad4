// Who waits for whom, when a run stops with work left.
#include "sim/channel.hpp"
#include "sim/simulation.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace sim {

void Simulation::throw_if_stuck() const {
    bool stuck =
        std::any_of(channels_.begin(), channels_.end(), [](const ChannelBase* link) { return !link->empty(); });
    for (const Component* component : components_)
        stuck |= component->activity() != Activity::idle && component->activity() != Activity::starved;
    if (stuck) throw DeadlockError(fmt::format("deadlock at {} ps\n{}", now_, wait_report()));
}

namespace {

struct Wait {
    const Component* who;
    const Component* whom;
    const ChannelBase* link;
    bool for_room;
};

std::vector<Wait> waits_of(const Component& component) {
    std::vector<Wait> waits;
    const Activity activity = component.activity();
    if (activity == Activity::idle || activity == Activity::busy) return waits;
    for (const ChannelBase* link : component.outputs())
        if (link->full()) waits.push_back({&component, &link->receiver(), link, true});
    if (activity != Activity::blocked)
        for (const ChannelBase* link : component.inputs())
            if (link->empty()) waits.push_back({&component, &link->sender(), link, false});
    return waits;
}

// Depth-first search for a component that waits, through others, for itself.
bool find_cycle(const Component& from, const Component& target, std::vector<const Component*>& seen,
                std::vector<Wait>& path) {
    for (const Wait& wait : waits_of(from)) {
        path.push_back(wait);
        if (wait.whom == &target) return true;
        if (std::find(seen.begin(), seen.end(), wait.whom) == seen.end()) {
            seen.push_back(wait.whom);
            if (find_cycle(*wait.whom, target, seen, path)) return true;
        }
        path.pop_back();
    }
    return false;
}

std::string describe(const Wait& wait) {
    const ChannelBase& link = *wait.link;
    return wait.for_room ? fmt::format("{} ({}) waits for room towards {}: {} holds {}/{}\n", wait.who->name(),
                                       to_string(wait.who->activity()), wait.whom->name(), link.name(), link.size(),
                                       link.config().capacity)
                         : fmt::format("{} ({}) waits for a message from {}: {} is empty\n", wait.who->name(),
                                       to_string(wait.who->activity()), wait.whom->name(), link.name());
}

} // namespace

std::string Simulation::wait_report() const {
    std::string report;
    std::vector<Wait> cycle;
    for (const Component* component : components_) {
        const bool holds_work = component->activity() == Activity::blocked ||
                                component->activity() == Activity::hazard || component->activity() == Activity::memory;
        std::vector<const Component*> seen;
        if (cycle.empty() && holds_work && !find_cycle(*component, *component, seen, cycle)) cycle.clear();
    }
    if (!cycle.empty()) {
        report += "cycle of waits:\n";
        for (const Wait& wait : cycle) report += "  " + describe(wait);
    }
    report += "all waits:\n";
    for (const Component* component : components_) {
        const bool holds_nothing =
            component->activity() == Activity::idle || component->activity() == Activity::starved;
        const bool has_input = std::any_of(component->inputs().begin(), component->inputs().end(),
                                           [](const ChannelBase* link) { return !link->empty(); });
        if (holds_nothing && !has_input) continue;
        const std::vector<Wait> waits = waits_of(*component);
        for (const Wait& wait : waits) report += "  " + describe(wait);
        if (waits.empty())
            report += fmt::format("  {} ({}) waits for nothing that a link carries\n", component->name(),
                                  to_string(component->activity()));
    }
    return report;
}

} // namespace sim
