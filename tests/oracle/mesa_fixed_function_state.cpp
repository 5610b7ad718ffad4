#include "tests/oracle/mesa_fixed_function_state.hpp"

#if ROPSIM_HAVE_EGL

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <array>
#include <glm/gtc/type_ptr.hpp>

namespace tests {

namespace {

using namespace traces;

void enable(GLenum what, bool on) { on ? glEnable(what) : glDisable(what); }

void set_lighting(const FixedLighting& lighting) {
    enable(GL_LIGHTING, lighting.enabled);
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, glm::value_ptr(lighting.ambient));
    glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, lighting.local_viewer ? 1 : 0);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, lighting.two_sided ? 1 : 0);
    glLightModeli(GL_LIGHT_MODEL_COLOR_CONTROL,
                  lighting.separate_specular ? GL_SEPARATE_SPECULAR_COLOR : GL_SINGLE_COLOR);
    for (std::uint32_t i = 0; i < fixed_function_lights; ++i) {
        const FixedLight& from = lighting.lights[i];
        const GLenum light = GL_LIGHT0 + i;
        enable(light, from.enabled);
        glLightfv(light, GL_AMBIENT, glm::value_ptr(from.ambient));
        glLightfv(light, GL_DIFFUSE, glm::value_ptr(from.diffuse));
        glLightfv(light, GL_SPECULAR, glm::value_ptr(from.specular));
        glLightfv(light, GL_POSITION, glm::value_ptr(from.position));
        glLightfv(light, GL_SPOT_DIRECTION, glm::value_ptr(from.spot_direction));
        glLightf(light, GL_SPOT_EXPONENT, from.spot_exponent);
        glLightf(light, GL_SPOT_CUTOFF, from.spot_cutoff);
        glLightf(light, GL_CONSTANT_ATTENUATION, from.attenuation.x);
        glLightf(light, GL_LINEAR_ATTENUATION, from.attenuation.y);
        glLightf(light, GL_QUADRATIC_ATTENUATION, from.attenuation.z);
    }
    for (const bool front : {true, false}) {
        const FixedMaterial& from = lighting.materials[front ? 0 : 1];
        const GLenum face = front ? GL_FRONT : GL_BACK;
        glMaterialfv(face, GL_AMBIENT, glm::value_ptr(from.ambient));
        glMaterialfv(face, GL_DIFFUSE, glm::value_ptr(from.diffuse));
        glMaterialfv(face, GL_SPECULAR, glm::value_ptr(from.specular));
        glMaterialfv(face, GL_EMISSION, glm::value_ptr(from.emission));
        glMaterialf(face, GL_SHININESS, from.shininess);
    }
    const auto [front, back] = lighting.colour_material;
    const ColourMaterial tracked = front == ColourMaterial::none ? back : front;
    if (tracked == ColourMaterial::none) return;
    constexpr std::array<GLenum, 6> modes{GL_NONE,    GL_EMISSION, GL_AMBIENT,
                                          GL_DIFFUSE, GL_SPECULAR, GL_AMBIENT_AND_DIFFUSE};
    glColorMaterial(front == back                   ? GL_FRONT_AND_BACK
                    : front == ColourMaterial::none ? GL_BACK
                                                    : GL_FRONT,
                    modes.at(static_cast<std::size_t>(tracked)));
    glEnable(GL_COLOR_MATERIAL);
}

void set_combiner(const Combiner& from, bool alpha) {
    constexpr std::array<GLint, 8> functions{GL_REPLACE,     GL_MODULATE, GL_ADD,      GL_ADD_SIGNED,
                                             GL_INTERPOLATE, GL_SUBTRACT, GL_DOT3_RGB, GL_DOT3_RGBA};
    constexpr std::array<GLint, 5> sources{GL_TEXTURE, 0, GL_CONSTANT, GL_PRIMARY_COLOR, GL_PREVIOUS};
    constexpr std::array<GLint, 4> operands{GL_SRC_COLOR, GL_ONE_MINUS_SRC_COLOR, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA};
    constexpr std::array<GLint, 4> of_alpha{GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA};
    glTexEnvi(GL_TEXTURE_ENV, alpha ? GL_COMBINE_ALPHA : GL_COMBINE_RGB,
              functions.at(static_cast<std::size_t>(from.function)));
    glTexEnvi(GL_TEXTURE_ENV, alpha ? GL_ALPHA_SCALE : GL_RGB_SCALE, from.scale);
    for (std::uint32_t i = 0; i < 3; ++i) {
        const CombineArgument& argument = from.arguments[i];
        const GLint source = argument.source == CombineSource::texture_of_unit
                                 ? static_cast<GLint>(GL_TEXTURE0) + argument.unit
                                 : sources.at(static_cast<std::size_t>(argument.source));
        glTexEnvi(GL_TEXTURE_ENV, (alpha ? GL_SOURCE0_ALPHA : GL_SOURCE0_RGB) + i, source);
        glTexEnvi(GL_TEXTURE_ENV, (alpha ? GL_OPERAND0_ALPHA : GL_OPERAND0_RGB) + i,
                  (alpha ? of_alpha : operands).at(static_cast<std::size_t>(argument.operand)));
    }
}

void set_unit(const FixedTextureUnit& from) {
    if (from.target == UnitTarget::none) return;
    constexpr std::array<GLint, 6> environments{GL_MODULATE, GL_REPLACE, GL_DECAL, GL_BLEND, GL_ADD, GL_COMBINE};
    constexpr std::array<GLint, 6> generations{
        0, GL_OBJECT_LINEAR, GL_EYE_LINEAR, GL_SPHERE_MAP, GL_REFLECTION_MAP, GL_NORMAL_MAP};
    glEnable(texture_target(from.target));
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, environments.at(static_cast<std::size_t>(from.environment)));
    glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, glm::value_ptr(from.constant));
    set_combiner(from.colour, false);
    set_combiner(from.alpha, true);
    glTexEnvi(GL_POINT_SPRITE, GL_COORD_REPLACE, from.replaced_in_sprites ? 1 : 0);
    for (std::uint32_t i = 0; i < 4; ++i) {
        enable(GL_TEXTURE_GEN_S + i, from.generation[i] != CoordinateGeneration::none);
        if (from.generation[i] == CoordinateGeneration::none) continue;
        glTexGeni(GL_S + i, GL_TEXTURE_GEN_MODE, generations.at(static_cast<std::size_t>(from.generation[i])));
        glTexGenfv(GL_S + i, GL_OBJECT_PLANE, glm::value_ptr(from.object_planes[i]));
        glTexGenfv(GL_S + i, GL_EYE_PLANE, glm::value_ptr(from.eye_planes[i]));
    }
    glMatrixMode(GL_TEXTURE);
    glLoadMatrixf(glm::value_ptr(from.matrix));
}

void set_fog(const FixedFog& fog) {
    if (fog.mode == FogMode::none) return;
    constexpr std::array<GLint, 4> modes{0, GL_LINEAR, GL_EXP, GL_EXP2};
    glEnable(GL_FOG);
    glFogi(GL_FOG_MODE, modes.at(static_cast<std::size_t>(fog.mode)));
    glFogi(GL_FOG_COORDINATE_SOURCE, fog.from_vertex ? GL_FOG_COORDINATE : GL_FRAGMENT_DEPTH);
    glFogfv(GL_FOG_COLOR, glm::value_ptr(fog.colour));
    glFogf(GL_FOG_DENSITY, fog.density);
    glFogf(GL_FOG_START, fog.start);
    glFogf(GL_FOG_END, fog.end);
}

} // namespace

std::uint32_t texture_target(UnitTarget target) {
    constexpr std::array<GLenum, 6> targets{GL_NONE,       GL_TEXTURE_1D,      GL_TEXTURE_2D, GL_TEXTURE_RECTANGLE,
                                            GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP};
    return targets.at(static_cast<std::size_t>(target));
}

void set_around_shaders(const FixedFunctionState& state) {
    for (std::uint32_t i = 0; i < pipeline::most_clip_distances; ++i)
        enable(GL_CLIP_PLANE0 + i, (state.clip_planes >> i & 1U) != 0);
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, state.clamp_fragment_colours ? GL_TRUE : GL_FALSE);
    const FixedPoints& points = state.points;
    glPointSize(points.size);
    glPointParameterf(GL_POINT_SIZE_MIN, points.least);
    glPointParameterf(GL_POINT_SIZE_MAX, points.most);
    glPointParameterfv(GL_POINT_DISTANCE_ATTENUATION, glm::value_ptr(points.attenuation));
    enable(GL_POINT_SPRITE, points.sprites);
}

// Eye space is that of the identity while lights and planes are set.
void set_fixed_function(const FixedFunctionState& state) {
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    for (std::uint32_t i = 0; i < pipeline::most_clip_distances; ++i) {
        const glm::dvec4 plane(state.clip_plane[i]);
        glClipPlane(GL_CLIP_PLANE0 + i, glm::value_ptr(plane));
    }
    set_lighting(state.lighting);
    for (std::uint32_t unit = 0; unit < fixed_function_units; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glMatrixMode(GL_MODELVIEW);
        set_unit(state.units[unit]);
    }
    glMatrixMode(GL_PROJECTION);
    glLoadMatrixf(glm::value_ptr(state.projection));
    glMatrixMode(GL_MODELVIEW);
    glLoadMatrixf(glm::value_ptr(state.model_view));
    enable(GL_NORMALIZE, state.normalize);
    enable(GL_RESCALE_NORMAL, state.rescale_normal);
    enable(GL_COLOR_SUM, state.colour_sum);
    glShadeModel(state.flat ? GL_FLAT : GL_SMOOTH);
    glClampColor(GL_CLAMP_VERTEX_COLOR, state.clamp_vertex_colours ? GL_TRUE : GL_FALSE);
    set_fog(state.fog);
    set_around_shaders(state);
    enable(GL_ALPHA_TEST, state.alpha_test != pipeline::Compare::always);
    glAlphaFunc(GL_NEVER + static_cast<GLenum>(state.alpha_test), state.alpha_reference);
}

} // namespace tests

#endif
