// Which draws of a recording go through a k-buffer instead of being blended, and what of their blending it can keep.
//
// A draw that is blended leaves the colour c + t * before, where c and t are of its fragment alone: c is its colour
// times the source factor, t the target factor. Such nodes are kept sorted by depth, and what is left of them is laid
// over the target at once.
#pragma once

#include "pipeline/raster_state.hpp"

#include <cstdint>
#include <glm/vec4.hpp>
#include <string>
#include <string_view>

namespace traces {

/// "3", or "3:5", which is 3 and 4; false where it is neither.
bool parse_range(std::string_view text, std::uint32_t& first, std::uint32_t& last);

struct KBufferChoice {
    enum class Kind : std::uint8_t { blended, draws, pass };
    Kind kind = Kind::blended;
    std::uint32_t first = 0, last = 0; ///< draws of a frame, counted from 0, the last one included; or the pass
    std::uint32_t k = 4;               ///< nodes of a pixel

    /// "blended" (or "blended draws"), "draws=3:7", "draws=3" or "pass=2". Throws sim::InputError.
    static KBufferChoice of(const std::string& text, std::uint32_t k);
};

/// Factors of a draw's blending, for nodes.
struct NodeBlend {
    pipeline::BlendFactor source = pipeline::BlendFactor::one, target = pipeline::BlendFactor::zero;

    /// {c, t} of a fragment.
    glm::vec4 node(const glm::vec4& colour) const;
};

/// Why a draw with this state cannot be kept in nodes; "" when it can.
std::string not_for_nodes(const pipeline::RasterState& state);

} // namespace traces
