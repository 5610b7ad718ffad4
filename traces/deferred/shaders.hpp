// The shaders of deferred shading with one transparent layer: G-buffer, shadow map, light, composition.
//
// Instructions are the arithmetic slots that the thesis counted where it counted them (section 4.2: light 66 and 82,
// composition 14 and 27); its texture slots are what the code reads. G-buffer and shadow map were not counted: theirs
// are those of the operations written here. Both sides of a branch are issued, as the text says of its machine.
// Source: Aladağlı 2015, chapter 3 (specification 003, B3 to B8).
#pragma once

#include "pipeline/frame.hpp"
#include "traces/deferred/material_reads.hpp"
#include "traces/deferred/spot_lights.hpp"

#include <memory>
#include <vector>

namespace traces {

/// What a fragment's draw says beside colour and normal.
struct DeferredDraw {
    float opacity = 1.0F;      ///< of a transmitting material; scales the alpha of its colour
    bool double_sided = false; ///< its back faces are lit as well, from behind
    bool mirrored = false;     ///< its front faces are clockwise

    /// Its normals are, on triangles that face the screen like that: as matrices take them along they point inwards in
    /// a mirrored draw, and those of back faces are lit from behind.
    bool turned_over(bool front) const { return mirrored != (double_sided && front == mirrored); }
};
std::vector<DeferredDraw> deferred_draws(const pipeline::Frame& frame);

/// Which fragments a G-buffer keeps.
enum class Layer : std::uint8_t {
    interlaced, ///< even rows: opaque ones; odd rows: all
    nearest,    ///< all
    behind      ///< opaque ones behind the depth that its only surface holds
};

/// What shaders of surfaces read of their materials; behind the surfaces that are named for a shader it reads
/// MaterialReads::surfaces().
using SharedMaterials = std::shared_ptr<const MaterialReads>;

/// Outputs: colour and opacity; normal in the world, from [-1,1] to [0,1]; specular intensity, power / 255, and light
/// that it sends out (emission.hpp); window depth.
std::shared_ptr<const pipeline::Shader> gbuffer_shader(const pipeline::Frame& frame, SharedMaterials materials,
                                                       Layer layer);

/// Outputs: the ambient share of the colour with what the surface sends out, and opacity; normal; window depth, if
/// asked for. Rows as `interlaced`.
std::shared_ptr<const pipeline::Shader> ambient_shader(const pipeline::Frame& frame, SharedMaterials materials,
                                                       float ambient, bool depths);

enum class Shadows : std::uint8_t { none, opaque, transparent };

/// What a shadow map of transparent shadows is.
enum class ShadowMaps : std::uint8_t {
    rows,     ///< rows take turns, as those of the G-buffer
    two_class ///< a k-buffer
};

/// Outputs: window depth and, with transparent shadows, colour and opacity; then even rows keep opaque fragments alone.
std::shared_ptr<const pipeline::Shader> shadow_shader(const pipeline::Frame& frame, Shadows shadows);

struct LightOptions {
    Shadows shadows = Shadows::transparent;
    ShadowMaps maps = ShadowMaps::rows;
    std::uint32_t map_size = 1024;
    double bias = 1e-3; ///< over the range of the light: receivers come that much nearer to it
    double intensity = 1.0;
};
/// Reads normals, specular, depth and the shadow map; output: diffuse light, and specular in alpha. A shadow map is
/// depths, with transparent shadows then colours; or one k-buffer.
std::shared_ptr<const pipeline::Shader> light_shader(const pipeline::View& eye, const SpotLight& light,
                                                     const LightOptions& options);

/// The same on the surfaces that are drawn, in their colour and for additive blending. Reads the shadow map.
std::shared_ptr<const pipeline::Shader> forward_light_shader(const pipeline::Frame& frame, SharedMaterials materials,
                                                             const SpotLight& light, const LightOptions& options);

struct CompositionOptions {
    bool refraction = true;
    double coefficient = 0.03; ///< of the picture's height: the offset of a normal across the view
    bool glowing = false;      ///< surfaces send out light; forward rendering has added it before
};
/// Whose rows a composition takes apart.
enum class Interlaced : std::uint8_t {
    deferred,       ///< colours, light, with refraction normals and depths, and specular where surfaces glow
    forward,        ///< lit colours and, with refraction, normals: panes are known by their opacity alone
    forward_depths, ///< lit colours and, with refraction, normals and depths
};
/// Reads these surfaces.
std::shared_ptr<const pipeline::Shader> interlaced_composition(const pipeline::View& eye,
                                                               const CompositionOptions& options,
                                                               Interlaced what = Interlaced::deferred);
/// Lays the nearest surfaces over those behind. Reads colours, light, normals and depths of the nearest, then colours,
/// light and depths of the others, and where surfaces glow specular of the nearest and of the others.
std::shared_ptr<const pipeline::Shader> peeled_composition(const pipeline::View& eye,
                                                           const CompositionOptions& options);

// Where a k-buffer of program two-class is the G-buffer, or a shadow map; entries as TwoClassSurface packs them.

/// Output: the words of an entry.
std::shared_ptr<const pipeline::Shader> two_class_gbuffer_shader(const pipeline::Frame& frame,
                                                                 SharedMaterials materials);
/// Output: the words of an entry, with colour and opacity alone.
std::shared_ptr<const pipeline::Shader> two_class_shadow_shader(const pipeline::Frame& frame);
/// Reads the k-buffer and the shadow map; outputs: light on transparent surfaces, and on opaque ones.
std::shared_ptr<const pipeline::Shader> two_class_light_shader(const pipeline::View& eye, const SpotLight& light,
                                                               const LightOptions& options);
/// Reads the k-buffer, light on transparent surfaces and on opaque ones.
std::shared_ptr<const pipeline::Shader> two_class_composition(const pipeline::View& eye,
                                                              const CompositionOptions& options);

} // namespace traces

template <>
struct sim::EnumNames<traces::ShadowMaps> {
    static constexpr std::array<std::string_view, 2> names{"rows", "two-class"};
};

template <>
struct sim::EnumNames<traces::Shadows> {
    static constexpr std::array<std::string_view, 3> names{"none", "opaque", "transparent"};
};
