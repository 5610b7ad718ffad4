// A clocked hardware block. One tick per edge while it is busy; asleep otherwise.
#pragma once

#include "sim/activity.hpp"
#include "sim/time.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sim {

class Simulation;
class ChannelBase;
class WakeQueue;

/// What every component is built from.
struct Context {
    Simulation& simulation;
    std::string name; ///< unique path, for example "pipe3.texture_cache"
    const Clock& clock;
};

/// Time a component spent in each activity, in picoseconds; the entries sum to the elapsed time.
using ActivityTimes = std::array<Time, activity_count>;

class Component {
  public:
    explicit Component(Context context);
    virtual ~Component() = default;
    Component(const Component&) = delete;
    Component& operator=(const Component&) = delete;

    const std::string& name() const { return name_; }
    const Clock& clock() const { return *clock_; }
    Activity activity() const { return activity_; }
    const ActivityTimes& activity_times() const { return activity_times_; }

    /// Ports, in the order of their declaration; for the deadlock report and the wiring list.
    const std::vector<ChannelBase*>& inputs() const { return inputs_; }
    const std::vector<ChannelBase*>& outputs() const { return outputs_; }

  protected:
    /// Does the work of one clock edge. The contract:
    ///  - the first tick is at the first edge of the clock, at time 0 for what is built before the run;
    ///  - `busy` is ticked again at the next edge; any other activity sleeps until a message arrives, a credit comes
    ///    back to an output whose ready() was false, or a time asked for with wake_in() is reached;
    ///  - a superfluous tick is harmless: it returns the same activity and changes nothing;
    ///  - `starved` and `idle` mean that the component holds nothing.
    virtual Activity tick() = 0;

    Cycle cycle() const; ///< number of the present edge of this component's clock
    Time now() const;
    Simulation& simulation() const { return *simulation_; }
    /// Asks for a tick `cycles` edges from now (at least 1).
    void wake_in(Cycle cycles);
    /// Asks for a tick at edge `at` of this component's clock (later than the present one).
    void wake_at(Cycle at);

  private:
    friend class Simulation;
    friend class ChannelBase;
    friend Simulation& simulation_of(Component& component);
    friend ChannelBase& adopt(Simulation& simulation, std::unique_ptr<ChannelBase> channel);

    Simulation* simulation_;
    std::string name_;
    const Clock* clock_;
    WakeQueue* queue_;    ///< of its clock domain
    std::uint32_t index_; ///< in that queue
    Activity activity_ = Activity::idle;
    Time activity_since_ = 0;
    ActivityTimes activity_times_{};
    std::vector<ChannelBase*> inputs_;
    std::vector<ChannelBase*> outputs_;
};

} // namespace sim
