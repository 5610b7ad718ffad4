// The two ways a run can end early: the user's input is bad (InputError), or the simulator itself is (CHECK).
//
// CHECK stays on in every build type: a simulator that goes on after a broken invariant prints wrong numbers.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace sim {

/// The input is bad. The message is one line: file or option, place in it, what was expected. Exit status 1.
class InputError : public std::runtime_error {
  public:
    /// Control characters, which a name in the input may hold, become spaces.
    explicit InputError(const std::string& message);
};

/// An invariant of the simulator does not hold: our bug. Exit status 3.
class InternalError : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

/// The user asked the run to stop (Ctrl-C). Exit status 130.
class Interrupted : public std::runtime_error {
  public:
    Interrupted() : std::runtime_error("interrupted") {}
};

/// Throws InternalError with the place, the simulated time and the ticking component (when there is one).
[[noreturn]] void check_failed(const char* condition, const char* file, int line, std::string_view detail = {});

/// What a failing CHECK says about where the simulation is; set by Simulation for the thread that runs it.
struct CheckContext {
    const std::string* component = nullptr;
    unsigned long long time_ps = 0;
};
CheckContext& check_context();

} // namespace sim

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) [[unlikely]]                                                                                 \
            ::sim::check_failed(#condition, __FILE__, __LINE__);                                                       \
    } while (false)

#define CHECK_MSG(condition, detail)                                                                                   \
    do {                                                                                                               \
        if (!(condition)) [[unlikely]]                                                                                 \
            ::sim::check_failed(#condition, __FILE__, __LINE__, (detail));                                             \
    } while (false)
