// Smaller recordings: a range of frames or of draws, and only what they name.
#pragma once

#include "traces/recording/recording.hpp"

namespace traces {

/// Numbers [first, end).
struct CutRange {
    std::uint32_t first = 0, end = 0;
};

struct Cut {
    std::optional<CutRange> frames; ///< by RecordedFrame::number; none: all
    std::optional<CutRange> draws;  ///< of the one frame, from 0; none: all
};

/// What a range of frames, or of draws within one frame, needs.
///
/// Of earlier frames those commands stay, in front of the first frame, that make what is then read of a surface before
/// it is wholly set. What surfaces hold in the beginning becomes 0 where it is set before it is read. With `draws`, the
/// other draws of the frame are left out, and so is all behind the last of them; clears and copies before it stay. The
/// frame then shows what its last draw draws to, if that has a colour. Throws sim::InputError for a range that is empty
/// or not there.
Recording cut(const Recording& recording, const Cut& what);

/// Leaves out what no command names. Clears lose what their targets do not have, and go when nothing is left of them.
Recording compact(Recording recording);

} // namespace traces
