// The queue of wake-ups and the loop that serves it.
//
// All components that are due at one instant tick before time moves on. Since data and credits take at least one edge,
// the order of ticks within an instant cannot matter, and `Mode` lets tests prove it.
#pragma once

#include "sim/check.hpp"
#include "sim/component.hpp"
#include "sim/observer.hpp"
#include "sim/random.hpp"
#include "sim/wake_queue.hpp"

#include <atomic>
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

/// The run would never stop: components stay busy, but no message moves. what() names them.
class LivelockError : public DeadlockError {
  public:
    using DeadlockError::DeadlockError;
};

class Simulation {
  public:
    /// `shuffle_seed` chooses the order of ticks in Mode::shuffled and nothing else.
    explicit Simulation(std::uint64_t seed = 1, Mode mode = Mode::normal, std::uint64_t shuffle_seed = 1);
    ~Simulation();
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// Adds a clock domain; the reference stays valid for the life of the simulation. mhz in [0.001, 1e6].
    const Clock& add_clock(std::string name, double mhz);

    Context context(std::string name, const Clock& clock) { return {*this, std::move(name), clock}; }

    /// Wakes `component` at its clock's first edge at or after `at`, which must be later than now.
    void wake(Component& component, Time at);
    /// Wakes at an edge of the component's own clock, later than now.
    void wake_at_cycle(Component& component, Cycle cycle) {
        if (!component.queue_->wake_near(component.index_, cycle)) wake_far(component, cycle);
    }

    /// Runs until nothing is left to do; can be called again after new work was woken.
    /// Throws DeadlockError when components hold work but nothing will wake them, LivelockError when they only keep
    /// each other awake, Interrupted when `stop` becomes true.
    void run(const std::atomic<bool>* stop = nullptr);

    /// How many instants may pass without any message before run() gives up.
    void set_patience(std::uint64_t instants) { patience_ = instants; }

    Time now() const { return now_; }
    std::uint64_t seed() const { return seed_; }
    Mode mode() const { return mode_; }
    std::uint64_t ticks() const { return ticks_; }
    bool running() const { return running_; }
    Random random_for(std::string_view name) const { return {seed_, name}; }

    void set_observer(Observer* observer) { observer_ = observer; }
    Observer* observer() const { return observer_; }

    const std::vector<Component*>& components() const { return components_; }
    const std::vector<ChannelBase*>& channels() const { return channels_; }

    /// Closes the books of every component at the present time, so that its activity times sum to now().
    void settle_activities();

    /// Who waits for whom, one line per edge, the cycle first; empty when nobody waits.
    std::string wait_report() const;

  private:
    friend class Component;
    friend class ChannelBase;
    friend ChannelBase& adopt(Simulation& simulation, std::unique_ptr<ChannelBase> channel);

    static constexpr Time forever = ~Time{0};

    struct Domain {
        Clock clock;
        WakeQueue queue;
        std::vector<Component*> components; ///< by their index in the queue
        Cycle edge = 0;                     ///< the one to be served next, and its time
        Time time = forever;
    };
    class Watch;

    void wake_far(Component& component, Cycle cycle);
    void catch_up(Domain& domain);
    Time next_instant();
    Time next_edge_of_any_clock();
    void begin_instant(Time instant);
    void serve();
    void serve_shuffled();
    void serve_everybody();
    void tick_all(const std::vector<Component*>& components);
    Activity tick(Component& component);
    void book(Component& component, Activity next);
    void run_asleep(Watch& watch);
    void run_sleepless(Watch& watch);
    void throw_if_stuck() const;

    // What every send and receive reads stands first.
    Time now_ = 0;
    Observer* observer_ = nullptr;
    std::uint64_t ticks_ = 0;
    std::uint64_t patience_ = std::uint64_t{1} << 22U;
    bool started_ = false; ///< the instant now() has been served
    bool running_ = false;
    CheckContext* context_ = nullptr; ///< of the thread that runs
    std::vector<std::unique_ptr<Domain>> domains_;
    std::vector<Component*> components_;
    std::vector<ChannelBase*> channels_;
    std::vector<std::unique_ptr<ChannelBase>> owned_channels_;
    std::vector<Component*> due_;
    std::uint64_t seed_;
    Mode mode_;
    Random shuffle_;
};

inline Cycle Component::cycle() const { return queue_->current(); }
inline Time Component::now() const { return simulation_->now(); }
inline void Component::wake_at(Cycle at) { simulation_->wake_at_cycle(*this, at); }
inline void Component::wake_in(Cycle cycles) { wake_at(cycle() + cycles); }

} // namespace sim
