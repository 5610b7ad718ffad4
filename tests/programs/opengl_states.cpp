// State whose effect is in the pixels: alpha tests, depth ranges, interpolation, levels and faces that are drawn to,
// blits.
#include "opengl_scenarios.hpp"

namespace scenarios {

namespace {

using Colour = std::array<float, 4>;
constexpr Colour red{1.0F, 0.0F, 0.0F, 1.0F}, green{0.0F, 1.0F, 0.0F, 1.0F}, blue{0.0F, 0.0F, 1.0F, 1.0F},
    yellow{1.0F, 1.0F, 0.0F, 1.0F};

void triangle(float left, float bottom, float z, const Colour& colour) {
    glColor4fv(colour.data());
    glBegin(GL_TRIANGLES);
    glVertex3f(left, bottom, z);
    glVertex3f(left + 1.0F, bottom, z);
    glVertex3f(left, bottom + 1.0F, z);
    glEnd();
}

constexpr const char* fading_vertex = R"(attribute vec2 place;
varying vec4 shade;
void main() {
    gl_Position = vec4(place, 0.0, 1.0);
    shade = vec4(place * 0.5 + 0.5, 0.25, 1.0);
}
)";
constexpr const char* fading_fragment = R"(varying vec4 shade;
void main() { gl_FragColor = vec4(shade.gbr, shade.r); }
)";

/// References and alphas between the steps of the window: what is drawn depends on their rounding.
void alpha_tests() {
    clear();
    glUseProgram(linked(fading_vertex, fading_fragment));
    const std::array<float, 8> corners{-0.5F, -0.5F, 0.5F, -0.5F, 0.5F, 0.5F, -0.5F, 0.5F};
    glVertexAttribPointer(3, 2, GL_FLOAT, GL_FALSE, 0, corners.data());
    glEnableVertexAttribArray(3);
    glEnable(GL_ALPHA_TEST);
    // Alpha in steps is 63.75 + 3.984 (i + 0.5) in column i: 97.6 in column 8, 153.4 in column 22.
    glAlphaFunc(GL_EQUAL, 98.0F / 255.0F);
    glDrawArrays(GL_TRIANGLE_FAN, 0, 4);
    glAlphaFunc(GL_GREATER, 153.0F / 255.0F);
    glDrawArrays(GL_TRIANGLE_FAN, 0, 4);
    glDisableVertexAttribArray(3);
    glUseProgram(0);
    glAlphaFunc(GL_EQUAL, 99.6F / 255.0F);
    triangle(-1.0F, 0.0F, 0.0F, {1.0F, 0.0F, 0.0F, 100.4F / 255.0F});
    triangle(0.0F, 0.0F, 0.0F, {1.0F, 0.0F, 0.0F, 101.4F / 255.0F}); // is not drawn
    glAlphaFunc(GL_GEQUAL, 1.5F);
    triangle(0.0F, -1.0F, 0.0F, green);
}

void depth_ranges() {
    clear();
    glEnable(GL_DEPTH_TEST);
    glDepthRange(0.0, 0.5);
    triangle(-0.75F, -0.75F, 0.8F, red); // 0.45
    glDepthRange(0.0, 1.0);
    triangle(-0.5F, -0.5F, 0.0F, green);
    glDepthRange(1.0, 0.0);
    triangle(-0.25F, -0.75F, 0.5F, blue); // 0.25
    glEnable(GL_DEPTH_CLAMP);
    glDepthRange(0.2, 0.3);
    triangle(-0.75F, -0.25F, 5.0F, yellow); // 0.3
}

constexpr const char* tilted_vertex = R"(#version 130
in vec2 place;
noperspective out vec4 linear;
smooth out vec4 shade;
void main() {
    float w = 1.5 + place.x;
    gl_Position = vec4(place * w, 0.0, w);
    linear = shade = vec4(place * 0.5 + 0.5, 0.25, 1.0);
}
)";
constexpr const char* tilted_fragment = R"(#version 130
noperspective in vec4 linear;
smooth in vec4 shade;
void main() { gl_FragColor = vec4(linear.x, shade.x, linear.y, 1.0); }
)";

void interpolations() {
    clear();
    glUseProgram(linked(tilted_vertex, tilted_fragment));
    const std::array<float, 8> corners{-0.9F, -0.8F, 0.7F, -0.9F, 0.9F, 0.8F, -0.8F, 0.9F};
    glVertexAttribPointer(3, 2, GL_FLOAT, GL_FALSE, 0, corners.data());
    glEnableVertexAttribArray(3);
    glDrawArrays(GL_TRIANGLE_FAN, 0, 4);
    glDisableVertexAttribArray(3);
    glUseProgram(0);
}

GLuint framebuffer_of(GLenum target, GLuint texture, GLint level) {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, target, texture, level);
    return framebuffer;
}

void draw_part(GLenum target, GLuint texture, GLint level, GLsizei side, const Colour& colour) {
    framebuffer_of(target, texture, level);
    glViewport(0, 0, side, side);
    clear();
    triangle(-0.75F, -0.75F, 0.0F, colour);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
}

/// A quarter of the window, with texture coordinates from 0 to 1, or for a cube those of a face.
void quarter(float left, float bottom, void (*coordinates)(float s, float t)) {
    constexpr std::array<std::array<float, 2>, 4> corners{{{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}}};
    glBegin(GL_QUADS);
    for (const auto& [s, t] : corners) {
        coordinates(s, t);
        glVertex2f(left + s, bottom + t);
    }
    glEnd();
}

GLuint empty_texture() {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    for (GLint level = 0; level < 5; ++level)
        glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, 16 >> level, 16 >> level, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    return texture;
}

GLuint empty_cube() {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_CUBE_MAP, texture);
    for (GLenum face = 0; face < 6; ++face)
        glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, GL_RGBA8, 8, 8, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

/// Draws to two levels and two faces, then with each.
void parts() {
    const GLuint flat = empty_texture(), cube = empty_cube();
    draw_part(GL_TEXTURE_2D, flat, 0, 16, red);
    draw_part(GL_TEXTURE_2D, flat, 1, 8, green);
    draw_part(GL_TEXTURE_CUBE_MAP_POSITIVE_Z, cube, 0, 8, blue);
    draw_part(GL_TEXTURE_CUBE_MAP_NEGATIVE_X, cube, 0, 8, yellow);
    clear();
    glColor4f(1.0F, 1.0F, 1.0F, 1.0F);
    glEnable(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    const auto flat_place = [](float s, float t) { glTexCoord2f(s, t); };
    quarter(-1.0F, 0.0F, flat_place);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 1);
    quarter(0.0F, 0.0F, flat_place);
    glDisable(GL_TEXTURE_2D);
    glEnable(GL_TEXTURE_CUBE_MAP);
    quarter(-1.0F, -1.0F, [](float s, float t) { glTexCoord3f(s - 0.5F, t - 0.5F, 0.6F); });
    quarter(0.0F, -1.0F, [](float s, float t) { glTexCoord3f(-0.6F, s - 0.5F, t - 0.5F); });
    glDisable(GL_TEXTURE_CUBE_MAP);
}

/// Scaled, turned, filtered, cut, and beyond the window's edge.
void blits() {
    const GLuint framebuffer = framebuffer_of(GL_TEXTURE_2D, empty_texture(), 0);
    glViewport(0, 0, 16, 16);
    clear();
    triangle(-0.75F, -0.75F, 0.0F, red);
    triangle(-0.25F, -0.25F, 0.0F, green);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    clear();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    // No centre of a pixel comes to lie between two texels, where drivers may take either.
    glBlitFramebuffer(0, 0, 16, 16, 2, 3, 34, 35, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBlitFramebuffer(0, 0, 16, 16, 70, 44, 38, 12, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glEnable(GL_SCISSOR_TEST);
    glScissor(4, 26, 20, 20);
    glBlitFramebuffer(2, 1, 14, 7, 0, 24, 42, 48, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

} // namespace

std::map<std::string, void (*)()> of_states() {
    return {{"alpha_tests", alpha_tests},
            {"depth_ranges", depth_ranges},
            {"interpolations", interpolations},
            {"parts", parts},
            {"blits", blits}};
}

} // namespace scenarios
