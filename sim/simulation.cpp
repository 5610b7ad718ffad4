#include "sim/simulation.hpp"

#include "sim/channel.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

namespace sim {

namespace {
constexpr std::uint64_t instants_between_stop_checks = 1024;
} // namespace

Component::Component(Context context)
    : simulation_(&context.simulation), name_(std::move(context.name)), clock_(&context.clock),
      cycle_now_(&simulation_->domains_[clock_->domain]->current) {
    const auto same_name = [this](const Component* other) { return other->name_ == name_; };
    CHECK_MSG(std::none_of(simulation_->components_.begin(), simulation_->components_.end(), same_name), name_);
    simulation_->components_.push_back(this);
}

Simulation& simulation_of(Component& component) {
    return *component.simulation_;
}

ChannelBase& adopt(Simulation& simulation, std::unique_ptr<ChannelBase> channel) {
    simulation.owned_channels_.push_back(std::move(channel));
    return *simulation.owned_channels_.back();
}

ChannelBase::ChannelBase(Simulation& simulation, std::string name, ChannelConfig config, Component& sender,
                         Component& receiver)
    : simulation_(&simulation), name_(std::move(name)), config_(config), sender_(&sender), receiver_(&receiver),
      same_clock_(sender.clock().domain == receiver.clock().domain) {
    CHECK_MSG(config_.latency >= 1 && config_.width >= 1, name_);
    CHECK_MSG(&simulation_of(receiver) == &simulation, name_);
    if (config_.capacity == 0) config_.capacity = static_cast<std::uint32_t>(config_.width * (config_.latency + 1));
    sender.outputs_.push_back(this);
    receiver.inputs_.push_back(this);
    simulation.channels_.push_back(this);
}

Cycle ChannelBase::sender_cycle() const {
    return *sender_->cycle_now_;
}

// The sender must not sleep through room that appears at its next edge: either the width of this edge is used up, or a
// receive of this very instant is not visible yet.
void ChannelBase::wait_for_room(std::uint64_t seen) {
    if (seen != received_ || sent_ - seen < config_.capacity)
        simulation_->wake_at_cycle(*sender_, sender_cycle() + 1);
    else
        sender_waits_ = true;
}

void ChannelBase::wake_sender() {
    if (same_clock_)
        simulation_->wake_at_cycle(*sender_, *receiver_->cycle_now_ + 1);
    else
        simulation_->wake(*sender_, simulation_->now() + 1);
}

Simulation::Simulation(std::uint64_t seed, Mode mode, std::uint64_t shuffle_seed)
    : seed_(seed), mode_(mode), shuffle_(shuffle_seed, "tick order") {}

Simulation::~Simulation() = default;

const Clock& Simulation::add_clock(std::string name, double mhz) {
    CHECK_MSG(mhz > 0 && mhz <= 1e6, name);
    auto domain   = std::make_unique<Domain>();
    domain->clock = {std::move(name), period_of_mhz(mhz), static_cast<std::uint32_t>(domains_.size())};
    domains_.push_back(std::move(domain));
    return domains_.back()->clock;
}

void Simulation::wake(Component& component, Time at) {
    wake_at_cycle(component, component.clock_->cycle_at(at));
}

void Simulation::schedule_far(Domain& domain, Component& component, Cycle cycle) {
    CHECK_MSG(cycle > domain.current || domain.current == ~Cycle{0}, component.name_);
    domain.far.push_back({cycle, wakes_++, &component});
    std::push_heap(domain.far.begin(), domain.far.end(), std::greater<>());
}

Cycle Simulation::Domain::next_edge() const {
    Cycle next = far.empty() ? ~Cycle{0} : far.front().cycle;
    // The wheel holds edges current + 1 .. current + wheel_size - 1, found by scanning its occupancy words in order.
    const Cycle first = current + 1;
    for (Cycle step = 0; step < wheel_size;) {
        const Cycle         slot = (first + step) % wheel_size;
        const std::uint64_t word = occupied[slot / 64] >> (slot % 64);
        if (word != 0) return std::min(next, first + step + static_cast<Cycle>(std::countr_zero(word)));
        step += 64 - slot % 64;
    }
    return next;
}

bool Simulation::next_instant(Time& instant) const {
    instant = ~Time{0};
    for (const auto& domain : domains_) {
        const Cycle edge = domain->next_edge();
        if (edge != ~Cycle{0}) instant = std::min(instant, domain->clock.time_of(edge));
    }
    return instant != ~Time{0};
}

void Simulation::collect_due(Domain& domain, Cycle cycle) {
    const Cycle slot = cycle % wheel_size;
    if (cycle - domain.current < wheel_size) {
        std::vector<Component*>& ready = domain.wheel[slot];
        due_.insert(due_.end(), ready.begin(), ready.end());
        ready.clear();
        domain.occupied[slot / 64] &= ~(std::uint64_t{1} << (slot % 64));
    }
    while (!domain.far.empty() && domain.far.front().cycle == cycle) {
        due_.push_back(domain.far.front().component);
        std::pop_heap(domain.far.begin(), domain.far.end(), std::greater<>());
        domain.far.pop_back();
    }
    domain.current = cycle;
}

void Simulation::book(Component& component, Activity next) {
    if (next == component.activity_) return;
    component.activity_times_[static_cast<std::size_t>(component.activity_)] += now_ - component.activity_since_;
    if (observer_ != nullptr && now_ > component.activity_since_)
        observer_->activity(component, component.activity_, component.activity_since_, now_);
    component.activity_       = next;
    component.activity_since_ = now_;
}

void Simulation::tick(Component& component, Cycle cycle) {
    if (component.last_tick_ == cycle) return;
    component.last_tick_      = cycle;
    check_context().component = &component.name_;
    const Activity activity   = component.tick();
    ++ticks_;
    book(component, activity);
    if (activity == Activity::busy) wake_at_cycle(component, cycle + 1);
}

void Simulation::serve(Time instant) {
    now_                    = instant;
    check_context().time_ps = instant;
    due_.clear();
    for (const auto& domain : domains_) {
        const Cycle cycle = domain->clock.cycle_before(instant);
        if (domain->clock.time_of(cycle) != instant) {
            // Not an edge of this clock. Its `current` must still follow time, or wake-ups would be filed too early.
            continue;
        }
        if (mode_ == Mode::never_sleep || domain->next_edge() == cycle) collect_due(*domain, cycle);
        if (mode_ != Mode::never_sleep) continue;
        for (Component* component : components_)
            if (component->clock_->domain == domain->clock.domain) due_.push_back(component);
    }
    if (mode_ == Mode::shuffled)
        for (std::size_t left = due_.size(); left > 1; --left) std::swap(due_[left - 1], due_[shuffle_.below(left)]);
    for (Component* component : due_) tick(*component, *component->cycle_now_);
}

void Simulation::run_asleep(const std::atomic<bool>* stop) {
    Time instant = 0;
    for (std::uint64_t served = 1; next_instant(instant); ++served) {
        serve(instant);
        if (stop != nullptr && served % instants_between_stop_checks == 0 && stop->load(std::memory_order_relaxed))
            throw Interrupted();
    }
}

// Serves every edge of every clock for as long as a sleeping run would have something due, so both end at one time.
void Simulation::run_sleepless(const std::atomic<bool>* stop) {
    Time instant = 0;
    while (next_instant(instant)) {
        for (;;) {
            Time edge = ~Time{0};
            for (const auto& domain : domains_)
                edge = std::min(edge, domain->clock.time_of(domain->current + 1));
            if (edge > instant) break;
            serve(edge);
            if (stop != nullptr && stop->load(std::memory_order_relaxed)) throw Interrupted();
        }
    }
}

void Simulation::run(const std::atomic<bool>* stop) {
    running_ = true;
    if (mode_ == Mode::never_sleep)
        run_sleepless(stop);
    else
        run_asleep(stop);
    running_                  = false;
    check_context().component = nullptr;
    settle_activities();
    throw_if_stuck();
}

void Simulation::settle_activities() {
    for (Component* component : components_) {
        component->activity_times_[static_cast<std::size_t>(component->activity_)] += now_ - component->activity_since_;
        if (observer_ != nullptr && now_ > component->activity_since_)
            observer_->activity(*component, component->activity_, component->activity_since_, now_);
        component->activity_since_ = now_;
    }
}

void Simulation::throw_if_stuck() const {
    bool stuck = std::any_of(channels_.begin(), channels_.end(), [](const ChannelBase* link) { return !link->empty(); });
    for (const Component* component : components_)
        stuck |= component->activity() != Activity::idle && component->activity() != Activity::starved;
    if (stuck) throw DeadlockError(fmt::format("deadlock at {} ps\n{}", now_, wait_report()));
}

namespace {

struct Wait {
    const Component*   who;
    const Component*   whom;
    const ChannelBase* link;
    bool               for_room;
};

std::vector<Wait> waits_of(const Component& component) {
    std::vector<Wait> waits;
    const Activity    activity = component.activity();
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
    std::string       report;
    std::vector<Wait> cycle;
    for (const Component* component : components_) {
        const bool holds_work = component->activity() == Activity::blocked ||
                                component->activity() == Activity::hazard ||
                                component->activity() == Activity::memory;
        std::vector<const Component*> seen;
        if (cycle.empty() && holds_work && !find_cycle(*component, *component, seen, cycle)) cycle.clear();
    }
    if (!cycle.empty()) {
        report += "cycle of waits:\n";
        for (const Wait& wait : cycle) report += "  " + describe(wait);
    }
    report += "all waits:\n";
    for (const Component* component : components_) {
        const bool holds_nothing = component->activity() == Activity::idle || component->activity() == Activity::starved;
        const bool has_input     = std::any_of(component->inputs().begin(), component->inputs().end(),
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
