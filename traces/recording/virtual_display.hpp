// An X server without a screen, for programs that need windows where nothing shows any.
#pragma once

#include "traces/recording/running_program.hpp"

#include <atomic>
#include <optional>
#include <string>

namespace traces {

/// Whether the environment names a server that shows windows.
bool has_display();

/// Xvfb, as long as it lives.
class VirtualDisplay {
  public:
    /// Throws sim::InputError when none starts, sim::Interrupted once `stop` is set.
    explicit VirtualDisplay(const std::atomic<bool>& stop);
    /// For the variable DISPLAY.
    std::string name() const { return ":" + number_; }

  private:
    void read_number(int descriptor, const std::atomic<bool>& stop);

    std::optional<RunningProgram> server_;
    std::string number_;
};

} // namespace traces
