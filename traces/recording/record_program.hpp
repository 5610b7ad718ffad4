// Runs a program that draws with OpenGL and records frames of it, by a library that goes into it (record_module).
//
// Needs a driver of OpenGL 4.5 or later, whose state is asked for at each draw. Frames begin and end at swaps of
// buffers. The program ends with the last frame that is wanted.
#pragma once

#include "traces/recording/recording.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace traces {

struct RecordRequest {
    std::vector<std::string> command;  ///< program and arguments
    std::uint32_t first = 0, end = 10; ///< frames [first, end) of the application, counted from 0
    bool isotropic = false;            ///< samplers with one probe, in the program, too
};

struct RecordedProgramRun {
    Recording recording;
    std::string context; ///< OpenGL's version and the renderer
    std::string ended;   ///< how the program ended before the last frame that was asked for ("with status 0"); or ""
};

/// Throws sim::InputError for a program that cannot be run, that ends without a frame that was wanted, for what is
/// missing, with the Debian package, and where the folder for temporary files is too small; sim::Interrupted once
/// `stop` is set, with the program ended.
RecordedProgramRun record_program(const RecordRequest& request, const std::atomic<bool>& stop);

/// Of an apitrace file, played by glretrace.
RecordedProgramRun record_apitrace(const std::filesystem::path& file, RecordRequest request,
                                   const std::atomic<bool>& stop);

} // namespace traces
