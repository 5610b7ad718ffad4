#include "traces/record_module/state.hpp"

#include "traces/record_module/context.hpp"
#include "traces/record_module/fixed_state_names.hpp"

namespace record {

using namespace record_stream;

namespace {

/// Appends what `query(name, floats)` gives for each name.
template <class Names, class Query>
void append(std::vector<double>& values, const Names& names, Query query) {
    for (const StateName& each : names) {
        std::array<float, 16> found{};
        query(each.name, found.data());
        values.insert(values.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(each.values));
    }
}

std::uint32_t unsigned_at(GLenum name, GLuint index) { return static_cast<std::uint32_t>(integer_at(name, index)); }

void append_generation(std::vector<double>& values) {
    struct Coordinate {
        GLenum name, enabled;
    };
    constexpr std::array<Coordinate, 4> coordinates{
        {{GL_S, GL_TEXTURE_GEN_S}, {GL_T, GL_TEXTURE_GEN_T}, {GL_R, GL_TEXTURE_GEN_R}, {GL_Q, GL_TEXTURE_GEN_Q}}};
    for (const Coordinate& each : coordinates) {
        GLint mode = 0;
        if (REAL(glIsEnabled)(each.enabled) != GL_FALSE) REAL(glGetTexGeniv)(each.name, GL_TEXTURE_GEN_MODE, &mode);
        std::array<double, 4> object{}, eye{};
        REAL(glGetTexGendv)(each.name, GL_OBJECT_PLANE, object.data());
        REAL(glGetTexGendv)(each.name, GL_EYE_PLANE, eye.data());
        values.push_back(mode);
        values.insert(values.end(), object.begin(), object.end());
        values.insert(values.end(), eye.begin(), eye.end());
    }
}

std::vector<double> texture_unit(std::uint32_t unit) {
    REAL(glActiveTexture)(GL_TEXTURE0 + unit);
    std::vector<double> values;
    append(values, environment_names, [](GLenum name, float* found) {
        REAL(glGetTexEnvfv)(GL_TEXTURE_ENV, name, found);
    });
    values.push_back(enabled_target(unit));
    GLint sprites = 0;
    REAL(glGetTexEnviv)(GL_POINT_SPRITE, GL_COORD_REPLACE, &sprites);
    values.push_back(sprites);
    append_generation(values);
    std::array<double, 16> matrix{};
    REAL(glGetDoublev)(GL_TEXTURE_MATRIX, matrix.data());
    values.insert(values.end(), matrix.begin(), matrix.end());
    return values;
}

} // namespace

State current_state() {
    State state;
    state.compatibility = current_context().compatibility;
    for (const StateName& each : state_names) {
        std::array<double, 16> found{};
        if (!each.compatibility || state.compatibility) REAL(glGetDoublev)(each.name, found.data());
        state.values.insert(state.values.end(), found.begin(),
                            found.begin() + static_cast<std::ptrdiff_t>(each.values));
    }
    for (GLuint i = 0; i < most_targets; ++i) {
        TargetState& target = state.targets.at(i);
        target.blend = REAL(glIsEnabledi)(GL_BLEND, i) != GL_FALSE;
        target.source_colour = unsigned_at(GL_BLEND_SRC_RGB, i);
        target.target_colour = unsigned_at(GL_BLEND_DST_RGB, i);
        target.source_alpha = unsigned_at(GL_BLEND_SRC_ALPHA, i);
        target.target_alpha = unsigned_at(GL_BLEND_DST_ALPHA, i);
        target.equation_colour = unsigned_at(GL_BLEND_EQUATION_RGB, i);
        target.equation_alpha = unsigned_at(GL_BLEND_EQUATION_ALPHA, i);
        std::array<GLboolean, 4> mask{};
        REAL(glGetBooleani_v)(GL_COLOR_WRITEMASK, i, mask.data());
        target.write_mask = 0;
        for (std::size_t channel = 0; channel < 4; ++channel)
            if (mask.at(channel) != GL_FALSE) target.write_mask |= 1U << channel;
    }
    return state;
}

std::uint32_t enabled_target(std::uint32_t unit) {
    REAL(glActiveTexture)(GL_TEXTURE0 + unit);
    constexpr std::array<GLenum, 5> targets{GL_TEXTURE_CUBE_MAP, GL_TEXTURE_3D, GL_TEXTURE_RECTANGLE, GL_TEXTURE_2D,
                                            GL_TEXTURE_1D};
    for (const GLenum target : targets)
        if (REAL(glIsEnabled)(target) != GL_FALSE) return target;
    return 0;
}

FixedFunction current_fixed_function() {
    FixedFunction fixed;
    for (const StateName& each : fixed_names) {
        std::array<double, 16> found{};
        REAL(glGetDoublev)(each.name, found.data());
        fixed.values.insert(fixed.values.end(), found.begin(),
                            found.begin() + static_cast<std::ptrdiff_t>(each.values));
    }
    for (GLuint i = 0; i < clip_planes; ++i) {
        std::array<double, clip_plane_values> plane{};
        REAL(glGetClipPlane)(GL_CLIP_PLANE0 + i, plane.data());
        fixed.values.insert(fixed.values.end(), plane.begin(), plane.end());
    }
    for (GLuint i = 0; i < lights; ++i) {
        const GLenum light = GL_LIGHT0 + i;
        std::vector<double>& values = fixed.lights.emplace_back();
        values.push_back(REAL(glIsEnabled)(light));
        append(values, light_names, [&](GLenum name, float* found) { REAL(glGetLightfv)(light, name, found); });
    }
    for (const GLenum face : {GLenum{GL_FRONT}, GLenum{GL_BACK}})
        append(fixed.materials.emplace_back(), material_names, [&](GLenum name, float* found) {
            REAL(glGetMaterialfv)(face, name, found);
        });
    const GLint active = integer(GL_ACTIVE_TEXTURE);
    for (std::uint32_t i = 0; i < texture_units; ++i) fixed.units.push_back(texture_unit(i));
    REAL(glActiveTexture)(static_cast<GLenum>(active));
    return fixed;
}

} // namespace record
