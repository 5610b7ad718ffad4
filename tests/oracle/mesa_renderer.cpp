#include "tests/support/mesa_renderer.hpp"

#include "tests/oracle/mesa_context.hpp"

#if ROPSIM_HAVE_EGL

#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <GL/glcorearb.h>

#include <array>
#include <stdexcept>

namespace tests {

namespace {

constexpr const char* vertex_source = R"(#version 450 core
layout(location = 0) in vec3 position;
uniform mat4 clip_matrix;
uniform vec4 planes[8];
flat out uint vertex;
out float gl_ClipDistance[8];

// The sum is written out, and precise, so that no compiler forms other sums or fused operations.
void main() {
    precise vec4 clip = ((clip_matrix[0] * position.x + clip_matrix[1] * position.y) + clip_matrix[2] * position.z)
                        + clip_matrix[3];
    gl_Position = clip;
    for (int i = 0; i < 8; ++i) gl_ClipDistance[i] = dot(planes[i], vec4(position, 1.0));
    vertex = uint(gl_VertexID);
}
)";

constexpr const char* fragment_source = R"(#version 450 core
layout(location = 0) out vec4 colour;
layout(location = 1) out uint id;
flat in uint vertex;
uniform samplerBuffer colours;
uniform int first_triangle;
uniform int mode; // as MesaMode
void main() {
    colour = mode == 2 ? texelFetch(colours, gl_PrimitiveID + first_triangle)
                       : vec4(mode == 3 ? float(vertex) : 1.0);
    id = uint(gl_PrimitiveID) + 1u;
}
)";

/// Colour, R32UI and depth targets of one size; with D24S8 the stencil is attached, too.
class Targets {
  public:
    Targets(GLsizei width, GLsizei height, GLenum colour = GL_RGBA32F, GLenum depth = GL_DEPTH_COMPONENT32F,
            const glm::vec4& background = glm::vec4(0.0F)) {
        glGenFramebuffers(1, &framebuffer_);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glGenRenderbuffers(3, buffers_.data());
        attach(0, colour, GL_COLOR_ATTACHMENT0, width, height);
        attach(1, GL_R32UI, GL_COLOR_ATTACHMENT1, width, height);
        attach(2, depth, depth == GL_DEPTH24_STENCIL8 ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, width,
               height);
        constexpr std::array<GLenum, 2> draw_buffers{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
        glDrawBuffers(2, draw_buffers.data());
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw std::runtime_error("the framebuffer of the OpenGL reference is not complete");
        glViewport(0, 0, width, height);
        constexpr std::array<GLuint, 4> none{};
        constexpr float far = 1.0F;
        constexpr GLint no_stencil = 0;
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glDepthMask(GL_TRUE);
        glStencilMask(0xFF);
        glClearBufferfv(GL_COLOR, 0, &background[0]);
        glClearBufferuiv(GL_COLOR, 1, none.data());
        glClearBufferfv(GL_DEPTH, 0, &far);
        glClearBufferiv(GL_STENCIL, 0, &no_stencil);
    }
    ~Targets() {
        glDeleteFramebuffers(1, &framebuffer_);
        glDeleteRenderbuffers(3, buffers_.data());
    }
    Targets(const Targets&) = delete;
    Targets& operator=(const Targets&) = delete;

  private:
    void attach(std::size_t i, GLenum format, GLenum attachment, GLsizei width, GLsizei height) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
        glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffers_[i]);
    }

    GLuint framebuffer_ = 0;
    std::array<GLuint, 3> buffers_{};
};

void set(GLenum what, bool on) { on ? glEnable(what) : glDisable(what); }

template <class Value, std::size_t n>
GLenum of(const std::array<GLenum, n>& names, Value value) {
    return names.at(static_cast<std::size_t>(value));
}

constexpr std::array<GLenum, 8> compares{GL_NEVER,   GL_LESS,     GL_EQUAL,  GL_LEQUAL,
                                         GL_GREATER, GL_NOTEQUAL, GL_GEQUAL, GL_ALWAYS};
constexpr std::array<GLenum, 15> factors{GL_ZERO,
                                         GL_ONE,
                                         GL_SRC_COLOR,
                                         GL_ONE_MINUS_SRC_COLOR,
                                         GL_DST_COLOR,
                                         GL_ONE_MINUS_DST_COLOR,
                                         GL_SRC_ALPHA,
                                         GL_ONE_MINUS_SRC_ALPHA,
                                         GL_DST_ALPHA,
                                         GL_ONE_MINUS_DST_ALPHA,
                                         GL_CONSTANT_COLOR,
                                         GL_ONE_MINUS_CONSTANT_COLOR,
                                         GL_CONSTANT_ALPHA,
                                         GL_ONE_MINUS_CONSTANT_ALPHA,
                                         GL_SRC_ALPHA_SATURATE};
constexpr std::array<GLenum, 5> equations{GL_FUNC_ADD, GL_FUNC_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT, GL_MIN, GL_MAX};
constexpr std::array<GLenum, 8> stencil_operations{GL_KEEP, GL_ZERO,      GL_REPLACE,   GL_INCR,
                                                   GL_DECR, GL_INCR_WRAP, GL_DECR_WRAP, GL_INVERT};

void set_face(GLenum face, const pipeline::StencilFace& state) {
    glStencilFuncSeparate(face, of(compares, state.compare), state.reference, state.compare_mask);
    glStencilOpSeparate(face, of(stencil_operations, state.stencil_fails), of(stencil_operations, state.depth_fails),
                        of(stencil_operations, state.passes));
    glStencilMaskSeparate(face, state.write_mask);
}

void set_raster_state(const pipeline::RasterState& state) {
    const pipeline::BlendState& blend = state.blend[0];
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND); // of the second target, which holds integers
    if (blend.enabled) glEnablei(GL_BLEND, 0);
    glBlendFuncSeparatei(0, of(factors, blend.colour.source), of(factors, blend.colour.target),
                         of(factors, blend.alpha.source), of(factors, blend.alpha.target));
    glBlendEquationSeparatei(0, of(equations, blend.colour.equation), of(equations, blend.alpha.equation));
    glBlendColor(blend.constant.r, blend.constant.g, blend.constant.b, blend.constant.a);
    const auto channel = [&](unsigned i) { return static_cast<GLboolean>(state.write_mask[0] >> i & 1U); };
    glColorMaski(0, channel(0), channel(1), channel(2), channel(3));
    set(GL_DEPTH_TEST, state.depth.used()); // OpenGL writes depth only while it tests
    glDepthFunc(state.depth.test ? of(compares, state.depth.compare) : GL_ALWAYS);
    glDepthMask(state.depth.write ? GL_TRUE : GL_FALSE);
    set(GL_STENCIL_TEST, state.stencil.test);
    set_face(GL_FRONT, state.stencil.front);
    set_face(GL_BACK, state.stencil.back);
    glFrontFace(state.front_is_clockwise ? GL_CCW : GL_CW); // OpenGL sees the picture upside down, see load()
}

template <class Element>
void upload(GLenum target, GLuint buffer, const std::vector<Element>& elements) {
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(elements.size() * sizeof(Element)), elements.data(), GL_STATIC_DRAW);
}

class LlvmpipeRenderer : public MesaRenderer {
  public:
    LlvmpipeRenderer() : program_(link_program(vertex_source, fragment_source, {})) {
        glGenVertexArrays(1, &vertex_array_);
        glGenBuffers(3, buffers_.data());
        glGenTextures(1, &colours_);
        glGenQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
    }

    std::string description() const override {
        return std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + ", OpenGL " +
               reinterpret_cast<const char*>(glGetString(GL_VERSION));
    }

    MesaPicture render(const TriangleScene& scene, MesaMode mode, const std::vector<glm::vec4>& colours,
                       bool cull_back) override {
        const Targets targets(static_cast<GLsizei>(scene.width), static_cast<GLsizei>(scene.height));
        set_state(mode, cull_back);
        set_front_end_state(scene);
        load(scene, mode, colours);
        for (std::size_t i = 0; i < queries_.size(); ++i) glBeginQuery(query_targets[i], queries_[i]);
        glDrawElements(mode_of(scene.topology), static_cast<GLsizei>(scene.indices.size()), GL_UNSIGNED_INT, nullptr);
        for (const GLenum target : query_targets) glEndQuery(target);
        MesaPicture picture = read(scene);
        if (glGetError() != GL_NO_ERROR) throw std::runtime_error("the OpenGL reference reports an error");
        return picture;
    }

    MesaCodes render_states(const TriangleScene& scene, const std::vector<MesaDraw>& draws,
                            const std::vector<glm::vec4>& colours, const glm::vec4& background) override {
        const auto width = static_cast<GLsizei>(scene.width), height = static_cast<GLsizei>(scene.height);
        const Targets targets(width, height, GL_RGBA8, GL_DEPTH24_STENCIL8, background);
        set_front_end_state(scene);
        load(scene, MesaMode::blend, colours);
        for (const MesaDraw& draw : draws) {
            set_raster_state(draw.state);
            glUniform1i(glGetUniformLocation(program_, "first_triangle"), static_cast<GLint>(draw.first_triangle));
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(draw.triangles * 3), GL_UNSIGNED_INT,
                           reinterpret_cast<const void*>(std::size_t{draw.first_triangle} * 3 * sizeof(GLuint)));
        }
        set_raster_state({});
        glUniform1i(glGetUniformLocation(program_, "first_triangle"), 0);
        const std::size_t pixels = std::size_t{scene.width} * scene.height;
        MesaCodes codes{std::vector<glm::u8vec4>(pixels), std::vector<std::uint32_t>(pixels),
                        std::vector<std::uint8_t>(pixels)};
        glReadBuffer(GL_COLOR_ATTACHMENT0);
        glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, codes.colour.data());
        glReadPixels(0, 0, width, height, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, codes.depth.data());
        for (std::size_t i = 0; i < pixels; ++i) {
            codes.stencil[i] = static_cast<std::uint8_t>(codes.depth[i] & 0xFFU);
            codes.depth[i] >>= 8U;
        }
        if (glGetError() != GL_NO_ERROR) throw std::runtime_error("the OpenGL reference reports an error");
        return codes;
    }

  private:
    static constexpr std::array<GLenum, 4> query_targets{GL_SAMPLES_PASSED, GL_FRAGMENT_SHADER_INVOCATIONS,
                                                         GL_CLIPPING_INPUT_PRIMITIVES, GL_CLIPPING_OUTPUT_PRIMITIVES};

    static void set_state(MesaMode mode, bool cull_back) {
        set(GL_DEPTH_TEST, mode == MesaMode::nearest);
        glDepthFunc(GL_LESS);
        glDisable(GL_BLEND);
        if (mode == MesaMode::count || mode == MesaMode::blend) glEnablei(GL_BLEND, 0);
        if (mode == MesaMode::count) {
            glBlendFunci(0, GL_ONE, GL_ONE);
        } else {
            glBlendFuncSeparatei(0, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        }
        set(GL_CULL_FACE, cull_back);
        glCullFace(GL_BACK);
        glFrontFace(GL_CW); // OpenGL sees the picture upside down, see load()
    }

    static GLenum mode_of(pipeline::Topology topology) {
        constexpr std::array<GLenum, 7> modes{GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN, GL_POINTS,
                                              GL_LINES,     GL_LINE_STRIP,     GL_LINE_LOOP};
        return modes[static_cast<std::size_t>(topology)];
    }

    static void set_front_end_state(const TriangleScene& scene) {
        const pipeline::RasterState& state = scene.state;
        const auto rectangle = [](const auto& apply, const pipeline::PixelRectangle& r) {
            apply(r.x, r.y, static_cast<GLsizei>(r.width), static_cast<GLsizei>(r.height));
        };
        rectangle(glViewport, state.viewport.value_or(pipeline::PixelRectangle{0, 0, scene.width, scene.height}));
        set(GL_SCISSOR_TEST, state.scissor.has_value());
        if (state.scissor) rectangle(glScissor, *state.scissor);
        if (state.culling != pipeline::FaceCulling::by_material) {
            constexpr std::array<GLenum, 5> faces{GL_BACK, GL_BACK, GL_FRONT, GL_BACK, GL_FRONT_AND_BACK};
            set(GL_CULL_FACE, state.culling != pipeline::FaceCulling::none);
            glCullFace(faces[static_cast<std::size_t>(state.culling)]);
            glFrontFace(state.front_is_clockwise ? GL_CCW : GL_CW);
        }
        set(GL_DEPTH_CLAMP, state.depth.clamp);
        glDepthRange(static_cast<GLdouble>(state.depth.range_near), static_cast<GLdouble>(state.depth.range_far));
        set(GL_POLYGON_OFFSET_FILL, true);
        glPolygonOffset(state.depth.bias_slope, state.depth.bias_constant);
        glProvokingVertex(state.provoking == pipeline::ProvokingVertex::first ? GL_FIRST_VERTEX_CONVENTION
                                                                              : GL_LAST_VERTEX_CONVENTION);
        for (GLenum i = 0; i < pipeline::most_clip_distances; ++i)
            set(GL_CLIP_DISTANCE0 + i, (state.clip_planes >> i & 1U) != 0);
        glPointSize(state.point_size);
        glLineWidth(state.line_width);
    }

    void load(const TriangleScene& scene, MesaMode mode, const std::vector<glm::vec4>& colours) {
        // OpenGL's row 0 is the bottom row. With y negated it becomes the top row and the tie rule the top-left rule.
        glm::mat4 matrix = scene.matrix;
        for (int column = 0; column < 4; ++column) matrix[column][1] = -matrix[column][1];
        glUseProgram(program_);
        glUniformMatrix4fv(glGetUniformLocation(program_, "clip_matrix"), 1, GL_FALSE, &matrix[0][0]);
        glUniform1i(glGetUniformLocation(program_, "mode"), static_cast<GLint>(mode));
        glUniform4fv(glGetUniformLocation(program_, "planes"), 8, &scene.state.clip_plane[0][0]);
        glUniform1i(glGetUniformLocation(program_, "colours"), 0);
        glBindVertexArray(vertex_array_);
        upload(GL_ARRAY_BUFFER, buffers_[0], scene.positions);
        upload(GL_ELEMENT_ARRAY_BUFFER, buffers_[1], scene.indices);
        glBindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 12, nullptr);
        upload(GL_TEXTURE_BUFFER, buffers_[2], colours.empty() ? std::vector<glm::vec4>(1) : colours);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_BUFFER, colours_);
        glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffers_[2]);
    }

    MesaPicture read(const TriangleScene& scene) const {
        const std::size_t pixels = std::size_t{scene.width} * scene.height;
        const auto width = static_cast<GLsizei>(scene.width);
        const auto height = static_cast<GLsizei>(scene.height);
        MesaPicture picture;
        picture.colour.resize(pixels);
        picture.id.resize(pixels);
        picture.depth.resize(pixels);
        glReadBuffer(GL_COLOR_ATTACHMENT0);
        glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, picture.colour.data());
        glReadBuffer(GL_COLOR_ATTACHMENT1);
        glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, picture.id.data());
        glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, picture.depth.data());
        const auto value = [&](std::size_t i) {
            GLuint64 result = 0;
            glGetQueryObjectui64v(queries_[i], GL_QUERY_RESULT, &result);
            return std::uint64_t{result};
        };
        picture.samples_passed = value(0);
        picture.fs_invocations = value(1);
        picture.clipping_input = value(2);
        picture.clipping_output = value(3);
        return picture;
    }

    GLuint program_;
    GLuint vertex_array_ = 0, colours_ = 0;
    std::array<GLuint, 3> buffers_{};
    std::array<GLuint, 4> queries_{};
};

} // namespace

std::unique_ptr<MesaRenderer> MesaRenderer::create(std::string& reason) {
    const auto context = create_mesa_context(MesaProfile::core, reason);
    if (!context) return nullptr;
    if (eglMakeCurrent(context->display, EGL_NO_SURFACE, EGL_NO_SURFACE, context->context) == EGL_FALSE) {
        reason = "EGL needs a surface";
        return nullptr;
    }
    auto renderer = std::make_unique<LlvmpipeRenderer>();
    if (renderer->description().find("llvmpipe") == std::string::npos) {
        reason = "OpenGL is not llvmpipe but " + renderer->description();
        return nullptr;
    }
    return renderer;
}

} // namespace tests

#else

namespace tests {

std::unique_ptr<MesaRenderer> MesaRenderer::create(std::string& reason) {
    reason = "built without EGL (package libegl-dev)";
    return nullptr;
}

} // namespace tests

#endif
