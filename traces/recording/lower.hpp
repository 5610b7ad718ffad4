// Frames of the pipeline from what an application drew.
//
// Commands with the same targets, one after the other, are one pass. Clears of whole surfaces stay clears; those of
// parts, copies and blits are drawn, as GPUs do. What was recorded is not changed: what cannot be drawn as it is, is
// refused or noted.
#pragma once

#include "pipeline/frame.hpp"
#include "traces/recording/kbuffer_choice.hpp"
#include "traces/recording/recording.hpp"

#include <optional>
#include <string>

namespace traces {

struct LowerOptions {
    /// Which of Recording::frames, the last one included. Of those before, what their surfaces keep is drawn, too.
    std::uint32_t first_frame = 0, last_frame = 0;
    std::optional<KBufferChoice> kbuffer{}; ///< in place of their blending
    bool cold = false;                      ///< caches are empty when a frame begins

    /// Of texts as the command line takes them: "3" or "3:5" (3 and 4), or "" for the last frame; KBufferChoice::of(),
    /// or "". Throws sim::InputError.
    static LowerOptions of(const Recording& recording, const std::string& frames, const std::string& kbuffer,
                           std::uint32_t k);
};

/// Throws sim::InputError naming the draw, program or surface that is not modelled.
/// @param where begins the message
pipeline::Frame lower(const Recording& recording, const LowerOptions& options, const std::string& where);

} // namespace traces
