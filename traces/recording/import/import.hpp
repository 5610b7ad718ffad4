// What a recorded program's library wrote, as a Recording.
#pragma once

#include "traces/recording/recording.hpp"

#include <cstddef>
#include <span>

namespace traces::recorded {

struct ImportedStream {
    Recording recording;
    std::string context;   ///< whose state was read: version and renderer; empty: nothing was recorded
    bool finished = false; ///< the last frame that was wanted is there
};

/// Compiles the programs' GLSL. Frames that do not end are left out. Throws sim::InputError.
ImportedStream import_stream(std::span<const std::byte> bytes);

} // namespace traces::recorded
