#include "sim/simulation.hpp"

#include "sim/channel.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

namespace sim {

namespace {
constexpr std::uint64_t instants_between_looks = 1024;
} // namespace

Component::Component(Context context)
    : simulation_(&context.simulation), name_(std::move(context.name)), clock_(&context.clock) {
    const auto same_name = [this](const Component* other) { return other->name_ == name_; };
    CHECK_MSG(std::none_of(simulation_->components_.begin(), simulation_->components_.end(), same_name), name_);
    CHECK_MSG(clock_->domain < simulation_->domains_.size(), name_);
    Simulation::Domain& domain = *simulation_->domains_[clock_->domain];
    CHECK_MSG(clock_ == &domain.clock, name_);
    queue_ = &domain.queue;
    index_ = queue_->add_component();
    domain.components.push_back(this);
    simulation_->catch_up(domain);
    wake_in(1);
    simulation_->components_.push_back(this);
}

Simulation& simulation_of(Component& component) { return *component.simulation_; }

// Looks up from the work now and then: does the user want it to stop, does anything still move?
class Simulation::Watch {
  public:
    Watch(const Simulation& simulation, const std::atomic<bool>* stop) : simulation_(simulation), stop_(stop) {}

    void note_instant() {
        if (++instants_ % instants_between_looks == 0) look();
    }

  private:
    void look() {
        if (stop_ != nullptr && stop_->load(std::memory_order_relaxed)) throw Interrupted();
        std::uint64_t moved = 0;
        for (const ChannelBase* link : simulation_.channels_) moved += link->sent() + link->received();
        if (moved != moved_) {
            moved_ = moved;
            moved_last_ = instants_;
        }
        if (instants_ - moved_last_ < simulation_.patience_) return;
        std::string busy;
        for (const Component* component : simulation_.components_)
            if (component->activity() == Activity::busy) busy += (busy.empty() ? "" : ", ") + component->name();
        throw LivelockError(fmt::format("livelock at {} ps: no message moved in the last {} instants; busy: {}\n{}",
                                        simulation_.now_, instants_ - moved_last_, busy, simulation_.wait_report()));
    }

    const Simulation& simulation_;
    const std::atomic<bool>* stop_;
    std::uint64_t instants_ = 0;
    std::uint64_t moved_ = 0;
    std::uint64_t moved_last_ = 0;
};

Simulation::Simulation(std::uint64_t seed, Mode mode, std::uint64_t shuffle_seed)
    : seed_(seed), mode_(mode), shuffle_(shuffle_seed, "tick order") {}

Simulation::~Simulation() = default;

const Clock& Simulation::add_clock(std::string name, double mhz) {
    CHECK_MSG(mhz >= 1e-3 && mhz <= 1e6, name);
    auto domain = std::make_unique<Domain>();
    domain->clock = {std::move(name), period_of_mhz(mhz), static_cast<std::uint32_t>(domains_.size())};
    domains_.push_back(std::move(domain));
    return domains_.back()->clock;
}

void Simulation::wake(Component& component, Time at) {
    CHECK_MSG(at > now_ || !started_, component.name_);
    wake_at_cycle(component, component.clock_->cycle_at(at));
}

void Simulation::wake_far(Component& component, Cycle cycle) {
    CHECK_MSG(cycle < forever / component.clock_->period, component.name_);
    catch_up(*domains_[component.clock_->domain]);
    component.queue_->wake(component.index_, cycle);
}

// The queue of a clock that had nothing to do stays behind. When it catches up, more edges are within reach of its
// wheel.
void Simulation::catch_up(Domain& domain) {
    if (!started_) return;
    const Cycle last_edge = domain.clock.cycle_before(now_);
    if (domain.queue.current() == last_edge) return;
    CHECK(domain.queue.next() > last_edge);
    domain.queue.advance(last_edge);
}

Time Simulation::next_instant() {
    Time instant = forever;
    for (const auto& domain : domains_) {
        domain->edge = domain->queue.next();
        domain->time = domain->edge == WakeQueue::none ? forever : domain->clock.time_of(domain->edge);
        instant = std::min(instant, domain->time);
    }
    return instant;
}

Time Simulation::next_edge_of_any_clock() {
    Time instant = forever;
    for (const auto& domain : domains_) {
        domain->edge = domain->queue.current() + 1;
        domain->time = domain->clock.time_of(domain->edge);
        instant = std::min(instant, domain->time);
    }
    return instant;
}

// Every clock that has an edge knows it before the first component ticks.
void Simulation::begin_instant(Time instant) {
    CHECK(instant > now_ || !started_);
    now_ = instant;
    started_ = true;
    context_->time_ps = instant;
    for (const auto& domain : domains_)
        if (domain->time == instant) domain->queue.advance(domain->edge);
}

void Simulation::book(Component& component, Activity next) {
    component.activity_times_[static_cast<std::size_t>(component.activity_)] += now_ - component.activity_since_;
    if (observer_ != nullptr && now_ > component.activity_since_)
        observer_->activity(component, component.activity_, component.activity_since_, now_);
    component.activity_ = next;
    component.activity_since_ = now_;
}

Activity Simulation::tick(Component& component) {
    context_->component = &component.name_;
    const Activity activity = component.tick();
    ++ticks_;
    if (activity != component.activity_) book(component, activity);
    return activity;
}

void Simulation::serve() {
    for (const auto& domain : domains_) {
        if (domain->time != now_) continue;
        WakeQueue& queue = domain->queue;
        for (std::size_t word = 0; word < queue.words(); ++word) {
            Component* const* components = &domain->components[word * 64];
            std::uint64_t busy = 0;
            for (std::uint64_t due = queue.take(word); due != 0; due &= due - 1)
                if (tick(*components[std::countr_zero(due)]) == Activity::busy) busy |= due & -due;
            queue.wake_next(word, busy);
        }
    }
}

void Simulation::serve_shuffled() {
    due_.clear();
    for (const auto& domain : domains_) {
        if (domain->time != now_) continue;
        for (std::size_t word = 0; word < domain->queue.words(); ++word)
            for (std::uint64_t due = domain->queue.take(word); due != 0; due &= due - 1)
                due_.push_back(domain->components[word * 64 + static_cast<std::size_t>(std::countr_zero(due))]);
    }
    for (std::size_t left = due_.size(); left > 1; --left) std::swap(due_[left - 1], due_[shuffle_.below(left)]);
    tick_all(due_);
}

void Simulation::serve_everybody() {
    for (const auto& domain : domains_) {
        if (domain->time != now_) continue;
        for (std::size_t word = 0; word < domain->queue.words(); ++word) domain->queue.take(word);
        tick_all(domain->components);
    }
}

void Simulation::tick_all(const std::vector<Component*>& components) {
    for (Component* component : components)
        if (tick(*component) == Activity::busy) component->wake_in(1);
}

void Simulation::run_asleep(Watch& watch) {
    for (Time instant = next_instant(); instant != forever; instant = next_instant()) {
        begin_instant(instant);
        if (mode_ == Mode::shuffled)
            serve_shuffled();
        else
            serve();
        watch.note_instant();
    }
}

// Serves every edge of every clock for as long as a sleeping run would have something due, so both end at one time.
void Simulation::run_sleepless(Watch& watch) {
    for (Time last = next_instant(); last != forever; last = next_instant())
        for (Time edge = next_edge_of_any_clock(); edge <= last; edge = next_edge_of_any_clock()) {
            begin_instant(edge);
            serve_everybody();
            watch.note_instant();
        }
}

void Simulation::run(const std::atomic<bool>* stop) {
    // Whatever ends the run, the check context of this thread must not go on naming a component of it.
    struct Running {
        Simulation& simulation;
        CheckContext before = check_context();
        ~Running() {
            check_context() = before;
            simulation.running_ = false;
        }
    };
    CHECK(!running_);
    const Running running{*this};
    running_ = true;
    context_ = &check_context();
    Watch watch(*this, stop);
    if (mode_ == Mode::never_sleep)
        run_sleepless(watch);
    else
        run_asleep(watch);
    for (const auto& domain : domains_) catch_up(*domain);
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

} // namespace sim
