#include "tests/replay_oracle/measure_mesa/positions.hpp"

#include "traces/record_module/context.hpp"

#include <array>
#include <map>
#include <set>
#include <string_view>

namespace measure {

namespace {

constexpr const char* position = "gl_Position";

std::set<GLuint>& capturing_programs() {
    static auto* const all = new std::set<GLuint>;
    return *all;
}

bool gives_positions(GLuint program) {
    GLint captured = 0;
    REAL(glGetProgramiv)(program, GL_TRANSFORM_FEEDBACK_VARYINGS, &captured);
    if (captured != 1) return false;
    std::array<char, 64> name{};
    GLsizei length = 0, size = 0;
    GLenum type = 0;
    REAL(glGetTransformFeedbackVarying)
    (program, 0, static_cast<GLsizei>(name.size()), &length, &size, &type, name.data());
    return std::string_view(name.data()) == position;
}

/// Transforms vertices as there being no program does; 0: it cannot be had.
GLuint fixed_function_program() {
    static auto* const of_contexts = new std::map<std::uint64_t, GLuint>;
    const auto [place, is_new] = of_contexts->try_emplace(record::current_context().number, 0);
    if (!is_new) return place->second;
    const char* const text = "#version 120\nvoid main() { gl_Position = ftransform(); }\n";
    const GLuint shader = REAL(glCreateShader)(GL_VERTEX_SHADER);
    REAL(glShaderSource)(shader, 1, &text, nullptr);
    REAL(glCompileShader)(shader);
    const GLuint program = REAL(glCreateProgram)();
    REAL(glAttachShader)(program, shader);
    REAL(glTransformFeedbackVaryings)(program, 1, &position, GL_INTERLEAVED_ATTRIBS);
    REAL(glLinkProgram)(program);
    GLint linked = GL_FALSE;
    REAL(glGetProgramiv)(program, GL_LINK_STATUS, &linked);
    return place->second = linked == GL_FALSE ? 0 : program;
}

/// A program that gives its positions away, in use: that of the draw, or one in place of fixed functions.
class CapturingProgram {
  public:
    CapturingProgram() : own_(static_cast<GLuint>(record::integer(GL_CURRENT_PROGRAM))) {
        if (own_ != 0) {
            ready_ = gives_positions(own_);
            return;
        }
        if (!record::current_context().compatibility || record::integer(GL_PROGRAM_PIPELINE_BINDING) != 0 ||
            REAL(glIsEnabled)(GL_VERTEX_PROGRAM_ARB) != GL_FALSE)
            return;
        const GLuint program = fixed_function_program();
        ready_ = program != 0;
        if (ready_) REAL(glUseProgram)(program);
    }
    ~CapturingProgram() {
        if (own_ == 0 && ready_) REAL(glUseProgram)(0);
    }
    CapturingProgram(const CapturingProgram&) = delete;
    CapturingProgram& operator=(const CapturingProgram&) = delete;

    bool ready() const { return ready_; }

  private:
    GLuint own_;
    bool ready_ = false;
};

/// A buffer that positions go to; what was bound for others is bound again behind it.
class FeedbackBuffer {
  public:
    explicit FeedbackBuffer(std::uint64_t bytes)
        : bound_(static_cast<GLuint>(record::integer(GL_TRANSFORM_FEEDBACK_BINDING))),
          generic_(static_cast<GLuint>(record::integer(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING))) {
        REAL(glGenTransformFeedbacks)(1, &feedback_);
        REAL(glBindTransformFeedback)(GL_TRANSFORM_FEEDBACK, feedback_);
        REAL(glCreateBuffers)(1, &buffer_);
        REAL(glNamedBufferData)(buffer_, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
        REAL(glBindBufferBase)(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer_);
    }
    ~FeedbackBuffer() {
        REAL(glBindTransformFeedback)(GL_TRANSFORM_FEEDBACK, bound_);
        REAL(glBindBuffer)(GL_TRANSFORM_FEEDBACK_BUFFER, generic_);
        REAL(glDeleteTransformFeedbacks)(1, &feedback_);
        REAL(glDeleteBuffers)(1, &buffer_);
    }
    FeedbackBuffer(const FeedbackBuffer&) = delete;
    FeedbackBuffer& operator=(const FeedbackBuffer&) = delete;

    Positions read(std::uint64_t vertices) const {
        Positions positions(vertices * 4);
        REAL(glGetNamedBufferSubData)
        (buffer_, 0, static_cast<GLsizeiptr>(positions.size() * sizeof(float)), positions.data());
        return positions;
    }

  private:
    GLuint bound_, generic_;
    GLuint feedback_ = 0, buffer_ = 0;
};

} // namespace

Positions captured_positions(GLenum primitives, std::uint64_t most, const std::function<void()>& draw) {
    if (most == 0 || record::integer(GL_TRANSFORM_FEEDBACK_ACTIVE) != 0) return {};
    const CapturingProgram program;
    if (!program.ready()) return {};
    const FeedbackBuffer buffer(most * 4 * sizeof(float));
    const bool discards = REAL(glIsEnabled)(GL_RASTERIZER_DISCARD) != GL_FALSE;
    REAL(glEnable)(GL_RASTERIZER_DISCARD);
    Counter written(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
    REAL(glBeginTransformFeedback)(primitives);
    draw();
    REAL(glEndTransformFeedback)();
    const std::int64_t count = written.stop();
    if (!discards) REAL(glDisable)(GL_RASTERIZER_DISCARD);
    const std::uint64_t corners = primitives == GL_POINTS ? 1 : primitives == GL_LINES ? 2 : 3;
    return count <= 0 ? Positions() : buffer.read(static_cast<std::uint64_t>(count) * corners);
}

void link_with_positions(GLuint program) {
    if (!capturing_programs().contains(program)) {
        REAL(glTransformFeedbackVaryings)(program, 1, &position, GL_INTERLEAVED_ATTRIBS);
        REAL(glLinkProgram)(program);
        GLint linked = GL_FALSE;
        REAL(glGetProgramiv)(program, GL_LINK_STATUS, &linked);
        if (linked != GL_FALSE) return;
        REAL(glTransformFeedbackVaryings)(program, 0, nullptr, GL_INTERLEAVED_ATTRIBS);
    }
    REAL(glLinkProgram)(program);
}

void captures_its_own(GLuint program) { capturing_programs().insert(program); }

} // namespace measure
