// The batch model of the post-transform cache against the vertex shader invocations that llvmpipe reports: equal,
// exactly.
#include "pipeline/geometry/geometry_front.hpp"
#include "pipeline/memory/memory_system.hpp"
#include "tests/oracle/mesa_context.hpp"
#include "tests/support/mesa_renderer.hpp"
#include "tests/support/oracle_meshes.hpp"

#include <gtest/gtest.h>
#include <numeric>

#if ROPSIM_HAVE_EGL
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#endif

namespace {

using pipeline::MesaReuse;
using pipeline::Topology;
using tests::IndexedMesh;
using tests::SceneDraw;

#if ROPSIM_HAVE_EGL

/// A program, a 4x4 target and vertices; needs a current OpenGL context.
void set_up_opengl() {
    const GLuint program = tests::link_program("#version 450 core\nlayout(location=0) in vec3 p;"
                                               "void main() { gl_Position = vec4(p, 1.0); }",
                                               "#version 450 core\nout vec4 c; void main() { c = vec4(1); }", {});
    glUseProgram(program);
    GLuint target = 0;
    GLuint framebuffer = 0;
    glGenRenderbuffers(1, &target);
    glBindRenderbuffer(GL_RENDERBUFFER, target);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 4, 4);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target);
    glViewport(0, 0, 4, 4);
    GLuint array = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
}

GLenum mode_of(Topology topology) {
    if (topology == Topology::triangle_strip) return GL_TRIANGLE_STRIP;
    return topology == Topology::triangle_fan ? GL_TRIANGLE_FAN : GL_TRIANGLES;
}

std::uint64_t invocations(const SceneDraw& draw) {
    const std::vector<float> positions(std::size_t{3} * draw.vertex_count, 0.25F);
    std::array<GLuint, 2> buffers{};
    GLuint query = 0;
    glGenBuffers(2, buffers.data());
    glGenQueries(1, &query);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(positions.size() * 4), positions.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 12, nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(draw.indices.size() * 4), draw.indices.data(),
                 GL_STATIC_DRAW);
    const auto count = static_cast<GLsizei>(draw.indices.size());
    const auto instances = static_cast<GLsizei>(draw.instances);
    glBeginQuery(GL_VERTEX_SHADER_INVOCATIONS_ARB, query);
    if (draw.index_type == pipeline::IndexType::none)
        glDrawArraysInstanced(mode_of(draw.topology), 0, count, instances);
    else
        glDrawElementsInstanced(mode_of(draw.topology), count, GL_UNSIGNED_INT, nullptr, instances);
    glEndQuery(GL_VERTEX_SHADER_INVOCATIONS_ARB);
    GLuint64 result = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &result);
    glDeleteBuffers(2, buffers.data());
    glDeleteQueries(1, &query);
    return result;
}

#else

void set_up_opengl() {}
std::uint64_t invocations(const SceneDraw&) { return 0; }

#endif

class TriangleDrain final : public sim::Component {
  public:
    sim::In<pipeline::TriangleTask> in{*this, "in"};
    explicit TriangleDrain(sim::Context context) : Component(std::move(context)) {}

  private:
    sim::Activity tick() override {
        if (in.peek() == nullptr) return sim::Activity::starved;
        in.pop();
        return sim::Activity::busy;
    }
};

/// Vertex shader runs of the timed front.
std::uint64_t simulated(const SceneDraw& draw) {
    const tests::GeometryScene scene = tests::make_scene({draw});
    sim::Simulation simulation;
    const sim::Clock& clock = simulation.add_clock("core", 650);
    pipeline::MemorySystem memory(simulation, clock, {});
    pipeline::GeometryParams params;
    params.vertex_reuse.model = pipeline::ReuseModel::mesa;
    pipeline::GeometryFront front(simulation, clock, params, scene.frame, scene.frame.needs);
    TriangleDrain drain(simulation.context("drain", clock));
    front.attach(memory);
    sim::connect(front.triangles_out(), drain.in, {});
    front.start(scene.stream, scene.frame.draws);
    simulation.run();
    return front.stats().vertex_shader.vertices;
}

SceneDraw list_of(const IndexedMesh& mesh, std::uint32_t instances = 1) {
    return {.vertex_count = mesh.vertex_count, .indices = mesh.indices, .instances = instances};
}

std::vector<std::uint32_t> counting(std::uint32_t count) {
    std::vector<std::uint32_t> list(count);
    std::iota(list.begin(), list.end(), 0U);
    return list;
}

class MesaVertices : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        renderer_ = tests::MesaRenderer::create(reason_); // makes its OpenGL context current
        if (renderer_ != nullptr) set_up_opengl();
    }
    static void TearDownTestSuite() { renderer_.reset(); }
    void SetUp() override {
        if (renderer_ == nullptr) GTEST_SKIP() << "NOT COMPARED with Mesa: " << reason_;
    }
    static std::unique_ptr<tests::MesaRenderer> renderer_;
    static std::string reason_;
};
std::unique_ptr<tests::MesaRenderer> MesaVertices::renderer_;
std::string MesaVertices::reason_;

TEST_F(MesaVertices, IndexedListsHaveEqualRuns) {
    for (const IndexedMesh& mesh : tests::oracle_meshes()) {
        MesaReuse model;
        model.begin_draw(mesh.vertex_count, true);
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
            model.triangle({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
        EXPECT_EQ(model.runs(), invocations(list_of(mesh))) << mesh.name;
    }
}

TEST_F(MesaVertices, TimedFrontHasEqualRuns) {
    for (const IndexedMesh& mesh :
         {tests::grid_mesh(60, 40), tests::random_mesh(5000, 3000, 1), tests::sphere_mesh(40, 60)})
        EXPECT_EQ(simulated(list_of(mesh)), invocations(list_of(mesh))) << mesh.name;
}

TEST_F(MesaVertices, InstancesMultiply) {
    const SceneDraw draw = list_of(tests::random_mesh(500, 300, 1), 5);
    EXPECT_EQ(simulated(draw), invocations(draw));
}

TEST_F(MesaVertices, EachVertexRunsOnceWithoutAnIndexBuffer) {
    for (const std::uint32_t count : {3U, 300U, 3000U}) {
        const SceneDraw draw{
            .index_type = pipeline::IndexType::none, .vertex_count = count, .indices = counting(count)};
        EXPECT_EQ(invocations(draw), count);
        EXPECT_EQ(simulated(draw), count);
    }
}

TEST_F(MesaVertices, GridOfAMillionTrianglesHasEqualRunsLong) {
    const SceneDraw draw = list_of(tests::grid_mesh(1000, 500));
    EXPECT_EQ(simulated(draw), invocations(draw));
}

} // namespace
