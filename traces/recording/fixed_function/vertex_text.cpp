#include "traces/recording/fixed_function/vertex_text.hpp"

#include "traces/recording/fixed_function/fragment_text.hpp"
#include "traces/recording/fixed_function/lighting_text.hpp"

#include <cmath>
#include <fmt/format.h>

namespace traces::fixed_function {

namespace {

/// Section 2.11.3. What no matrix can undo leaves normals as they are.
glm::mat3 normal_matrix(const FixedFunctionState& state) {
    const glm::mat3 linear(state.model_view);
    const float determinant = glm::determinant(linear);
    if (determinant == 0.0F || !std::isfinite(1.0F / determinant)) return glm::mat3(1.0F);
    const glm::mat3 inverse = glm::inverse(linear);
    // Lengths of what only was scaled come back by the length of the inverse's third row.
    const glm::vec3 row(inverse[0][2], inverse[1][2], inverse[2][2]);
    const bool rescales = state.rescale_normal && !state.normalize;
    return glm::transpose(inverse) * (rescales ? 1.0F / glm::length(row) : 1.0F);
}

class VertexWriter {
  public:
    VertexWriter(const FixedFunctionState& state, const ShaderText& fragment) : state_(state), fragment_(fragment) {}

    ShaderText write() {
        // In all programs alike, so that draws of the same vertices by two of them have equal depths.
        const std::string matrix = text_.uniform("model_view_projection", state_.projection * state_.model_view);
        text_.statement(fmt::format("gl_Position = {} * {}", matrix, position()));
        write_clip_distances();
        write_colours();
        for (std::uint32_t unit = 0; unit < fixed_function_units; ++unit)
            if (!takes_sprite_place(state_, unit) && fragment_.declares(coordinate_name(unit))) write_coordinates(unit);
        if (fragment_.declares("fog_distance")) write_fog();
        if (sizes_points(state_)) write_point_size();
        return std::move(text_);
    }

  private:
    std::string position() { return text_.input("vec4", "position"); }
    std::string eye() {
        const std::string matrix = text_.uniform("model_view", state_.model_view);
        return text_.local("vec4", "eye", fmt::format("{} * {}", matrix, position()));
    }
    std::string normal() {
        std::string turned = text_.uniform("normal_matrix", normal_matrix(state_));
        turned = fmt::format("{} * {}", turned, text_.input("vec3", "normal"));
        return text_.local("vec3", "eye_normal", state_.normalize ? fmt::format("normalize({})", turned) : turned);
    }
    std::string reflection() {
        const std::string place = eye(), upright = normal();
        return text_.local("vec3", "reflection", fmt::format("reflect(normalize({}.xyz), {})", place, upright));
    }
    std::string sphere() {
        const std::string ray = reflection();
        return text_.local("vec2", "sphere",
                           fmt::format("{0}.xy / (2.0 * length({0} + vec3(0.0, 0.0, 1.0))) + 0.5", ray));
    }

    void write_clip_distances();
    void write_colours();
    void write_colour(bool front, bool secondary);
    std::string generated(std::uint32_t unit, std::uint32_t coordinate);
    void write_coordinates(std::uint32_t unit);
    void write_fog();
    void write_point_size();

    const FixedFunctionState& state_;
    const ShaderText& fragment_;
    ShaderText text_;
};

// Section 2.12. Distances keep the number of their plane, by which they are switched on; others are not read.
void VertexWriter::write_clip_distances() {
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < pipeline::most_clip_distances; ++i)
        if ((state_.clip_planes >> i & 1U) != 0) count = i + 1;
    if (count == 0) return;
    text_.output("float", fmt::format("gl_ClipDistance[{}]", count));
    const std::string place = eye();
    for (std::uint32_t i = 0; i < count; ++i)
        if ((state_.clip_planes >> i & 1U) != 0)
            text_.statement(fmt::format("gl_ClipDistance[{}] = dot({}, {})", i,
                                        text_.uniform(fmt::format("clip_plane{}", i), state_.clip_plane[i]), place));
        else
            text_.statement(fmt::format("gl_ClipDistance[{}] = 0.0", i));
}

void VertexWriter::write_colours() {
    for (const bool front : {true, false}) {
        const bool primary = fragment_.declares(colour_name(front, false));
        const bool secondary = fragment_.declares(colour_name(front, true));
        if (state_.lighting.enabled && (primary || secondary))
            light_side(state_, front, {[this] { return eye(); }, [this] { return normal(); }}, text_);
        if (primary) write_colour(front, false);
        if (secondary) write_colour(front, true);
    }
}

void VertexWriter::write_colour(bool front, bool secondary) {
    const std::string type = secondary ? "vec3" : "vec4";
    std::string colour;
    if (state_.lighting.enabled)
        colour = std::string(secondary ? "shine_" : "lit_") + (front ? "front" : "back");
    else
        colour = text_.input(type, secondary ? "secondary_colour" : "colour");
    if (state_.clamp_vertex_colours) colour = fmt::format("clamp({}, 0.0, 1.0)", colour);
    const std::string name = text_.output(type, colour_name(front, secondary), state_.flat);
    text_.statement(fmt::format("{} = {}", name, colour));
}

/// Section 2.11.4.
std::string VertexWriter::generated(std::uint32_t unit, std::uint32_t coordinate) {
    constexpr const char* names = "strq";
    constexpr const char* components = "xyzw";
    const FixedTextureUnit& from = state_.units[unit];
    switch (from.generation[coordinate]) {
    case CoordinateGeneration::none:
        break;
    case CoordinateGeneration::object_linear: {
        const std::string plane =
            text_.uniform(fmt::format("object_plane{}_{}", unit, names[coordinate]), from.object_planes[coordinate]);
        return fmt::format("dot({}, {})", plane, position());
    }
    case CoordinateGeneration::eye_linear: {
        const std::string plane =
            text_.uniform(fmt::format("eye_plane{}_{}", unit, names[coordinate]), from.eye_planes[coordinate]);
        return fmt::format("dot({}, {})", plane, eye());
    }
    case CoordinateGeneration::sphere_map:
        return fmt::format("{}.{}", sphere(), components[coordinate]);
    case CoordinateGeneration::reflection_map:
        return fmt::format("{}.{}", reflection(), components[coordinate]);
    case CoordinateGeneration::normal_map:
        return fmt::format("{}.{}", normal(), components[coordinate]);
    }
    return fmt::format("{}.{}", text_.input("vec4", fmt::format("texcoord{}", unit)), components[coordinate]);
}

void VertexWriter::write_coordinates(std::uint32_t unit) {
    const FixedTextureUnit& from = state_.units[unit];
    std::string coordinates;
    if (from.generation == std::array<CoordinateGeneration, 4>{}) {
        coordinates = text_.input("vec4", fmt::format("texcoord{}", unit));
    } else {
        std::array<std::string, 4> parts;
        for (std::uint32_t i = 0; i < 4; ++i) parts[i] = generated(unit, i);
        coordinates = fmt::format("vec4({}, {}, {}, {})", parts[0], parts[1], parts[2], parts[3]);
    }
    if (from.matrix != glm::mat4(1.0F))
        coordinates =
            fmt::format("{} * {}", text_.uniform(fmt::format("texture_matrix{}", unit), from.matrix), coordinates);
    const std::string name = text_.output("vec4", coordinate_name(unit));
    text_.statement(fmt::format("{} = {}", name, coordinates));
}

void VertexWriter::write_fog() {
    const std::string distance =
        state_.fog.from_vertex ? text_.input("float", "fog_coordinate") : fmt::format("abs({}.z)", eye());
    text_.statement(fmt::format("{} = {}", text_.output("float", "fog_distance"), distance));
}

/// Equation 3.1, and 3.2 for what fades.
void VertexWriter::write_point_size() {
    const FixedPoints& points = state_.points;
    const std::string distance = text_.local("float", "point_distance", fmt::format("abs({}.z)", eye()));
    const std::string factors = text_.uniform("point_attenuation", points.attenuation);
    const std::string sizes =
        text_.uniform("point_sizes", glm::vec4(points.size, points.least, points.most, points.fade_threshold));
    const std::string size =
        text_.local("float", "point_size",
                    fmt::format("clamp({0}.x * inversesqrt({1}.x + {2} * ({1}.y + {2} * {1}.z)), {0}.y, {0}.z)", sizes,
                                factors, distance));
    text_.statement(fmt::format("gl_PointSize = {}", fades(points) ? fmt::format("max({}, {}.w)", size, sizes) : size));
    if (!fragment_.declares("point_fade")) return;
    const std::string ratio = text_.local("float", "fade_ratio", fmt::format("min({} / {}.w, 1.0)", size, sizes));
    text_.statement(fmt::format("{0} = {1} * {1}", text_.output("float", "point_fade"), ratio));
}

} // namespace

bool sizes_points(const FixedFunctionState& state) {
    return state.points.drawn && (fades(state.points) || state.points.attenuation != glm::vec3(1.0F, 0.0F, 0.0F));
}

ShaderText vertex_text(const FixedFunctionState& state, const ShaderText& fragment) {
    return VertexWriter(state, fragment).write();
}

} // namespace traces::fixed_function
