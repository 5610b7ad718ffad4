// Programs, which are to give their positions away; samplers, which are to have one probe; where frames end.
#include "tests/replay_oracle/measure_mesa/measurement.hpp"
#include "tests/replay_oracle/measure_mesa/positions.hpp"
#include "traces/record_module/context.hpp"

#include <array>

namespace {

template <class Value>
Value anisotropy_of(GLenum name, Value value) {
    return name == GL_TEXTURE_MAX_ANISOTROPY_EXT && measure::measurement().isotropic() ? Value{1} : value;
}

template <class Value>
const Value* anisotropy_at(GLenum name, const Value* values) {
    static constexpr Value one{1};
    return name == GL_TEXTURE_MAX_ANISOTROPY_EXT && measure::measurement().isotropic() ? &one : values;
}

} // namespace

EXPORTED void glLinkProgram(GLuint program) { measure::link_with_positions(program); }
EXPORTED void glLinkProgramARB(GLhandleARB program) { // Mesa's handles are names
    measure::link_with_positions(static_cast<GLuint>(program));
}
EXPORTED void glTransformFeedbackVaryings(GLuint program, GLsizei count, const GLchar* const* names, GLenum mode) {
    measure::captures_its_own(program);
    REAL(glTransformFeedbackVaryings)(program, count, names, mode);
}
ALSO_NAMED(glTransformFeedbackVaryingsEXT, glTransformFeedbackVaryings);

#define PARAMETER(function, kind, type)                                                                                \
    EXPORTED void function(kind object, GLenum name, type value) {                                                     \
        REAL(function)(object, name, anisotropy_of(name, value));                                                      \
    }
#define PARAMETERS(function, kind, type)                                                                               \
    EXPORTED void function(kind object, GLenum name, const type* values) {                                             \
        REAL(function)(object, name, anisotropy_at(name, values));                                                     \
    }
PARAMETER(glTexParameteri, GLenum, GLint)
PARAMETER(glTexParameterf, GLenum, GLfloat)
PARAMETERS(glTexParameteriv, GLenum, GLint)
PARAMETERS(glTexParameterfv, GLenum, GLfloat)
PARAMETER(glTextureParameteri, GLuint, GLint)
PARAMETER(glTextureParameterf, GLuint, GLfloat)
PARAMETERS(glTextureParameteriv, GLuint, GLint)
PARAMETERS(glTextureParameterfv, GLuint, GLfloat)
PARAMETER(glSamplerParameteri, GLuint, GLint)
PARAMETER(glSamplerParameterf, GLuint, GLfloat)
PARAMETERS(glSamplerParameteriv, GLuint, GLint)
PARAMETERS(glSamplerParameterfv, GLuint, GLfloat)
#undef PARAMETER
#undef PARAMETERS

EXPORTED void glXSwapBuffers(void* display, unsigned long drawable) {
    measure::measurement().end_frame();
    record::forget_drawable_sizes();
    REAL(glXSwapBuffers)(display, drawable);
}
EXPORTED void glXDestroyContext(void* display, void* context) {
    record::forget_context(context);
    REAL(glXDestroyContext)(display, context);
}

std::span<const record::Hook> record::program_hooks() {
    static const std::array hooks{HOOK(glLinkProgram), HOOK(glLinkProgramARB), HOOK(glTransformFeedbackVaryings),
                                  HOOK(glTransformFeedbackVaryingsEXT)};
    return hooks;
}
std::span<const record::Hook> record::upload_hooks() {
    static const std::array hooks{HOOK(glTexParameteri),      HOOK(glTexParameterf),      HOOK(glTexParameteriv),
                                  HOOK(glTexParameterfv),     HOOK(glTextureParameteri),  HOOK(glTextureParameterf),
                                  HOOK(glTextureParameteriv), HOOK(glTextureParameterfv), HOOK(glSamplerParameteri),
                                  HOOK(glSamplerParameterf),  HOOK(glSamplerParameteriv), HOOK(glSamplerParameterfv)};
    return hooks;
}
std::span<const record::Hook> record::window_hooks() {
    static const std::array hooks{HOOK(glXSwapBuffers), HOOK(glXDestroyContext)};
    return hooks;
}
std::span<const record::Hook> record::surface_hooks() { return {}; }
std::span<const record::Hook> record::unrecorded_hooks() { return {}; }
