// Blending, write masks, depth compares and stencil of two faces, against Mesa's llvmpipe: random states, several of
// them in each frame.
#include "pipeline/functional/front_end.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/reference.hpp"
#include "tests/support/functional_scene.hpp"
#include "tests/support/mesa_fixture.hpp"
#include "tests/support/random_states.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace tests {
namespace {

constexpr std::uint32_t width = 64, height = 64, draws_of_frame = 4;
constexpr std::uint64_t seeds = 8; ///< of each scene

struct SceneShape {
    std::uint32_t triangles; ///< of a draw
    double size;             ///< pixels
    std::uint32_t levels;    ///< of depth
};
/// From few layers to many, from small triangles to some that cover half the picture.
constexpr std::array<SceneShape, 5> shapes{{{60, 3.0, 7}, {24, 8.0, 3}, {10, 20.0, 15}, {4, 40.0, 3}, {60, 12.0, 31}}};

/// One frame for both: every draw has a state and triangles of its own.
struct Frames {
    TriangleScene scene;
    std::vector<MesaDraw> draws;
    std::vector<glm::vec4> colours; ///< by triangle
    glm::vec4 background{51.0F / 255.0F, 102.0F / 255.0F, 204.0F / 255.0F, 153.0F / 255.0F};
    FunctionalScene own{width, height};

    Frames(const SceneShape& shape, std::uint64_t seed) {
        sim::Random random(seed, "raster states");
        scene.width = width;
        scene.height = height;
        scene.matrix = own.view.projection;
        for (std::uint32_t draw = 0; draw < draws_of_frame; ++draw) {
            draws.push_back({draw * shape.triangles, shape.triangles, random_state(random)});
            MeshData mesh;
            for (const LevelTriangle& triangle :
                 level_triangles(shape.triangles, width, height, shape.size, shape.levels, random)) {
                for (const glm::vec2& corner : triangle.corners) mesh.positions.emplace_back(corner, triangle.depth);
                colours.push_back(triangle.colour);
            }
            scene.positions.insert(scene.positions.end(), mesh.positions.begin(), mesh.positions.end());
            own.add(mesh);
        }
        for (std::uint32_t i = 0; i < scene.positions.size(); ++i) scene.indices.push_back(i);
    }

    pipeline::ReferenceImage reference() {
        pipeline::FragmentStream stream = own.rasterize();
        stream.colours.resize(stream.quads.size());
        for (std::size_t i = 0; i < stream.quads.size(); ++i)
            stream.colours[i].fill(colours[stream.triangles[stream.quads[i].triangle].primitive]);
        pipeline::Frame frame;
        frame.resources = std::make_shared<pipeline::Resources>(own.resources);
        frame.draws = own.draws;
        frame.view = own.view;
        frame.depth_format = pipeline::SurfaceFormat::d24s8;
        frame.colour_format = pipeline::SurfaceFormat::rgba8;
        frame.background = background;
        pipeline::Pass pass;
        pass.draws = own.all_draws();
        pass.targets = {colour_surface};
        pass.states.clear();
        for (const MesaDraw& draw : draws) {
            pass.state_of_draw.push_back(static_cast<std::uint32_t>(pass.states.size()));
            pass.states.push_back(draw.state);
        }
        frame.passes = {pass};
        bind_surfaces(frame);
        return pipeline::run_reference(frame, std::vector{stream});
    }
};

struct Differences {
    std::size_t depth = 0, stencil = 0;    ///< pixels
    std::array<std::size_t, 256> colour{}; ///< channels by how many units they differ
    /// Pixels that do not hold what they were cleared to.
    std::size_t coloured = 0, deep = 0, stencilled = 0;
};

class MesaRasterState : public MesaTest {
  protected:
    static void compare(Frames& frames, Differences& differences) {
        const MesaCodes mesa = renderer_->render_states(frames.scene, frames.draws, frames.colours, frames.background);
        const pipeline::ReferenceImage own = frames.reference();
        for (std::size_t pixel = 0; pixel < mesa.depth.size(); ++pixel) {
            const std::uint32_t depth = pipeline::depth_code(pipeline::SurfaceFormat::d24s8, own.depth[pixel]);
            differences.depth += depth != mesa.depth[pixel] ? 1U : 0U;
            differences.deep += mesa.depth[pixel] != 0xFFFFFFU ? 1U : 0U;
            differences.stencilled += mesa.stencil[pixel] != 0 ? 1U : 0U;
            differences.stencil += own.stencil[pixel] != mesa.stencil[pixel] ? 1U : 0U;
            const glm::vec4 cleared = glm::round(frames.background * 255.0F);
            differences.coloured += glm::vec4(mesa.colour[pixel]) != cleared ? 1U : 0U;
            for (int channel = 0; channel < 4; ++channel) {
                const auto code = std::lround(own.colour[pixel * 4 + static_cast<std::size_t>(channel)] * 255.0F);
                ++differences.colour.at(static_cast<std::size_t>(std::abs(code - mesa.colour[pixel][channel])));
            }
        }
    }
};

TEST_F(MesaRasterState, RandomStatesGiveTheSameSurfaces) {
    std::size_t coloured = 0, deep = 0, stencilled = 0, exact = 0, near = 0;
    for (std::size_t shape = 0; shape < shapes.size(); ++shape)
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            SCOPED_TRACE(fmt::format("scene {} seed {}", shape, seed));
            Frames frames(shapes[shape], seed * 16 + shape);
            Differences differences;
            compare(frames, differences);
            EXPECT_EQ(differences.depth, 0U);
            EXPECT_EQ(differences.stencil, 0U);
            std::size_t worst = 255;
            while (worst > 0 && differences.colour[worst] == 0) --worst;
            EXPECT_LE(worst, 1U);
            coloured += differences.coloured;
            deep += differences.deep;
            stencilled += differences.stencilled;
            exact += differences.colour[0];
            near += differences.colour[1];
        }
    fmt::print("{} pixels coloured, {} with depth, {} with stencil; {} channels equal, {} differ by 1\n", coloured,
               deep, stencilled, exact, near);
    constexpr std::size_t pixels = std::size_t{width} * height * shapes.size() * seeds;
    EXPECT_GT(coloured, pixels / 4);
    EXPECT_GT(deep, pixels / 20);
    EXPECT_GT(stencilled, pixels / 5);
}

} // namespace
} // namespace tests
