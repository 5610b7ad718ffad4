// The contract of a shader: what it makes of the four pixels of a quad, and what that costs.
//
// Values and cost come from the same code: shade() reads surfaces through SurfaceAccess and counts its instructions
// there. It is run ahead, for the values, and again by the pipe that executes the quad, for the work; it must be a pure
// function of its input and of the surfaces that it reads.
#pragma once

#include "pipeline/raster_state.hpp"
#include "pipeline/surface_access.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace pipeline {

/// What a pass has to provide for a shader.
struct ShaderShape {
    std::uint32_t outputs = 1;   ///< colours, one for each target of the pass
    std::uint32_t registers = 4; ///< 128-bit registers per fragment; they limit the quads in flight
    bool discards = false;
    std::vector<SurfaceId> reads; ///< surfaces that earlier passes finished
};

/// A quad. Pixel i is (x + i % 2, y + i / 2).
struct ShaderInput {
    std::uint32_t x = 0, y = 0; ///< both even
    unsigned pixels = 15;       ///< mask of those to be shaded
};

struct ShaderOutput {
    std::array<QuadTexels, most_targets_of_pass> colours{};
    unsigned alive = 0; ///< the pixels that were not discarded
};

class Shader {
  public:
    virtual ~Shader() = default;
    virtual ShaderShape shape() const = 0;
    /// `output.alive` holds the input's pixels on entry, and its colours are 0.
    virtual void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const = 0;
};

} // namespace pipeline
