// Simulated time: picoseconds, and clocks that count them in cycles.
#pragma once

#include <cstdint>
#include <string>

namespace sim {

/// Picoseconds since the start of the run. 2^64 ps are 213 days of simulated time.
using Time = std::uint64_t;

/// Cycles of one clock, counted from time 0.
using Cycle = std::uint64_t;

/// A clock domain: an edge every `period` picoseconds, the first one at time 0.
struct Clock {
    std::string name;
    Time period = 1;          ///< picoseconds, at least 1
    std::uint32_t domain = 0; ///< index within its Simulation

    Time time_of(Cycle cycle) const { return cycle * period; }
    /// The first edge at or after `time`.
    Cycle cycle_at(Time time) const { return (time + period - 1) / period; }
    /// The last edge at or before `time`.
    Cycle cycle_before(Time time) const { return time / period; }
};

/// Period of a frequency in MHz, rounded to a picosecond; 650 MHz -> 1538 ps.
constexpr Time period_of_mhz(double mhz) { return static_cast<Time>(1e6 / mhz + 0.5); }

} // namespace sim
