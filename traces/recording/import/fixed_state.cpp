#include "traces/recording/import/fixed_state.hpp"

#include <cmath>

namespace traces::recorded {

using record_stream::FixedFunction;
using record_stream::place_of;
using record_stream::State;
using record_stream::values_of;

namespace {

float number(const std::vector<double>& values, std::size_t place) { return static_cast<float>(values.at(place)); }
std::uint32_t name_at(const std::vector<double>& values, std::size_t place) {
    return static_cast<std::uint32_t>(std::lround(values.at(place)));
}

FixedMaterial material_of(const std::vector<double>& values) {
    using record_stream::material_names;
    const auto vector = [&](GLenum name) { return fixed_vector(values, place_of(material_names, name)); };
    return {vector(GL_AMBIENT), vector(GL_DIFFUSE), vector(GL_SPECULAR), vector(GL_EMISSION),
            number(values, place_of(material_names, GL_SHININESS))};
}

FixedLight light_of(const std::vector<double>& values) {
    using record_stream::light_names;
    const auto place = [](GLenum name) { return 1 + place_of(light_names, name); }; // behind whether it is on
    const auto vector = [&](GLenum name) { return fixed_vector(values, place(name)); };
    FixedLight light;
    light.enabled = values.at(0) != 0.0;
    light.ambient = vector(GL_AMBIENT);
    light.diffuse = vector(GL_DIFFUSE);
    light.specular = vector(GL_SPECULAR);
    light.position = vector(GL_POSITION);
    const std::size_t direction = place(GL_SPOT_DIRECTION);
    light.spot_direction = {number(values, direction), number(values, direction + 1), number(values, direction + 2)};
    light.spot_exponent = number(values, place(GL_SPOT_EXPONENT));
    light.spot_cutoff = number(values, place(GL_SPOT_CUTOFF));
    light.attenuation = {number(values, place(GL_CONSTANT_ATTENUATION)), number(values, place(GL_LINEAR_ATTENUATION)),
                         number(values, place(GL_QUADRATIC_ATTENUATION))};
    return light;
}

ColourMaterial colour_material_of(std::uint32_t name) {
    switch (name) {
    case GL_EMISSION:
        return ColourMaterial::emission;
    case GL_AMBIENT:
        return ColourMaterial::ambient;
    case GL_DIFFUSE:
        return ColourMaterial::diffuse;
    case GL_SPECULAR:
        return ColourMaterial::specular;
    default:
        return ColourMaterial::ambient_and_diffuse;
    }
}

FixedLighting lighting_of(const FixedFunction& fixed) {
    FixedLighting lighting;
    lighting.enabled = fixed_value(fixed, GL_LIGHTING) != 0.0;
    lighting.ambient = fixed_vector(fixed.values, place_of(record_stream::fixed_names, GL_LIGHT_MODEL_AMBIENT));
    lighting.local_viewer = fixed_value(fixed, GL_LIGHT_MODEL_LOCAL_VIEWER) != 0.0;
    lighting.two_sided = fixed_value(fixed, GL_LIGHT_MODEL_TWO_SIDE) != 0.0;
    lighting.separate_specular = fixed_value(fixed, GL_LIGHT_MODEL_COLOR_CONTROL) == GL_SEPARATE_SPECULAR_COLOR;
    for (std::size_t i = 0; i < lighting.lights.size(); ++i) lighting.lights.at(i) = light_of(fixed.lights.at(i));
    for (std::size_t i = 0; i < 2; ++i) lighting.materials.at(i) = material_of(fixed.materials.at(i));
    if (fixed_value(fixed, GL_COLOR_MATERIAL) != 0.0) {
        const auto kind =
            colour_material_of(static_cast<std::uint32_t>(fixed_value(fixed, GL_COLOR_MATERIAL_PARAMETER)));
        const auto face = static_cast<std::uint32_t>(fixed_value(fixed, GL_COLOR_MATERIAL_FACE));
        if (face != GL_BACK) lighting.colour_material[0] = kind;
        if (face != GL_FRONT) lighting.colour_material[1] = kind;
    }
    return lighting;
}

TextureEnvironment environment_of(std::uint32_t name) {
    switch (name) {
    case GL_REPLACE:
        return TextureEnvironment::replace;
    case GL_DECAL:
        return TextureEnvironment::decal;
    case GL_BLEND:
        return TextureEnvironment::blend;
    case GL_ADD:
        return TextureEnvironment::add;
    case GL_COMBINE:
        return TextureEnvironment::combine;
    default:
        return TextureEnvironment::modulate;
    }
}

CombineFunction function_of(std::uint32_t name) {
    switch (name) {
    case GL_REPLACE:
        return CombineFunction::replace;
    case GL_ADD:
        return CombineFunction::add;
    case GL_ADD_SIGNED:
        return CombineFunction::add_signed;
    case GL_INTERPOLATE:
        return CombineFunction::interpolate;
    case GL_SUBTRACT:
        return CombineFunction::subtract;
    case GL_DOT3_RGB:
        return CombineFunction::dot3_rgb;
    case GL_DOT3_RGBA:
        return CombineFunction::dot3_rgba;
    default:
        return CombineFunction::modulate;
    }
}

CombineArgument argument_of(std::uint32_t source, std::uint32_t operand) {
    CombineArgument argument;
    switch (source) {
    case GL_TEXTURE:
        argument.source = CombineSource::texture;
        break;
    case GL_CONSTANT:
        argument.source = CombineSource::constant;
        break;
    case GL_PRIMARY_COLOR:
        argument.source = CombineSource::primary_colour;
        break;
    case GL_PREVIOUS:
        argument.source = CombineSource::previous;
        break;
    default:
        argument.source = CombineSource::texture_of_unit;
        argument.unit = static_cast<std::uint8_t>(source - GL_TEXTURE0);
    }
    argument.operand = operand == GL_SRC_COLOR             ? CombineOperand::colour
                       : operand == GL_ONE_MINUS_SRC_COLOR ? CombineOperand::one_minus_colour
                       : operand == GL_SRC_ALPHA           ? CombineOperand::alpha
                                                           : CombineOperand::one_minus_alpha;
    return argument;
}

Combiner combiner_of(const std::vector<double>& values, GLenum function, GLenum first_source, GLenum first_operand,
                     GLenum scale) {
    const auto name = [&](GLenum which) { return name_at(values, place_of(record_stream::environment_names, which)); };
    Combiner combiner;
    combiner.function = function_of(name(function));
    // The names of the three sources, and of the three operands, are numbered in a row.
    for (unsigned i = 0; i < 3; ++i)
        combiner.arguments.at(i) = argument_of(name(first_source + i), name(first_operand + i));
    combiner.scale = static_cast<std::uint8_t>(name(scale));
    return combiner;
}

UnitTarget target_of(std::uint32_t name) {
    switch (name) {
    case GL_TEXTURE_1D:
        return UnitTarget::one_dimensional;
    case GL_TEXTURE_2D:
        return UnitTarget::two_dimensional;
    case GL_TEXTURE_RECTANGLE:
        return UnitTarget::rectangle;
    case GL_TEXTURE_3D:
        return UnitTarget::three_dimensional;
    case GL_TEXTURE_CUBE_MAP:
        return UnitTarget::cube;
    default:
        return UnitTarget::none;
    }
}

CoordinateGeneration generation_of(std::uint32_t name) {
    switch (name) {
    case GL_OBJECT_LINEAR:
        return CoordinateGeneration::object_linear;
    case GL_EYE_LINEAR:
        return CoordinateGeneration::eye_linear;
    case GL_SPHERE_MAP:
        return CoordinateGeneration::sphere_map;
    case GL_REFLECTION_MAP:
        return CoordinateGeneration::reflection_map;
    case GL_NORMAL_MAP:
        return CoordinateGeneration::normal_map;
    default:
        return CoordinateGeneration::none;
    }
}

FixedTextureUnit unit_of(const std::vector<double>& values, const UnitTexture& texture) {
    using record_stream::environment_names;
    FixedTextureUnit unit;
    if (texture.there) unit.target = target_of(name_at(values, record_stream::unit_target));
    unit.format = texture.format;
    unit.compares = texture.compares;
    unit.environment = environment_of(name_at(values, place_of(environment_names, GL_TEXTURE_ENV_MODE)));
    unit.constant = fixed_vector(values, place_of(environment_names, GL_TEXTURE_ENV_COLOR));
    unit.colour = combiner_of(values, GL_COMBINE_RGB, GL_SRC0_RGB, GL_OPERAND0_RGB, GL_RGB_SCALE);
    unit.alpha = combiner_of(values, GL_COMBINE_ALPHA, GL_SRC0_ALPHA, GL_OPERAND0_ALPHA, GL_ALPHA_SCALE);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t place = record_stream::unit_generation + i * record_stream::generation_values;
        unit.generation.at(i) = generation_of(name_at(values, place));
        unit.object_planes.at(i) = fixed_vector(values, place + 1);
        unit.eye_planes.at(i) = fixed_vector(values, place + 5);
    }
    unit.matrix = fixed_matrix(values, record_stream::unit_matrix);
    unit.replaced_in_sprites = values.at(record_stream::unit_sprites) != 0.0;
    return unit;
}

FixedFog fog_of(const FixedFunction& fixed) {
    FixedFog fog;
    if (fixed_value(fixed, GL_FOG) == 0.0) return fog;
    const auto mode = static_cast<std::uint32_t>(fixed_value(fixed, GL_FOG_MODE));
    fog.mode = mode == GL_LINEAR ? FogMode::linear
               : mode == GL_EXP  ? FogMode::exponential
                                 : FogMode::exponential_squared;
    fog.from_vertex = fixed_value(fixed, GL_FOG_COORD_SRC) == GL_FOG_COORD;
    fog.colour = fixed_vector(fixed.values, place_of(record_stream::fixed_names, GL_FOG_COLOR));
    fog.density = static_cast<float>(fixed_value(fixed, GL_FOG_DENSITY));
    fog.start = static_cast<float>(fixed_value(fixed, GL_FOG_START));
    fog.end = static_cast<float>(fixed_value(fixed, GL_FOG_END));
    return fog;
}

FixedPoints points_of(const FixedFunction& fixed, const State& state) {
    const auto value = [&](GLenum name, std::size_t i = 0) { return static_cast<float>(fixed_value(fixed, name, i)); };
    FixedPoints points;
    points.drawn = true;
    points.size = static_cast<float>(value_in(state, GL_POINT_SIZE));
    points.least = value(GL_POINT_SIZE_MIN);
    points.most = value(GL_POINT_SIZE_MAX);
    points.attenuation = {value(GL_POINT_DISTANCE_ATTENUATION, 0), value(GL_POINT_DISTANCE_ATTENUATION, 1),
                          value(GL_POINT_DISTANCE_ATTENUATION, 2)};
    points.fade_threshold = value(GL_POINT_FADE_THRESHOLD_SIZE);
    points.sprites = is_on(state, GL_POINT_SPRITE);
    return points;
}

/// GL_FIXED_ONLY clamps for targets of fixed point, which nearly all are.
bool clamps(const FixedFunction& fixed, GLenum name) { return fixed_value(fixed, name) != GL_FALSE; }

} // namespace

double fixed_value(const FixedFunction& fixed, GLenum name, std::size_t i) {
    return fixed.values.at(place_of(record_stream::fixed_names, name) + i);
}

glm::vec4 fixed_vector(const std::vector<double>& values, std::size_t place) {
    return {number(values, place), number(values, place + 1), number(values, place + 2), number(values, place + 3)};
}

glm::mat4 fixed_matrix(const std::vector<double>& values, std::size_t place) {
    glm::mat4 matrix{1.0F};
    for (int column = 0; column < 4; ++column)
        matrix[column] = fixed_vector(values, place + 4 * static_cast<std::size_t>(column));
    return matrix;
}

UnitTexture unit_texture_of(const record_stream::Binding& binding, const record_stream::Surface& surface) {
    const auto& bits = surface.bits;
    UnitTexture texture{true, BaseFormat::rgba, false};
    const bool alpha = bits[record_stream::bits_alpha] != 0;
    if (bits[record_stream::bits_depth] != 0) {
        texture.compares = binding.sampler.compare_mode == GL_COMPARE_REF_TO_TEXTURE;
        texture.format = binding.depth_mode == GL_INTENSITY ? BaseFormat::intensity
                         : binding.depth_mode == GL_ALPHA   ? BaseFormat::alpha
                         : binding.depth_mode == GL_RED     ? BaseFormat::red
                                                            : BaseFormat::luminance;
    } else if (bits[record_stream::bits_luminance] != 0) {
        texture.format = alpha ? BaseFormat::luminance_alpha : BaseFormat::luminance;
    } else if (bits[record_stream::bits_intensity] != 0) {
        texture.format = BaseFormat::intensity;
    } else if (bits[record_stream::bits_red] == 0) {
        texture.format = BaseFormat::alpha;
    } else if (bits[record_stream::bits_green] == 0) {
        texture.format = BaseFormat::red;
    } else if (bits[record_stream::bits_blue] == 0) {
        texture.format = BaseFormat::red_green;
    } else if (!alpha) {
        texture.format = BaseFormat::rgb;
    }
    return texture;
}

FixedFunctionState fixed_function_state_of(const FixedFunction& fixed, const State& state,
                                           const std::array<UnitTexture, fixed_function_units>& textures, GLenum mode) {
    using record_stream::fixed_names;
    FixedFunctionState result;
    result.model_view = fixed_matrix(fixed.values, place_of(fixed_names, GL_MODELVIEW_MATRIX));
    result.projection = fixed_matrix(fixed.values, place_of(fixed_names, GL_PROJECTION_MATRIX));
    for (unsigned i = 0; i < record_stream::clip_planes; ++i) {
        if (is_on(state, GL_CLIP_DISTANCE0 + i)) result.clip_planes |= static_cast<std::uint8_t>(1U << i);
        result.clip_plane.at(i) =
            fixed_vector(fixed.values, values_of(fixed_names) + i * record_stream::clip_plane_values);
    }
    result.normalize = fixed_value(fixed, GL_NORMALIZE) != 0.0;
    result.rescale_normal = fixed_value(fixed, GL_RESCALE_NORMAL) != 0.0;
    result.lighting = lighting_of(fixed);
    result.flat = value_in(state, GL_SHADE_MODEL) == GL_FLAT;
    result.colour_sum = fixed_value(fixed, GL_COLOR_SUM) != 0.0;
    result.clamp_vertex_colours = clamps(fixed, GL_CLAMP_VERTEX_COLOR);
    result.clamp_fragment_colours = clamps(fixed, GL_CLAMP_FRAGMENT_COLOR);
    for (std::size_t i = 0; i < result.units.size(); ++i)
        result.units.at(i) = unit_of(fixed.units.at(i), textures.at(i));
    result.fog = fog_of(fixed);
    if (mode == GL_POINTS) result.points = points_of(fixed, state);
    if (is_on(state, GL_ALPHA_TEST)) {
        result.alpha_test = compare_of(static_cast<std::uint32_t>(value_in(state, GL_ALPHA_TEST_FUNC)));
        result.alpha_reference = static_cast<float>(value_in(state, GL_ALPHA_TEST_REF));
    }
    return result;
}

} // namespace traces::recorded
