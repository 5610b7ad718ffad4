// Which levels of a texture a read takes, and how: from the footprint of a pixel to levels and filters.
//
// Source: OpenGL 4.5 core, section 8.14; anisotropy as EXT_texture_filter_anisotropic describes it: N probes in a row
// along the longer axis of the footprint, where N = min(ceil(longer / shorter), most), each filtered at the level of
// the N-th part of the longer axis. Not modelled: limits on biases.
#pragma once

#include "pipeline/texture_lookup.hpp"

#include <cstdint>

namespace pipeline {

inline constexpr std::uint32_t most_probes = 16;

/// How far places move from a pixel to the next to the right and to the next below: squared, in texels of the base
/// level. May be infinite or no number.
struct PixelFootprint {
    double right = 0.0, down = 0.0;
};

struct FootprintLevel {
    float lod = 0.0F; ///< above the base level; before biases and bounds
    std::uint32_t probes = 1;
    bool probes_down = false; ///< along `down`
};

/// `anisotropy`: the most probes. What is magnified needs one.
FootprintLevel footprint_level(const PixelFootprint& footprint, float anisotropy);

/// With the sampler's bias, within its bounds. No number counts as 0.
float bounded_lod(const SamplerState& sampler, float lod);

struct LevelReads {
    std::uint32_t level = 0; ///< the finer one
    float blend = 0.0F;      ///< share of the next; 0: it is not read
    bool linear = false;     ///< within a level

    bool operator==(const LevelReads&) const = default;
};

/// `lod` above level `base`; `last` is the coarsest that may be read.
LevelReads reads_of_levels(const SamplerState& sampler, float lod, std::uint32_t base, std::uint32_t last);

} // namespace pipeline
