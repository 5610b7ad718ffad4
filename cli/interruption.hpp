// Ctrl-C: the program ends within a second and leaves no half-written file.
//
// The first SIGINT or SIGTERM asks the run to stop; what can be stopped does so within milliseconds. What cannot
// (reading a scene, encoding a large picture) is cut off after 0.7 s; files that are not complete by then are removed.
#pragma once

#include <atomic>

namespace cli {

/// From now on the two signals are handled as above; a file that grows too large (SIGXFSZ) and a reader that has gone
/// (SIGPIPE) are errors of writing, and standard input, output and error are open, if only to nothing: no file gets
/// their numbers. Call it once, at the start.
void catch_interruptions();

/// Becomes true with the first signal.
const std::atomic<bool>& stop_requested();

/// Says so on standard error, once.
void tell_interrupted();

/// Exit status of a program that was interrupted: 130 for SIGINT, 143 for SIGTERM.
int interrupted_status();

} // namespace cli
