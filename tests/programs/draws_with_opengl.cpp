// A program that draws with OpenGL, to be recorded: one frame for each scenario that is named, of 64 x 48 pixels,
// without a window system. Ends with status 77 where there is no such OpenGL, and with 3 where what is its own was
// disturbed. With --pixels=FILE in front, the windows' RGBA bytes go there, frame by frame, rows from the bottom.
#include "opengl_scenarios.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

using scenarios::clear;
using scenarios::height;
using scenarios::linked;
using scenarios::width;

namespace {

constexpr int no_opengl = 77, disturbed = 3;

bool make_current(EGLDisplay& display, EGLSurface& surface) {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    const auto get_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (get_display == nullptr) return false;
    display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) return false;
    const std::array<EGLint, 15> wanted{EGL_SURFACE_TYPE,
                                        EGL_PBUFFER_BIT,
                                        EGL_RENDERABLE_TYPE,
                                        EGL_OPENGL_BIT,
                                        EGL_RED_SIZE,
                                        8,
                                        EGL_ALPHA_SIZE,
                                        8,
                                        EGL_DEPTH_SIZE,
                                        24,
                                        EGL_STENCIL_SIZE,
                                        8,
                                        EGL_CONFIG_CAVEAT,
                                        EGL_NONE,
                                        EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, wanted.data(), &config, 1, &count) == EGL_FALSE || count == 0) return false;
    const std::array<EGLint, 5> size{EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    surface = eglCreatePbufferSurface(display, config, size.data());
    eglBindAPI(EGL_OPENGL_API);
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
    return context != EGL_NO_CONTEXT && eglMakeCurrent(display, surface, surface, context) == EGL_TRUE;
}

GLuint shader(GLenum kind, const char* source) {
    const GLuint name = glCreateShader(kind);
    glShaderSource(name, 1, &source, nullptr);
    glCompileShader(name);
    return name;
}

} // namespace

GLuint scenarios::linked(const char* vertex, const char* fragment) {
    const GLuint program = glCreateProgram();
    glAttachShader(program, shader(GL_VERTEX_SHADER, vertex));
    glAttachShader(program, shader(GL_FRAGMENT_SHADER, fragment));
    glBindAttribLocation(program, 3, "place");
    glLinkProgram(program);
    return program;
}

void scenarios::clear() {
    glClearColor(0.25F, 0.5F, 0.75F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

namespace {

constexpr const char* coloured_vertex = R"(attribute vec2 place;
uniform mat2 turn;
varying vec4 shade;
void main() {
    gl_Position = vec4(turn * place, 0.0, 1.0);
    shade = vec4(place * 0.5 + 0.5, 0.25, 1.0);
}
)";
constexpr const char* coloured_fragment = R"(uniform vec4 tints[2];
uniform bool second;
varying vec4 shade;
void main() { gl_FragColor = shade * (second ? tints[1] : tints[0]); }
)";

const std::vector<float> square{-0.5F, -0.5F, 0.5F, -0.5F, 0.5F, 0.5F, -0.5F, 0.5F};

/// Its program's uniforms, and an array of places in a buffer behind 8 bytes of something else.
GLuint use_colours() {
    const GLuint program = linked(coloured_vertex, coloured_fragment);
    glUseProgram(program);
    const std::array<float, 4> turn{1.0F, 0.0F, 0.0F, -1.0F};
    glUniformMatrix2fv(glGetUniformLocation(program, "turn"), 1, GL_FALSE, turn.data());
    const std::array<float, 8> tints{1.0F, 2.0F, 3.0F, 4.0F, 0.5F, 0.25F, 0.125F, 1.0F};
    glUniform4fv(glGetUniformLocation(program, "tints"), 2, tints.data());
    glUniform1i(glGetUniformLocation(program, "second"), 1);
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(8 + 4 * square.size()), nullptr, GL_STATIC_DRAW);
    glBufferSubData(GL_ARRAY_BUFFER, 8, static_cast<GLsizeiptr>(4 * square.size()), square.data());
    glVertexAttribPointer(3, 2, GL_FLOAT, GL_FALSE, 8, reinterpret_cast<const void*>(std::size_t{8}));
    glEnableVertexAttribArray(3);
    return program;
}

void stop_using() {
    glDisableVertexAttribArray(3);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glUseProgram(0);
}

void arrays() {
    clear();
    use_colours();
    glDrawArrays(GL_TRIANGLES, 1, 3);
    stop_using();
}

void elements() {
    clear();
    use_colours();
    const std::array<GLushort, 6> indices{0, 1, 2, 0, 2, 3};
    glDrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_SHORT, indices.data());
    const std::array<GLubyte, 3> low{0, 1, 2};
    glDrawElementsBaseVertex(GL_TRIANGLES, 3, GL_UNSIGNED_BYTE, low.data(), 1);
    glEnable(GL_PRIMITIVE_RESTART);
    glPrimitiveRestartIndex(9);
    const std::array<GLushort, 7> strips{0, 1, 2, 9, 1, 2, 3};
    glDrawElements(GL_TRIANGLE_STRIP, 7, GL_UNSIGNED_SHORT, strips.data());
    glDisable(GL_PRIMITIVE_RESTART);
    stop_using();
}

void immediate() {
    clear();
    glColor3f(0.5F, 0.25F, 0.125F);
    glBegin(GL_QUADS);
    glTexCoord2f(0.25F, 0.75F);
    for (std::size_t i = 0; i < square.size(); i += 2) {
        if (i == 4) glColor4ub(255, 0, 51, 255);
        glVertex2f(square[i], square[i + 1]);
    }
    glEnd();
}

/// Two triangles between which the state changes, in a list that another one calls.
void lists() {
    clear();
    glNewList(7, GL_COMPILE);
    glColor3f(1.0F, 0.0F, 0.0F);
    glBegin(GL_TRIANGLES);
    for (std::size_t i = 0; i < 6; i += 2) glVertex2f(square[i], square[i + 1]);
    glEnd();
    glEnable(GL_CULL_FACE);
    glBegin(GL_TRIANGLES);
    for (std::size_t i = 2; i < 8; i += 2) glVertex2f(square[i], square[i + 1]);
    glEnd();
    glEndList();
    glNewList(8, GL_COMPILE);
    glCallList(7);
    glDisable(GL_CULL_FACE);
    glEndList();
    glCallList(8);
}

/// Two lists by names that the driver gives, each with a colour of its own and two pieces.
void named_lists() {
    clear();
    std::array<GLuint, 2> names{};
    for (std::size_t list = 0; list < names.size(); ++list) {
        names[list] = glGenLists(1);
        glNewList(names[list], GL_COMPILE);
        glColor3f(list == 0 ? 1.0F : 0.0F, list == 1 ? 1.0F : 0.0F, 0.0F);
        for (std::size_t piece = 0; piece < 2; ++piece) {
            glBegin(GL_TRIANGLES);
            for (std::size_t i = 2 * piece; i < 2 * piece + 6; i += 2) glVertex2f(square[i], square[i + 1]);
            glEnd();
        }
        glEndList();
    }
    for (const GLuint name : names) glCallList(name);
}

void texture() {
    clear();
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    const std::array<GLubyte, 8> texels{10, 20, 30, 40, 50, 60, 70, 80}; // luminance and alpha
    glTexImage2D(GL_TEXTURE_2D, 0, GL_LUMINANCE_ALPHA, 2, 2, 0, GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, texels.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_TRIANGLES);
    for (std::size_t i = 0; i < 6; i += 2) {
        glTexCoord2f(square[i] + 0.5F, square[i + 1] + 0.5F);
        glVertex2f(square[i], square[i + 1]);
    }
    glEnd();
    glDisable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, 0);
}

/// Draws into a texture, copies a part of the window into it, and draws with it.
void targets() {
    clear();
    GLuint name = 0, framebuffer = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 16, 8, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name, 0);
    glViewport(0, 0, 16, 8);
    immediate();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 2, 1, 5, 6, 4, 3);
    texture();
    glBindTexture(GL_TEXTURE_2D, name);
    glEnable(GL_TEXTURE_2D);
    immediate();
    glDisable(GL_TEXTURE_2D);
}

void states() {
    glEnable(GL_SCISSOR_TEST);
    glScissor(4, 8, 16, 12);
    glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE);
    clear();
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_FALSE);
    glEnable(GL_STENCIL_TEST);
    glStencilFuncSeparate(GL_BACK, GL_LESS, 5, 0x0F);
    glStencilOpSeparate(GL_FRONT, GL_INCR, GL_ZERO, GL_REPLACE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1.0F, -2.0F);
    glFrontFace(GL_CW);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    glViewport(1, 2, 30, 20);
    immediate();
}

/// What cannot be recorded.
void unrecorded() {
    clear();
    glRectf(-1.0F, -1.0F, 0.0F, 0.0F);
    glRectf(-1.0F, -1.0F, 0.0F, 0.0F);
}

/// State that the recorder changes for its questions, and an error of the program's own.
bool is_undisturbed() {
    glPixelStorei(GL_PACK_ROW_LENGTH, 77);
    glActiveTexture(GL_TEXTURE2);
    glClientActiveTexture(GL_TEXTURE1);
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
    glEnable(0xFFFF);
    immediate();
    use_colours();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    stop_using();
    if (glGetError() != GL_INVALID_ENUM || glGetError() != GL_NO_ERROR) return false;
    const auto is = [](GLenum name, GLint expected) {
        GLint value = 0;
        glGetIntegerv(name, &value);
        if (value != expected) std::fprintf(stderr, "state 0x%x: %d instead of %d\n", name, value, expected);
        return value == expected;
    };
    return is(GL_PACK_ROW_LENGTH, 77) && is(GL_ACTIVE_TEXTURE, GL_TEXTURE2) &&
           is(GL_CLIENT_ACTIVE_TEXTURE, GL_TEXTURE1) && is(GL_PIXEL_PACK_BUFFER_BINDING, static_cast<GLint>(buffer)) &&
           is(GL_PACK_ALIGNMENT, 4);
}

/// At once: the program may end in the swap that follows.
void write_pixels(std::FILE* file) {
    std::vector<unsigned char> bytes(static_cast<std::size_t>(width) * height * 4);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    std::fwrite(bytes.data(), 1, bytes.size(), file);
    std::fflush(file);
}

} // namespace

int main(int count, char** arguments) {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLSurface surface = EGL_NO_SURFACE;
    if (!make_current(display, surface)) return no_opengl;
    std::map<std::string, void (*)()> all{
        {"arrays", arrays},   {"elements", elements},       {"immediate", immediate},
        {"lists", lists},     {"named_lists", named_lists}, {"texture", texture},
        {"targets", targets}, {"states", states},           {"unrecorded", unrecorded},
    };
    all.merge(scenarios::of_states());
    constexpr const char* option = "--pixels=";
    std::FILE* pixels = nullptr;
    bool good = true;
    for (int i = 1; i < count; ++i) {
        if (std::strncmp(arguments[i], option, std::strlen(option)) == 0) {
            pixels = std::fopen(arguments[i] + std::strlen(option), "wb");
            continue;
        }
        if (std::strcmp(arguments[i], "undisturbed") == 0) {
            good = is_undisturbed();
        } else {
            glPushAttrib(GL_ALL_ATTRIB_BITS);
            all.at(arguments[i])();
            glPopAttrib();
        }
        if (!good) return disturbed;
        if (pixels != nullptr) write_pixels(pixels);
        eglSwapBuffers(display, surface);
    }
    return 0;
}
