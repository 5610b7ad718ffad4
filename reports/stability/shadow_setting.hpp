// Shadow maps and lights as the cases of soft shadows state them.
#pragma once

#include "pipeline/functional/eye_depth.hpp"
#include "traces/shadows/shadow_kernel.hpp"

#include <cmath>
#include <functional>
#include <vector>

namespace reports::stability::shadows {

using traces::AreaLight;
using traces::covered_share;
using traces::ShadowBias;
using traces::ShadowFormat;
using traces::ShadowKernel;
using traces::ShadowKernelOptions;
using traces::ShadowMap;
using traces::ShadowMapOptions;

/// l = width, n = w = 1; the map's texels are 1/resolution of the near plane.
inline AreaLight unit_light(double width = 1.0) {
    AreaLight light;
    light.width = width;
    light.near = light.near_width = 1.0;
    light.far = 1000.0;
    return light;
}

inline glm::dvec3 point(const AreaLight& light, double x, double y, double z) {
    return light.centre + x * light.right + y * light.up + z * light.forward;
}

/// Distances by layer and place of the near plane, (-0.5, 0.5) across; infinite: no surface.
using Layer = std::function<double(double x, double y)>;

inline ShadowMap map_of(const AreaLight& light, ShadowMapOptions options, const std::vector<Layer>& layers) {
    const std::uint32_t r = options.resolution;
    options.captured = static_cast<std::uint32_t>(layers.size());
    options.layers = std::min(options.layers, options.captured);
    const std::size_t floats = std::size_t{options.captured + 3} / 4 * 4;
    std::vector<float> kbuffer(std::size_t{r} * r * floats, 2.0F);
    const pipeline::EyeDepth depth(light.view(r).projection);
    for (std::uint32_t y = 0; y < r; ++y)
        for (std::uint32_t x = 0; x < r; ++x)
            for (std::size_t layer = 0; layer < layers.size(); ++layer) {
                const double z = layers[layer]((x + 0.5) / r - 0.5, 0.5 - (y + 0.5) / r);
                if (std::isfinite(z)) kbuffer[(std::size_t{y} * r + x) * floats + layer] = depth.window(z);
            }
    return {light, kbuffer, floats, options};
}

inline Layer plane(double z) {
    return [z](double, double) { return z; };
}
inline const Layer nothing = [](double, double) { return INFINITY; };

inline constexpr ShadowMapOptions floats_32{.resolution = 256, .format = ShadowFormat::rgba32f};
inline constexpr ShadowKernelOptions all_texels{.most_samples = 65025};

inline double visibility(const ShadowMap& map, const ShadowKernelOptions& options, const glm::dvec3& at) {
    const ShadowKernel kernel(map, options);
    return static_cast<double>(kernel.visibility(kernel.region(at), 7));
}

} // namespace reports::stability::shadows
