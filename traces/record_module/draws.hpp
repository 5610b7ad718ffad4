// Draws.
#pragma once

#include "traces/record_module/arrays.hpp"
#include "traces/record_module/stream.hpp"

#include <optional>
#include <string>
#include <vector>

namespace record {

/// All of a draw but its vertices, as the state is now.
struct PreparedDraw {
    record_stream::Draw draw;
    std::vector<std::uint32_t> slots; ///< of attributes that it reads
};

/// Nothing where it cannot be recorded, which is counted then.
std::optional<PreparedDraw> prepare_draw(const std::string& call);

/// Of a frame that is wanted, outside of display lists.
void record_draw(const DrawCall& call);

/// The context's name, once, and whether its state can be read.
bool context_is_usable(const std::string& call);

} // namespace record
