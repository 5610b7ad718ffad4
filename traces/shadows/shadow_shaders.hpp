// The shaders of layered soft shadows: what the eye sees, the map that is made of the light's k-buffer, the kernel.
//
// Source: Bavoil 2007, section 5.5 (specification 004, section 2.6: passes P, B, H and K). Instructions are counted
// from the formulas of section 3.5, one per vector operation; see README.md.
#pragma once

#include "pipeline/frame.hpp"
#include "traces/shadows/shadow_kernel.hpp"

#include <memory>

namespace traces {

struct ShadowSetup {
    pipeline::View eye;
    AreaLight light;
    ShadowMapOptions map;
    ShadowKernelOptions kernel;
    float ambient = 0.0F; ///< light that reaches points in full shadow
    glm::vec3 background{1.0F};
};

/// Surfaces of four layers each.
constexpr std::uint32_t packs_of(std::uint32_t layers) { return (layers + 3) / 4; }

/// Outputs: colour, of which alpha says that there is a surface; place in the world.
std::shared_ptr<const pipeline::Shader> shadow_eye_shader(const pipeline::View& eye);

/// Reads the k-buffer; outputs: the map's layers, four in each.
std::shared_ptr<const pipeline::Shader> shadow_pack_shader(const ShadowSetup& setup);
/// Reads the k-buffer; outputs: slope biases of the layers that throw shadows, four in each.
std::shared_ptr<const pipeline::Shader> shadow_slope_shader(const ShadowSetup& setup);
/// Reads a level of the hierarchy, of which the map's first layers are the finest; output: the next level.
std::shared_ptr<const pipeline::Shader> least_depth_shader();

/// How many surfaces of each kind the kernel reads, in this order: colours, places, layers of the map, slope biases,
/// levels of the hierarchy behind the map.
struct ShadowKernelReads {
    std::uint32_t packs = 1, slopes = 0, levels = 0;

    explicit ShadowKernelReads(const ShadowSetup& setup);
    std::uint32_t first_slope() const { return 2 + packs; }
    std::uint32_t first_level() const { return first_slope() + slopes; }
    std::uint32_t count() const { return first_level() + levels; }
};
/// Output: the picture. Alpha is what the point sees of the light; 1 where no light can change the colour.
std::shared_ptr<const pipeline::Shader> shadow_kernel_shader(const ShadowSetup& setup);
/// Reads the same; output: how many samples the kernel takes.
std::shared_ptr<const pipeline::Shader> shadow_samples_shader(const ShadowSetup& setup);
/// Reads the first layers of the map and, with a slope bias, theirs; output: bias of the first layer.
std::shared_ptr<const pipeline::Shader> shadow_bias_shader(const ShadowSetup& setup);

} // namespace traces
