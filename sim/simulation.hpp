// The queue of wake-ups and the loop that serves it.
//
// Each clock domain has a wheel of the next 1024 edges (components that are busy, or wait a memory latency) and a heap
// for later ones. All components that are due at one instant tick before time moves on; since data and credits take at
// least one edge, the order of ticks within an instant cannot matter, and `Mode` lets tests prove it.
#pragma once

#include "sim/component.hpp"
#include "sim/observer.hpp"
#include "sim/random.hpp"

#include <atomic>
#include <bit>
#include <memory>
#include <string>
#include <vector>

namespace sim {

class ChannelBase;

/// How ticks are ordered; results are identical for all three.
enum class Mode : std::uint8_t {
    normal,
    shuffled,    ///< random order within an instant
    never_sleep, ///< every component ticks at every edge
};

/// The run stopped with work left. what() names the cycle of waits.
class DeadlockError : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

class Simulation {
  public:
    /// `shuffle_seed` chooses the order of ticks in Mode::shuffled and nothing else.
    explicit Simulation(std::uint64_t seed = 1, Mode mode = Mode::normal, std::uint64_t shuffle_seed = 1);
    ~Simulation();
    Simulation(const Simulation&)            = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Adds a clock domain; the reference stays valid for the life of the simulation. mhz in (0, 1e6].
    const Clock& add_clock(std::string name, double mhz);

    Context context(std::string name, const Clock& clock) { return {*this, std::move(name), clock}; }

    /// Wakes `component` at its clock's first edge at or after `at`, which must be later than now.
    void wake(Component& component, Time at);
    /// Wakes at an edge of the component's own clock.
    void wake_at_cycle(Component& component, Cycle cycle) {
        if (component.last_wake_ == cycle) return;
        component.last_wake_ = cycle;
        schedule(component, cycle);
    }

    /// Runs until nothing is left to do; can be called again after new work was woken.
    /// Throws DeadlockError when components hold work but nothing will wake them, Interrupted when `stop` becomes true.
    void run(const std::atomic<bool>* stop = nullptr);

    Time          now() const { return now_; }
    std::uint64_t seed() const { return seed_; }
    Mode          mode() const { return mode_; }
    std::uint64_t ticks() const { return ticks_; }
    bool          running() const { return running_; }
    Random        random_for(std::string_view name) const { return {seed_, name}; }

    void      set_observer(Observer* observer) { observer_ = observer; }
    Observer* observer() const { return observer_; }

    const std::vector<Component*>&   components() const { return components_; }
    const std::vector<ChannelBase*>& channels() const { return channels_; }

    /// Closes the books of every component at the present time, so that its activity times sum to now().
    void settle_activities();

    /// Who waits for whom, one line per edge, the cycle first; empty when nobody waits.
    std::string wait_report() const;

  private:
    friend class Component;
    friend class ChannelBase;
    friend ChannelBase& adopt(Simulation& simulation, std::unique_ptr<ChannelBase> channel);

    static constexpr Cycle wheel_size = 1024;

    struct FarWake {
        Cycle         cycle;
        std::uint64_t order;
        Component*    component;
        bool          operator>(const FarWake& other) const {
            return cycle != other.cycle ? cycle > other.cycle : order > other.order;
        }
    };

    struct Domain {
        Clock                                            clock;
        Cycle                                            current = ~Cycle{0}; ///< edge last served; ~0 before the first
        std::array<std::vector<Component*>, wheel_size> wheel;
        std::array<std::uint64_t, wheel_size / 64>      occupied{};
        std::vector<FarWake>                             far;
        Cycle                                            next_edge() const; ///< ~0 when nothing is due
    };

    void schedule(Component& component, Cycle cycle) {
        Domain& domain = *domains_[component.clock_->domain];
        if (cycle - domain.current < wheel_size) {
            const Cycle slot = cycle % wheel_size;
            domain.wheel[slot].push_back(&component);
            domain.occupied[slot / 64] |= std::uint64_t{1} << (slot % 64);
        } else {
            schedule_far(domain, component, cycle);
        }
    }
    void   schedule_far(Domain& domain, Component& component, Cycle cycle);
    bool   next_instant(Time& instant) const;
    void   serve(Time instant);
    void   collect_due(Domain& domain, Cycle cycle);
    void   tick(Component& component, Cycle cycle);
    void   book(Component& component, Activity next);
    void   run_asleep(const std::atomic<bool>* stop);
    void   run_sleepless(const std::atomic<bool>* stop);
    void   throw_if_stuck() const;

    std::uint64_t                        seed_;
    Mode                                 mode_;
    Random                               shuffle_;
    Time                                 now_     = 0;
    std::uint64_t                        ticks_   = 0;
    std::uint64_t                        wakes_   = 0;
    bool                                 running_ = false;
    Observer*                            observer_ = nullptr;
    std::vector<std::unique_ptr<Domain>> domains_;
    std::vector<Component*>              components_;
    std::vector<ChannelBase*>            channels_;
    std::vector<std::unique_ptr<ChannelBase>> owned_channels_;
    std::vector<Component*>              due_;
};

inline Time Component::now() const {
    return simulation_->now();
}
inline void Component::wake_at(Cycle at) {
    simulation_->wake_at_cycle(*this, at);
}
inline void Component::wake_in(Cycle cycles) {
    wake_at(cycle() + cycles);
}

} // namespace sim
