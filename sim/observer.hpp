// Sees what happens in a run without taking part: timelines, checkers, statistics over time.
#pragma once

#include "sim/activity.hpp"
#include "sim/time.hpp"

namespace sim {

class Component;
class ChannelBase;

class Observer {
  public:
    virtual ~Observer() = default;
    /// `component` was in `activity` during [begin, end).
    virtual void activity(const Component& component, Activity activity, Time begin, Time end) = 0;
    /// A message was sent at `sent` and can be received from `ready` on.
    virtual void message(const ChannelBase& channel, Time sent, Time ready) = 0;
};

} // namespace sim
