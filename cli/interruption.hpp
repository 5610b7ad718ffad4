// Ctrl-C: the program ends within a second and leaves no half-written file.
//
// The first SIGINT or SIGTERM asks the run to stop; what can be stopped does so within milliseconds. What cannot
// (reading a scene) is cut off after 0.7 s, unless files are just being written: those are finished or removed first.
#pragma once

#include <atomic>

namespace cli {

/// From now on the two signals are handled as above. Call it once, at the start.
void catch_interruptions();

/// Becomes true with the first signal.
const std::atomic<bool>& stop_requested();

/// While one of these lives the program is not cut off.
class FilesInProgress {
  public:
    FilesInProgress();
    ~FilesInProgress();
    FilesInProgress(const FilesInProgress&) = delete;
    FilesInProgress& operator=(const FilesInProgress&) = delete;
};

/// Says so on standard error, once.
void tell_interrupted();

/// Exit status of a program that was interrupted: 130 for SIGINT, 143 for SIGTERM.
int interrupted_status();

} // namespace cli
