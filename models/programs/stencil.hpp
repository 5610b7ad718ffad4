// Modify program `stencil`: the stencil test of every GPU as a k-buffer of one entry, a counter and a compare.
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <cstdint>
#include <memory>

namespace models {

enum class StencilCompare : std::uint8_t { always, never, less, less_or_equal, equal, not_equal, greater };
enum class StencilOperation : std::uint8_t { keep, zero, replace, increment, decrement };

/// A fragment passes when `reference` compares so with the stored value: `less` is reference < stored.
struct StencilSetup {
    StencilCompare compare = StencilCompare::always;
    std::uint8_t reference = 0;
    StencilOperation pass = StencilOperation::increment; ///< saturates at 255
    StencilOperation fail = StencilOperation::keep;
};

/// One entry: the depth of the last fragment that passed (`empty_depth` before), and the stencil value, 0 to 255.
std::shared_ptr<const pipeline::ModifyProgram> make_stencil(const StencilSetup& setup);

} // namespace models
