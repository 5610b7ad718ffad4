// What llvmpipe's vertex shader gets of vertex attributes and index buffers, by transform feedback: every component
// type, and the triangles that primitive restart leaves.
#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/random.hpp"
#include "tests/support/mesa_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <gtest/gtest.h>

#if ROPSIM_HAVE_EGL
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#endif

namespace {

using pipeline::ComponentType;
using pipeline::Geometry;
using pipeline::IndexType;
using pipeline::Topology;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

constexpr std::uint32_t vertices = 256;

/// Vertex data of one attribute at some stride and offset.
struct Input {
    pipeline::VertexAttribute attribute;
    std::vector<std::byte> bytes;
};

Input random_input(ComponentType type, std::uint8_t components, bool normalized, sim::Random& random) {
    Input input;
    input.attribute.type = type;
    input.attribute.components = components;
    input.attribute.normalized = normalized;
    input.attribute.stride = input.attribute.bytes() + 4;
    input.attribute.offset = 8;
    input.bytes.resize(input.attribute.offset + std::size_t{vertices} * input.attribute.stride);
    for (std::byte& byte : input.bytes) byte = static_cast<std::byte>(random.below(256));
    return input;
}

#if ROPSIM_HAVE_EGL

GLuint feedback_program(const char* varying) {
    const char* source = "#version 450 core\nlayout(location=0) in vec4 a; out vec4 value; flat out int number;"
                         "void main() { value = a; number = gl_VertexID; gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }";
    const GLuint shader = glCreateShader(GL_VERTEX_SHADER);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    const GLuint program = glCreateProgram();
    glAttachShader(program, shader);
    glTransformFeedbackVaryings(program, 1, &varying, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    EXPECT_NE(linked, 0);
    return program;
}

/// Draws are errors without a complete framebuffer, though they rasterize nothing here.
void set_up_framebuffer() {
    GLuint target = 0, framebuffer = 0;
    glGenRenderbuffers(1, &target);
    glBindRenderbuffer(GL_RENDERBUFFER, target);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 4, 4);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
}

GLuint buffer_with(GLenum target, const void* bytes, std::size_t size) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(size), bytes, GL_STATIC_DRAW);
    return buffer;
}

/// Bytes that `draw` captures while `varying` is fed back; `mode` is that of the feedback.
template <class Value, class Draw>
std::vector<Value> fed_back(const char* varying, GLenum mode, std::size_t most, Draw draw) {
    const GLuint program = feedback_program(varying);
    GLuint array = 0, query = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glUseProgram(program);
    glEnable(GL_RASTERIZER_DISCARD);
    const std::vector<Value> zeros(most);
    const GLuint captured = buffer_with(GL_TRANSFORM_FEEDBACK_BUFFER, zeros.data(), most * sizeof(Value));
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, captured);
    glGenQueries(1, &query);
    glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query);
    glBeginTransformFeedback(mode);
    draw();
    glEndTransformFeedback();
    glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
    GLuint64 primitives = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &primitives);
    std::vector<Value> values(std::min<std::size_t>(most, primitives * (mode == GL_TRIANGLES ? 3 : 1)));
    glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, static_cast<GLsizeiptr>(values.size() * sizeof(Value)),
                       values.data());
    glDisable(GL_RASTERIZER_DISCARD);
    glDeleteBuffers(1, &captured);
    glDeleteQueries(1, &query);
    glDeleteVertexArrays(1, &array);
    glDeleteProgram(program);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return values;
}

GLenum opengl_type(ComponentType type) {
    constexpr std::array<GLenum, 9> types{GL_FLOAT,
                                          GL_HALF_FLOAT,
                                          GL_BYTE,
                                          GL_UNSIGNED_BYTE,
                                          GL_SHORT,
                                          GL_UNSIGNED_SHORT,
                                          GL_UNSIGNED_INT,
                                          GL_INT_2_10_10_10_REV,
                                          GL_UNSIGNED_INT_2_10_10_10_REV};
    return types[static_cast<std::size_t>(type)];
}

std::vector<glm::vec4> values_in_mesa(const Input& input) {
    return fed_back<glm::vec4>("value", GL_POINTS, vertices, [&] {
        const GLuint buffer = buffer_with(GL_ARRAY_BUFFER, input.bytes.data(), input.bytes.size());
        const auto& a = input.attribute;
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, a.components, opengl_type(a.type), a.normalized ? GL_TRUE : GL_FALSE,
                              static_cast<GLsizei>(a.stride), reinterpret_cast<const void*>(a.offset));
        glDrawArrays(GL_POINTS, 0, vertices);
        glDeleteBuffers(1, &buffer);
    });
}

Triangles triangles_in_mesa(const Geometry& geometry, const std::vector<std::byte>& indices) {
    constexpr std::array<GLenum, 3> modes{GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN};
    constexpr std::array<GLenum, 4> types{0, GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_UNSIGNED_INT};
    const auto numbers = fed_back<std::int32_t>("number", GL_TRIANGLES, std::size_t{3} * geometry.index_count, [&] {
        const GLuint buffer = buffer_with(GL_ELEMENT_ARRAY_BUFFER, indices.data(), indices.size());
        glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
        glDrawElements(modes[static_cast<std::size_t>(geometry.topology)], static_cast<GLsizei>(geometry.index_count),
                       types[static_cast<std::size_t>(geometry.index_type)], nullptr);
        glDisable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
        glDeleteBuffers(1, &buffer);
    });
    Triangles triangles(numbers.size() / 3);
    for (std::size_t i = 0; i < numbers.size(); ++i) triangles[i / 3][i % 3] = static_cast<std::uint32_t>(numbers[i]);
    return triangles;
}

#else

void set_up_framebuffer() {}
std::vector<glm::vec4> values_in_mesa(const Input&) { return {}; }
Triangles triangles_in_mesa(const Geometry&, const std::vector<std::byte>&) { return {}; }

#endif

class MesaVertexInput : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        renderer_ = tests::MesaRenderer::create(reason_); // makes its OpenGL context current
        if (renderer_ != nullptr) set_up_framebuffer();
    }
    static void TearDownTestSuite() { renderer_.reset(); }
    void SetUp() override {
        if (renderer_ == nullptr) GTEST_SKIP() << "NOT COMPARED with Mesa: " << reason_;
    }
    static std::unique_ptr<tests::MesaRenderer> renderer_;
    static std::string reason_;
};
std::unique_ptr<tests::MesaRenderer> MesaVertexInput::renderer_;
std::string MesaVertexInput::reason_;

/// Equal but for the last bit or two, which llvmpipe loses by multiplying with a reciprocal.
bool near(float a, float b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
    return a == b || std::fabs(a - b) <= 2.5e-7F * std::max(std::fabs(a), std::fabs(b));
}

void expect_mesa_reads(const Input& input) {
    const auto& a = input.attribute;
    const auto found = values_in_mesa(input);
    const pipeline::AttributeReader read(input.bytes.data(), a);
    // llvmpipe keeps 23 bits of normalised 32-bit integers.
    const float slack = a.normalized && a.type == ComponentType::u32 ? 0x1p-23F : 0.0F;
    ASSERT_EQ(found.size(), vertices);
    for (std::uint32_t i = 0; i < vertices; ++i)
        for (int c = 0; c < 4; ++c)
            ASSERT_TRUE(near(read(i)[c], found[i][c]) || std::fabs(read(i)[c] - found[i][c]) <= slack)
                << fmt::format("{} x {}, normalised {}, element {} component {}: {} here, {} in Mesa", a.components,
                               sim::enum_name(a.type), a.normalized, i, c, read(i)[c], found[i][c]);
}

TEST_F(MesaVertexInput, AttributesOfEveryTypeAreReadAlike) {
    sim::Random random(1, "attributes");
    for (std::size_t type = 0; type < sim::EnumNames<ComponentType>::names.size(); ++type)
        for (const std::uint8_t components : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{4}})
            for (const bool normalized : {false, true}) {
                const auto kind = static_cast<ComponentType>(type);
                if (is_packed(kind) && components != 4) continue;
                expect_mesa_reads(random_input(kind, components, normalized, random));
            }
}

std::vector<std::byte> index_bytes(IndexType type, const std::vector<std::uint32_t>& indices) {
    const std::size_t size = pipeline::bytes_of(type);
    std::vector<std::byte> bytes(indices.size() * size);
    for (std::size_t i = 0; i < indices.size(); ++i) std::memcpy(bytes.data() + i * size, &indices[i], size);
    return bytes;
}

/// The smallest vertex first; the winding stays.
Triangles turned(Triangles triangles) {
    for (auto& triangle : triangles)
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    return triangles;
}

TEST_F(MesaVertexInput, PrimitiveRestartLeavesTheSameTrianglesInTheSameOrder) {
    sim::Random random(2, "restarts");
    for (const Topology topology : {Topology::triangles, Topology::triangle_strip, Topology::triangle_fan})
        for (const IndexType type : {IndexType::u8, IndexType::u16, IndexType::u32})
            for (int round = 0; round < 10; ++round) {
                std::vector<std::uint32_t> indices;
                for (std::uint32_t i = 0; i < 300; ++i) // distinct neighbours, so that windings can be told apart
                    indices.push_back(random.below(5) == 0 ? pipeline::restart_index(type) : i % 200);
                pipeline::Resources resources;
                resources.buffers = {{"indices", index_bytes(type, indices), 0}};
                Geometry geometry;
                geometry.topology = topology;
                geometry.vertex_count = 200;
                geometry.index_type = type;
                geometry.index_count = static_cast<std::uint32_t>(indices.size());
                geometry.primitive_restart = true;
                resources.geometries = {geometry};
                resources.find_runs();
                const pipeline::PrimitiveReader read(resources, resources.geometries[0]);
                Triangles expected;
                for (std::uint32_t i = 0; i < resources.geometries[0].triangle_count(); ++i)
                    expected.push_back(read(i));
                EXPECT_GT(expected.size(), 20U);
                EXPECT_EQ(turned(triangles_in_mesa(geometry, resources.buffers[0].bytes)), turned(expected));
            }
}

} // namespace
