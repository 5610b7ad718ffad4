// Calls that change what is drawn and that a recording cannot have: they are counted, by name, and done by the driver.
#include "traces/record_module/context.hpp"
#include "traces/record_module/immediate.hpp"
#include "traces/record_module/recorder.hpp"
#include "traces/record_module/surfaces.hpp"

namespace {

void note_unrecorded(const char* call) {
    const record::Lock lock;
    record::recorder().count(call);
    // Between glBegin and glEnd nothing can be asked for.
    if (!record::recorder().wanted() || record::inside_primitives() || !record::current_context().usable) return;
    const record::Quiet quiet;
    record::draw_targets_changed();
}

} // namespace

// NOLINTBEGIN(bugprone-macro-parentheses): arguments come with theirs
#define COUNTED(result, function, parameters, arguments)                                                               \
    EXPORTED result function parameters {                                                                              \
        note_unrecorded(#function);                                                                                    \
        return REAL(function) arguments;                                                                               \
    }
// NOLINTEND(bugprone-macro-parentheses)

#define UNRECORDED(X)                                                                                                  \
    X(void, glDrawPixels, (GLsizei width, GLsizei height, GLenum format, GLenum type, const void* data),               \
      (width, height, format, type, data))                                                                             \
    X(void, glBitmap,                                                                                                  \
      (GLsizei width, GLsizei height, GLfloat x, GLfloat y, GLfloat dx, GLfloat dy, const GLubyte* bits),              \
      (width, height, x, y, dx, dy, bits))                                                                             \
    X(void, glCopyPixels, (GLint x, GLint y, GLsizei width, GLsizei height, GLenum type), (x, y, width, height, type)) \
    X(void, glAccum, (GLenum operation, GLfloat value), (operation, value))                                            \
    X(void, glRectd, (GLdouble x1, GLdouble y1, GLdouble x2, GLdouble y2), (x1, y1, x2, y2))                           \
    X(void, glRectf, (GLfloat x1, GLfloat y1, GLfloat x2, GLfloat y2), (x1, y1, x2, y2))                               \
    X(void, glRecti, (GLint x1, GLint y1, GLint x2, GLint y2), (x1, y1, x2, y2))                                       \
    X(void, glRects, (GLshort x1, GLshort y1, GLshort x2, GLshort y2), (x1, y1, x2, y2))                               \
    X(void, glArrayElement, (GLint i), (i))                                                                            \
    X(void, glEvalCoord1f, (GLfloat u), (u))                                                                           \
    X(void, glEvalCoord2f, (GLfloat u, GLfloat v), (u, v))                                                             \
    X(void, glEvalMesh1, (GLenum mode, GLint first, GLint last), (mode, first, last))                                  \
    X(void, glEvalMesh2, (GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2), (mode, i1, i2, j1, j2))                \
    X(void, glVertexP2ui, (GLenum type, GLuint value), (type, value))                                                  \
    X(void, glVertexP3ui, (GLenum type, GLuint value), (type, value))                                                  \
    X(void, glVertexP4ui, (GLenum type, GLuint value), (type, value))                                                  \
    X(void, glDrawTransformFeedback, (GLenum mode, GLuint id), (mode, id))                                             \
    X(void, glDrawTransformFeedbackInstanced, (GLenum mode, GLuint id, GLsizei instances), (mode, id, instances))      \
    X(void, glDrawTransformFeedbackStream, (GLenum mode, GLuint id, GLuint stream), (mode, id, stream))                \
    X(void, glMultiDrawArraysIndirectCount,                                                                            \
      (GLenum mode, const void* indirect, GLintptr count, GLsizei most, GLsizei stride),                               \
      (mode, indirect, count, most, stride))                                                                           \
    X(void, glMultiDrawElementsIndirectCount,                                                                          \
      (GLenum mode, GLenum type, const void* indirect, GLintptr count, GLsizei most, GLsizei stride),                  \
      (mode, type, indirect, count, most, stride))                                                                     \
    X(void, glDispatchCompute, (GLuint x, GLuint y, GLuint z), (x, y, z))                                              \
    X(void, glDispatchComputeIndirect, (GLintptr indirect), (indirect))                                                \
    X(void, glBeginConditionalRender, (GLuint id, GLenum mode), (id, mode))                                            \
    X(void, glClearNamedFramebufferuiv, (GLuint framebuffer, GLenum buffer, GLint drawbuffer, const GLuint* value),    \
      (framebuffer, buffer, drawbuffer, value))

UNRECORDED(COUNTED)

#define ROW(result, function, parameters, arguments) HOOK(function),

std::span<const record::Hook> record::unrecorded_hooks() {
    static const std::array hooks{UNRECORDED(ROW)};
    return hooks;
}
