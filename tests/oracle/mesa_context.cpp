#include "tests/oracle/mesa_context.hpp"

#if ROPSIM_HAVE_EGL

#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <stdexcept>

namespace tests {

namespace {

GLuint compiled(GLenum kind, const std::string& source) {
    const GLuint shader = glCreateShader(kind);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good != 0) return shader;
    std::array<char, 1000> log{};
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(fmt::format("llvmpipe: {}\n{}", log.data(), source));
}

} // namespace

std::optional<MesaContext> create_mesa_context(MesaProfile profile, std::string& reason) {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    const auto get_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    MesaContext result;
    if (get_display != nullptr)
        result.display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (result.display == EGL_NO_DISPLAY || eglInitialize(result.display, nullptr, nullptr) == EGL_FALSE) {
        reason = "EGL finds no surfaceless Mesa display";
        return std::nullopt;
    }
    eglBindAPI(EGL_OPENGL_API);
    const bool core = profile == MesaProfile::core;
    const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                           4,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           5,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           core ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT
                                                : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT,
                                           EGL_NONE};
    result.context = eglCreateContext(result.display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (result.context == EGL_NO_CONTEXT) {
        reason = fmt::format("EGL gives no OpenGL 4.5 context of the {} profile", core ? "core" : "compatibility");
        return std::nullopt;
    }
    return result;
}

CurrentMesaContext::CurrentMesaContext(const MesaContext& context)
    : before_{eglGetCurrentDisplay(), eglGetCurrentContext()} {
    eglMakeCurrent(context.display, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context);
    if (before_.display == EGL_NO_DISPLAY) before_.display = context.display;
}

CurrentMesaContext::~CurrentMesaContext() {
    eglMakeCurrent(before_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, before_.context);
}

unsigned link_program(const std::string& vertex, const std::string& fragment, const std::vector<std::string>& inputs) {
    const GLuint program = glCreateProgram();
    for (const GLuint shader : {compiled(GL_VERTEX_SHADER, vertex), compiled(GL_FRAGMENT_SHADER, fragment)}) {
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    for (GLuint i = 0; i < inputs.size(); ++i) glBindAttribLocation(program, i, inputs[i].c_str());
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good != 0) return program;
    std::array<char, 1000> log{};
    glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(fmt::format("llvmpipe: {}\n{}\n{}", log.data(), vertex, fragment));
}

} // namespace tests

#endif
