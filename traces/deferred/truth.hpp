// The picture of deferred shading as rays have it: what every method of it approaches.
//
// Surfaces, light, shadows, refraction and composition are those of the methods (specification 003, B1, B6, B8), by the
// same formulas and in doubles (maps of materials by the same code, in their own level for the pixel's rays and in
// their finest for others), for the first opaque surface along a ray and the first transparent one in front of it. What
// is left of the methods is what they lose: rows of a G-buffer, texels of a shadow map with their biases, bits. Of
// light that adds up to more than 1 a screen shows 1: the picture ends there, sums of light do not.
//
// Not modelled: refraction by Snell's law. `total_reflection` marks where it would show something else altogether.
#pragma once

#include "sim/described.hpp"
#include "traces/deferred/shaders.hpp"
#include "traces/rays.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace traces {

/// What transparent surfaces between a light and a point let pass: the share of the light that equation 3.1 says, of
/// the one nearest to the light, which is all that a shadow map keeps, or of each of them.
enum class TruthFilter : std::uint8_t { nearest, product };

struct DeferredTruth {
    std::vector<SpotLight> lights;
    Shadows shadows = Shadows::transparent;
    TruthFilter filter = TruthFilter::nearest;
    CompositionOptions composition;
    double intensity = 1.0;
    double ambient = 0.1;
    double specular = 0.3; ///< of materials that state nothing, like the power
    double specular_power = 32.0;
    bool maps = true; ///< materials state what they do; see MaterialReads
};

/// `frame` is that of the workload. Channels: distances of the first opaque surface and, where one is in front of it,
/// of the first transparent one, and there whether glass with an index of 1.5 behind it reflects totally: 1 where the
/// ray, bent as it enters the body, or unbent where it begins within, leaves it at more than 41.8 degrees.
TruthMethod deferred_truth(const Scene& scene, const pipeline::Frame& frame, DeferredTruth options);

} // namespace traces

template <>
struct sim::EnumNames<traces::TruthFilter> {
    static constexpr std::array<std::string_view, 2> names{"nearest", "product"};
};
