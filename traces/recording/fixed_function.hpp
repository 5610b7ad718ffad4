// Vertex and fragment processing of draws that bring no shaders, and the shaders that do the same.
//
// Modelled: transformation, clip planes, lighting, texture coordinates, texture environments, colour sum, fog, alpha
// test, points. What selects an operation is in the shaders' texts, and what it is done with is in their uniforms: two
// states need the same program when both texts are equal. Text depends on a value in these places alone: identity
// texture matrices, directional lights, lights without attenuation or cone, sizes of points without attenuation.
//
// Source: OpenGL 2.1 specification, sections 2.11 to 2.14, 3.3, 3.8.13, 3.9, 3.10, 3.13 and 4.1.4; clamping of colours
// as ARB_color_buffer_float has it. Distances of fog and points are |z| in eye space, which the specification allows
// for fog and drivers take for both.
// Not modelled: antialiased points, lines and polygons, stipples, colour index mode, vertex weights; positions in eye
// space have w = 1 for lights, fog and generated texture coordinates.
#pragma once

#include "pipeline/raster_state.hpp"
#include "traces/recording/recording.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace traces {

inline constexpr std::uint32_t fixed_function_lights = 8, fixed_function_units = 8;

/// Colours of a surface, section 2.14.1.
struct FixedMaterial {
    glm::vec4 ambient{0.2F, 0.2F, 0.2F, 1.0F}, diffuse{0.8F, 0.8F, 0.8F, 1.0F};
    glm::vec4 specular{0.0F, 0.0F, 0.0F, 1.0F}, emission{0.0F, 0.0F, 0.0F, 1.0F};
    float shininess = 0.0F;
};

/// Which of a material's colours the vertex's colour takes the place of.
enum class ColourMaterial : std::uint8_t { none, emission, ambient, diffuse, specular, ambient_and_diffuse };

struct FixedLight {
    bool enabled = false;
    glm::vec4 ambient{0.0F, 0.0F, 0.0F, 1.0F}, diffuse{1.0F}, specular{1.0F};
    glm::vec4 position{0.0F, 0.0F, 1.0F, 0.0F};  ///< eye space; w = 0: the direction from which it shines
    glm::vec3 spot_direction{0.0F, 0.0F, -1.0F}; ///< eye space
    float spot_exponent = 0.0F;
    float spot_cutoff = 180.0F;              ///< degrees from the axis to the cone; 180: none
    glm::vec3 attenuation{1.0F, 0.0F, 0.0F}; ///< factors of 1, d and d^2
};

struct FixedLighting {
    bool enabled = false;
    glm::vec4 ambient{0.2F, 0.2F, 0.2F, 1.0F}; ///< of the scene
    bool local_viewer = false, two_sided = false;
    bool separate_specular = false; ///< is added behind the textures
    std::array<FixedLight, fixed_function_lights> lights;
    std::array<FixedMaterial, 2> materials; ///< front, back
    std::array<ColourMaterial, 2> colour_material{ColourMaterial::none, ColourMaterial::none};
};

/// The one target of a texture unit that counts.
enum class UnitTarget : std::uint8_t {
    none,
    one_dimensional, ///< sampled as a two-dimensional texture of one row
    two_dimensional,
    rectangle,
    three_dimensional,
    cube
};

/// What a texture has channels for. Of depth textures: the format that their depths are read as.
enum class BaseFormat : std::uint8_t { alpha, luminance, luminance_alpha, intensity, red, red_green, rgb, rgba };

enum class TextureEnvironment : std::uint8_t { modulate, replace, decal, blend, add, combine };

enum class CombineFunction : std::uint8_t {
    replace,
    modulate,
    add,
    add_signed,
    interpolate,
    subtract,
    dot3_rgb, ///< the last two: of colours alone
    dot3_rgba ///< gives alpha, too
};

enum class CombineSource : std::uint8_t {
    texture,         ///< the unit's own
    texture_of_unit, ///< CombineArgument::unit
    constant,
    primary_colour,
    previous
};

enum class CombineOperand : std::uint8_t { colour, one_minus_colour, alpha, one_minus_alpha };

struct CombineArgument {
    CombineSource source = CombineSource::previous;
    CombineOperand operand = CombineOperand::colour; ///< for alpha, colour means alpha
    std::uint8_t unit = 0;

    bool operator==(const CombineArgument&) const = default;
};

struct Combiner {
    CombineFunction function = CombineFunction::modulate;
    std::array<CombineArgument, 3> arguments{{{CombineSource::texture, CombineOperand::colour},
                                              {CombineSource::previous, CombineOperand::colour},
                                              {CombineSource::constant, CombineOperand::alpha}}};
    std::uint8_t scale = 1; ///< 1, 2 or 4
};

enum class CoordinateGeneration : std::uint8_t {
    none, ///< from the vertex
    object_linear,
    eye_linear,
    sphere_map,     ///< s and t alone
    reflection_map, ///< not q; likewise the next
    normal_map
};

struct FixedTextureUnit {
    UnitTarget target = UnitTarget::none;
    BaseFormat format = BaseFormat::rgba;
    bool compares = false; ///< a depth texture whose sampler compares
    TextureEnvironment environment = TextureEnvironment::modulate;
    glm::vec4 constant{0.0F};
    Combiner colour, alpha;                           ///< of TextureEnvironment::combine
    std::array<CoordinateGeneration, 4> generation{}; ///< of s, t, r, q
    std::array<glm::vec4, 4> object_planes{{{1.0F, 0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F, 0.0F}}};
    std::array<glm::vec4, 4> eye_planes{{{1.0F, 0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F, 0.0F}}}; ///< for eye space
    glm::mat4 matrix{1.0F};
    bool replaced_in_sprites = false; ///< by the place in the point, where points are sprites
};

enum class FogMode : std::uint8_t { none, linear, exponential, exponential_squared };

struct FixedFog {
    FogMode mode = FogMode::none;
    bool from_vertex = false; ///< the distance is the vertex's fog coordinate
    glm::vec4 colour{0.0F};
    float density = 1.0F, start = 0.0F, end = 1.0F;
};

struct FixedPoints {
    bool drawn = false; ///< the draw is of points; false: nothing else here counts
    float size = 1.0F, least = 0.0F, most = 1.0F;
    glm::vec3 attenuation{1.0F, 0.0F, 0.0F}; ///< factors of 1, d and d^2
    bool fades = false; ///< several samples a pixel: points below the threshold become transparent instead of smaller
    float fade_threshold = 1.0F;
    bool sprites = false;
};

struct FixedFunctionState {
    glm::mat4 model_view{1.0F}, projection{1.0F};
    std::uint8_t clip_planes = 0;                                      ///< bit i: plane i cuts
    std::array<glm::vec4, pipeline::most_clip_distances> clip_plane{}; ///< eye space
    bool normalize = false, rescale_normal = false;
    FixedLighting lighting;
    bool flat = false;       ///< colours are those of the provoking vertex
    bool colour_sum = false; ///< the vertex's secondary colour is added behind the textures; lighting overrides this
    bool clamp_vertex_colours = true, clamp_fragment_colours = true; ///< to 0 to 1
    std::array<FixedTextureUnit, fixed_function_units> units;
    FixedFog fog;
    FixedPoints points;
    pipeline::Compare alpha_test = pipeline::Compare::always;
    float alpha_reference = 0.0F;
    /// Of the target's alpha between 0 and 1: the test compares whole numbers of them; 0: floats.
    float alpha_steps = 255.0F;
};

/// GLSL 1.40, and what goes with it.
struct FixedFunctionProgram {
    std::string vertex, fragment;
    /// position, normal, colour, secondary_colour, texcoord0 to texcoord7; fog_coordinate is generic attribute 0.
    std::vector<ShaderInputSource> inputs;
    std::vector<UniformValue> vertex_values, fragment_values; ///< of all that are declared; compilers may drop some
    std::vector<std::uint32_t> units; ///< that the fragment shader samples, as texture0 to texture7
    bool sizes_points = false;        ///< pipeline::RasterState::point_size_of_vertex
};

/// Tests alpha itself: RecordedDraw::alpha_test stays `always`. Throws sim::InputError for what no application can ask
/// for.
FixedFunctionProgram fixed_function_program(const FixedFunctionState& state);

} // namespace traces
