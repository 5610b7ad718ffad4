// Draws with a vertex program: what it makes of vertices is what the fixed transform would make of the same positions,
// and its varyings arrive at the fragments.
#include "pipeline/functional/shade_pass.hpp"
#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/functional/vertex_transform.hpp"
#include "pipeline/vertex_program.hpp"
#include "sim/check.hpp"
#include "tests/support/functional_scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

namespace vertex_programs_test {

using pipeline::FragmentStream;
using pipeline::FrontEndOptions;
using pipeline::ProgramVertices;
using pipeline::RasterState;
using pipeline::ShaderInput;
using tests::FunctionalScene;

/// Calls a function for each vertex.
class Program final : public pipeline::VertexProgram {
  public:
    struct Vertex {
        glm::vec4& position;
        std::span<glm::vec4> varyings;
        float* size;
        pipeline::ClipDistances* distances;
    };
    using Function = std::function<void(std::uint32_t instance, std::uint32_t number, Vertex vertex)>;

    Program(pipeline::VertexProgramShape shape, Function function) : shape_(shape), function_(std::move(function)) {}
    pipeline::VertexProgramShape shape() const override { return shape_; }
    void run(std::uint32_t instance, std::uint32_t first, const ProgramVertices& vertices) const override {
        for (std::size_t i = 0; i < vertices.positions.size(); ++i)
            function_(instance, first + static_cast<std::uint32_t>(i),
                      {vertices.positions[i], vertices.varyings.subspan(i * shape_.varyings, shape_.varyings),
                       vertices.point_sizes.empty() ? nullptr : &vertices.point_sizes[i],
                       vertices.distances.empty() ? nullptr : &vertices.distances[i]});
    }

  private:
    pipeline::VertexProgramShape shape_;
    Function function_;
};

/// A triangle through the near plane, its corners at different distances from the eye.
FunctionalScene tilted() {
    FunctionalScene scene(32, 32);
    scene.view.view = glm::mat4(1.0F);
    scene.view.projection = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1.02F, -1}, {0, 0, -0.2F, 0}};
    tests::MeshData mesh;
    mesh.positions = {{-1, -0.8F, -1}, {1.5F, -1, -2}, {0.1F, 0.2F, 0.05F}};
    mesh.colours = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0.5F}};
    scene.add(mesh);
    return scene;
}

pipeline::AttributeReader reader(const FunctionalScene& scene, pipeline::Semantic semantic) {
    const pipeline::Geometry& geometry = scene.resources.geometries[0];
    return {scene.resources, *geometry.find(semantic)};
}

/// What the matrices of the view make, with the vertex colours as varyings.
std::shared_ptr<const Program> same_as_fixed(const FunctionalScene& scene, std::uint64_t flat = 0) {
    const glm::mat4 matrix = pipeline::clip_matrix(scene.view, scene.draws[0].instances[0]);
    const auto position = reader(scene, pipeline::Semantic::position),
               colour = reader(scene, pipeline::Semantic::colour);
    return std::make_shared<const Program>(pipeline::VertexProgramShape{.varyings = 2, .flat = flat},
                                           [=](std::uint32_t, std::uint32_t number, Program::Vertex vertex) {
                                               vertex.position = pipeline::to_clip(matrix, position(number));
                                               vertex.varyings[0] = colour(number);
                                               vertex.varyings[1] = glm::vec4(static_cast<float>(number));
                                           });
}

FrontEndOptions without_colours() {
    FrontEndOptions options;
    options.colours = false;
    return options;
}

TEST(VertexPrograms, SamePositionsGiveTheSameFragments) {
    FunctionalScene scene = tilted();
    const FragmentStream fixed = scene.rasterize(without_colours());
    scene.draws[0].program = same_as_fixed(scene);
    const FragmentStream programmed = scene.rasterize(without_colours());
    ASSERT_GT(fixed.fragments, 50U);
    EXPECT_TRUE(fixed.primitives[0].clipped);
    ASSERT_EQ(fixed.quads.size(), programmed.quads.size());
    EXPECT_EQ(fixed.depths, programmed.depths);
    for (std::size_t i = 0; i < fixed.quads.size(); ++i) EXPECT_EQ(fixed.quads[i].covered, programmed.quads[i].covered);
}

TEST(VertexPrograms, VaryingsAreInterpolatedAsVertexColoursAre) {
    FunctionalScene scene = tilted();
    FrontEndOptions unlit;
    unlit.fragment_colour = pipeline::FragmentColour::unlit;
    scene.resources.materials[0].alpha_mode = pipeline::AlphaMode::blend; // keeps its alpha
    const FragmentStream fixed = scene.rasterize(unlit);
    scene.draws[0].program = same_as_fixed(scene);
    const FragmentStream programmed = scene.rasterize(without_colours());
    ASSERT_FALSE(programmed.quads.empty());
    ASSERT_EQ(programmed.varyings_of(0).size(), 3U);
    for (pipeline::QuadId quad = 0; quad < fixed.quads.size(); ++quad) {
        const ShaderInput input = pipeline::shader_input(programmed, quad);
        for (std::size_t lane = 0; lane < 4; ++lane) {
            if ((fixed.quads[quad].covered >> lane & 1U) == 0) continue;
            EXPECT_EQ(input.varyings[1][lane], fixed.colours[quad][lane]) << quad << " " << lane;
        }
    }
}

// The depth of the eye follows from the window depth of a perspective projection; it is w. Depths are those of the
// corners before they are snapped to 1/256 of a pixel, weights those behind.
TEST(VertexPrograms, TheFirstVaryingHasTheW) {
    FunctionalScene scene = tilted();
    scene.draws[0].program = same_as_fixed(scene);
    const FragmentStream stream = scene.rasterize(without_colours());
    for (pipeline::QuadId quad = 0; quad < stream.quads.size(); ++quad)
        for (std::size_t lane = 0; lane < 4; ++lane) {
            if ((stream.quads[quad].covered >> lane & 1U) == 0) continue;
            const float z = stream.depths[quad][lane] * 2 - 1; // (1.02 w - 0.2) / w
            const float w = pipeline::shader_input(stream, quad).varyings[0][lane].x;
            EXPECT_NEAR((1.02F * w - 0.2F) / w, z, 5e-4F);
        }
}

// x over w is linear on the screen, also where a corner lies behind the eye: 16 pixels are one of it.
TEST(VertexPrograms, LinearVaryingsAreThoseOfTheScreen) {
    FunctionalScene scene = tilted();
    const auto placed = same_as_fixed(scene);
    scene.draws[0].program =
        std::make_shared<const Program>(pipeline::VertexProgramShape{.varyings = 2, .linear = 2},
                                        [placed](std::uint32_t instance, std::uint32_t number, Program::Vertex vertex) {
                                            std::array<glm::vec4, 2> unused{};
                                            placed->run(instance, number, {{&vertex.position, 1}, unused, {}, {}});
                                            vertex.varyings[0] = vertex.varyings[1] =
                                                vertex.position / vertex.position.w;
                                        });
    const FragmentStream stream = scene.rasterize(without_colours());
    EXPECT_TRUE(stream.primitives[0].clipped);
    float in_perspective = 0;
    for (pipeline::QuadId quad = 0; quad < stream.quads.size(); ++quad)
        for (std::uint32_t lane = 0; lane < 4; ++lane) {
            if ((stream.quads[quad].covered >> lane & 1U) == 0) continue;
            const ShaderInput input = pipeline::shader_input(stream, quad);
            const float x = (static_cast<float>(input.x + lane % 2) + 0.5F) / 16.0F - 1.0F;
            EXPECT_NEAR(input.varyings[2][lane].x, x, 1e-3F); // corners lie within 1/512 of a pixel
            in_perspective = std::max(in_perspective, std::fabs(input.varyings[1][lane].x - x));
        }
    EXPECT_GT(in_perspective, 0.01F);
}

TEST(VertexPrograms, FlatVaryingsKeepTheBitsOfTheProvokingVertex) {
    FunctionalScene scene = tilted();
    const auto position = same_as_fixed(scene);
    scene.draws[0].program = std::make_shared<const Program>(
        pipeline::VertexProgramShape{.varyings = 2, .flat = 2},
        [position](std::uint32_t instance, std::uint32_t number, Program::Vertex vertex) {
            std::array<glm::vec4, 2> unused{};
            glm::vec4 place;
            position->run(instance, number, {{&place, 1}, unused, {}, {}});
            vertex.position = place;
            vertex.varyings[1].x = std::bit_cast<float>(0xFFFFFFF0U + number); // no number, but a whole one
        });
    for (const auto provoking : {pipeline::ProvokingVertex::first, pipeline::ProvokingVertex::last}) {
        RasterState state;
        state.provoking = provoking;
        FrontEndOptions options = without_colours();
        options.states = {&state, 1};
        const FragmentStream stream = scene.rasterize(options);
        const std::uint32_t expected = provoking == pipeline::ProvokingVertex::first ? 0xFFFFFFF0U : 0xFFFFFFF2U;
        ASSERT_FALSE(stream.quads.empty());
        for (pipeline::QuadId quad = 0; quad < stream.quads.size(); ++quad)
            for (const glm::vec4& value : pipeline::shader_input(stream, quad).varyings[2])
                EXPECT_EQ(std::bit_cast<std::uint32_t>(value.x), expected);
    }
}

// Distances that are those of a plane of the user cut as the plane does.
TEST(VertexPrograms, ClipDistancesCutAsUserPlanesDo) {
    FunctionalScene scene = tilted();
    RasterState state;
    state.clip_planes = 4;
    state.clip_plane[2] = {1, 0, 0, 0.25F};
    FrontEndOptions options = without_colours();
    options.states = {&state, 1};
    const FragmentStream fixed = scene.rasterize(options);
    const auto whole = same_as_fixed(scene);
    const auto position = reader(scene, pipeline::Semantic::position);
    scene.draws[0].program =
        std::make_shared<const Program>(pipeline::VertexProgramShape{.clip_distances = 4},
                                        [=](std::uint32_t instance, std::uint32_t number, Program::Vertex vertex) {
                                            std::array<glm::vec4, 2> unused{};
                                            whole->run(instance, number, {{&vertex.position, 1}, unused, {}, {}});
                                            (*vertex.distances)[2] = position(number).x + 0.25F;
                                            (*vertex.distances)[1] = -1; // does not cut
                                        });
    const FragmentStream programmed = scene.rasterize(options);
    ASSERT_GT(fixed.fragments, 20U);
    EXPECT_EQ(fixed.fragments, programmed.fragments);
    EXPECT_EQ(fixed.depths, programmed.depths);
}

/// Points in a row without any attributes: number i at (4 i + 2, 4) pixels.
FunctionalScene points(Program::Function also, pipeline::VertexProgramShape shape, std::uint32_t number = 3) {
    FunctionalScene scene(16, 8);
    pipeline::Geometry& geometry = scene.resources.geometries.emplace_back();
    geometry.topology = pipeline::Topology::points;
    geometry.vertex_count = geometry.index_count = number;
    scene.draws.push_back({"points", 0, 0, {glm::mat4(1.0F)}});
    scene.draws[0].program = std::make_shared<const Program>(
        shape, [also = std::move(also)](std::uint32_t instance, std::uint32_t i, Program::Vertex vertex) {
            vertex.position = {(4.0F * static_cast<float>(i) + 2) / 8 - 1, 0, 0, 1};
            also(instance, i, vertex);
        });
    return scene;
}

TEST(VertexPrograms, PointsHaveTheSizesItGives) {
    constexpr std::array<float, 3> sizes{1, 2, std::numeric_limits<float>::quiet_NaN()};
    FunctionalScene scene = points(
        [&](std::uint32_t, std::uint32_t i, Program::Vertex vertex) { *vertex.size = sizes[i]; }, {.point_size = true});
    RasterState state;
    state.point_size = 3;
    FrontEndOptions options = without_colours();
    options.states = {&state, 1};
    const auto fragments = [&scene, &options](std::size_t triangle) {
        const FragmentStream stream = scene.rasterize(options);
        std::uint32_t sum = 0;
        for (const pipeline::Quad& quad : stream.quads)
            if (quad.triangle == triangle) sum += static_cast<std::uint32_t>(std::popcount(quad.covered));
        return sum;
    };
    EXPECT_EQ(fragments(0), 9U); // the state's
    state.point_size_of_vertex = true;
    EXPECT_EQ(fragments(0), 1U);
    EXPECT_EQ(fragments(1), 4U);
    EXPECT_EQ(fragments(2), 1U);
}

TEST(VertexPrograms, PlacesInAPointRunFromItsUpperLeftCorner) {
    FunctionalScene scene = points([](std::uint32_t, std::uint32_t, Program::Vertex) {}, {}, 1);
    RasterState state;
    state.point_size = 4;
    FrontEndOptions options = without_colours();
    options.states = {&state, 1};
    const FragmentStream stream = scene.rasterize(options);
    ASSERT_EQ(stream.fragments, 16U);
    for (pipeline::QuadId quad = 0; quad < stream.quads.size(); ++quad) {
        const ShaderInput input = pipeline::shader_input(stream, quad);
        for (std::uint32_t lane = 0; lane < 4; ++lane) {
            const auto x = static_cast<float>(input.x + lane % 2), y = static_cast<float>(input.y + lane / 2);
            EXPECT_FLOAT_EQ(input.varyings[0][lane].y, (x + 0.5F) / 4);
            EXPECT_FLOAT_EQ(input.varyings[0][lane].z, (y - 2 + 0.5F) / 4);
        }
    }
}

TEST(VertexPrograms, InstancesKnowTheirNumber) {
    FunctionalScene scene =
        points([](std::uint32_t instance, std::uint32_t,
                  Program::Vertex vertex) { vertex.varyings[0] = glm::vec4(static_cast<float>(instance)); },
               {.varyings = 1}, 1);
    scene.draws[0].instances.assign(3, glm::mat4(1.0F));
    const FragmentStream stream = scene.rasterize(without_colours());
    ASSERT_EQ(stream.quads.size(), 3U);
    for (pipeline::QuadId quad = 0; quad < 3; ++quad)
        EXPECT_EQ(pipeline::shader_input(stream, quad).varyings[1][0].x, static_cast<float>(quad));
}

/// Vertex i takes `each` and i more instructions.
class CountingProgram final : public pipeline::VertexProgram {
  public:
    explicit CountingProgram(std::uint32_t each) : each_(each) {}
    pipeline::VertexProgramShape shape() const override { return {}; }
    void run(std::uint32_t, std::uint32_t first, const ProgramVertices& vertices) const override {
        for (std::uint32_t i = 0; i < vertices.positions.size(); ++i) {
            vertices.positions[i] = {0, 0, 0, 1};
            vertices.instructions[i] = each_ + first + i;
        }
    }

  private:
    std::uint32_t each_;
};

TEST(VertexPrograms, RangesHaveTheMeanOfTheirInstructions) {
    FunctionalScene scene = points([](std::uint32_t, std::uint32_t, Program::Vertex) {}, {}, 9000);
    EXPECT_EQ(scene.rasterize(without_colours()).draws[0].vertex_instructions, 0U); // it does not count
    scene.draws[0].program = std::make_shared<const CountingProgram>(7);
    scene.draws[0].instances.assign(2, glm::mat4(1.0F));
    for (const unsigned threads : {1U, 3U}) {
        FrontEndOptions options = without_colours();
        options.threads = threads;
        const FragmentStream stream = scene.rasterize(options);
        for (const pipeline::DrawRange& range : stream.draws)
            EXPECT_EQ(range.vertex_instructions, 7U + 4500U); // of 4499.5, rounded
    }
}

TEST(VertexPrograms, AQuadKeepsAsManyVaryingsAsItsDrawHas) {
    FunctionalScene scene = tilted();
    const auto with_two = same_as_fixed(scene);
    scene.draws.resize(4, scene.draws[0]);
    scene.draws[0].program = scene.draws[3].program = with_two;
    scene.draws[2].program = std::make_shared<const Program>(
        pipeline::VertexProgramShape{},
        [with_two](std::uint32_t instance, std::uint32_t number, Program::Vertex vertex) {
            std::array<glm::vec4, 2> unused{};
            with_two->run(instance, number, {{&vertex.position, 1}, unused, {}, {}});
        });
    const FragmentStream stream = scene.rasterize(without_colours());
    const std::size_t quads = stream.quads.size() / 4;
    ASSERT_EQ(stream.quads.size(), quads * 4);
    EXPECT_EQ(stream.given_varyings.size(), quads * (3 + 0 + 1 + 3));
    for (pipeline::QuadId quad = 0; quad < quads; ++quad) {
        const auto of_draw = [&](std::size_t draw) {
            return stream.varyings_of(static_cast<pipeline::QuadId>(quad + draw * quads));
        };
        EXPECT_TRUE(of_draw(1).empty());
        ASSERT_EQ(of_draw(2).size(), 1U);
        EXPECT_EQ(of_draw(2)[0], of_draw(0)[0]);
        ASSERT_EQ(of_draw(3).size(), 3U);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(of_draw(3)[i], of_draw(0)[i]) << quad << " " << i;
    }
}

TEST(VertexPrograms, WithoutAProgramADrawNeedsPositions) {
    FunctionalScene scene = points([](std::uint32_t, std::uint32_t, Program::Vertex) {}, {}, 1);
    scene.draws[0].program = nullptr;
    EXPECT_THROW(scene.rasterize(without_colours()), sim::InputError);
    scene = points([](std::uint32_t, std::uint32_t, Program::Vertex) {}, {.varyings = pipeline::most_varyings + 1}, 1);
    EXPECT_THROW(scene.rasterize(without_colours()), sim::InputError);
}

TEST(VertexPrograms, PositionsThatAreNoNumbersDrawNothing) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        FunctionalScene scene = points(
            [value](std::uint32_t, std::uint32_t i, Program::Vertex vertex) {
                if (i == 1) vertex.position.w = value;
                vertex.varyings[0] = glm::vec4(value);
            },
            {.varyings = 1});
        EXPECT_EQ(scene.rasterize(without_colours()).fragments, 2U);
    }
}

} // namespace vertex_programs_test
