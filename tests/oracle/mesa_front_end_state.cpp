// State of fixed function, points and lines against Mesa's llvmpipe.
//
// Where llvmpipe does otherwise than the specification, the test says so and bounds the difference.
#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/random.hpp"
#include "tests/support/mesa_fixture.hpp"
#include "tests/support/mesa_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace tests {
namespace {

using pipeline::FaceCulling;
using pipeline::PixelRectangle;
using pipeline::ProvokingVertex;
using pipeline::Topology;

class MesaFrontEndState : public ExactMesaTest {
  protected:
    /// Pixels whose counts or last primitives differ.
    static std::vector<std::size_t> different_pixels(const TriangleScene& scene, std::uint64_t& fragments) {
        const OwnPicture own = count_fragments(rasterize_scene(scene));
        const MesaPicture mesa = renderer_->render(scene, MesaMode::count);
        std::vector<std::size_t> different;
        fragments = 0;
        for (std::size_t i = 0; i < own.count.size(); ++i) {
            fragments += own.count[i];
            if (static_cast<float>(own.count[i]) != mesa.colour[i].r || own.id[i] != mesa.id[i]) different.push_back(i);
        }
        return different;
    }
    static void expect_equal(const TriangleScene& scene, std::size_t allowed = 0) {
        std::uint64_t fragments = 0;
        EXPECT_LE(different_pixels(scene, fragments).size(), allowed);
        EXPECT_GT(fragments, 0U);
    }
};

TEST_F(MesaFrontEndState, ViewportsCoverTheSamePixels) {
    TriangleScene scene = random_soup(4000, 20.0, 11);
    for (const PixelRectangle& viewport : {PixelRectangle{0, 0, 512, 512},
                                           {64, 32, 256, 128},
                                           {-100, 60, 400, 300},
                                           {301, 17, 333, 555},
                                           {5, 7, 1, 3}}) {
        SCOPED_TRACE(fmt::format("{}x{} at ({}, {})", viewport.width, viewport.height, viewport.x, viewport.y));
        scene.state.viewport = viewport;
        expect_equal(scene);
    }
}

TEST_F(MesaFrontEndState, ScissorsLeaveTheSamePixels) {
    TriangleScene scene = random_soup(4000, 40.0, 12);
    for (const PixelRectangle& scissor :
         {PixelRectangle{64, 32, 256, 128}, {-100, 61, 303, 300}, {301, 17, 333, 555}}) {
        scene.state.scissor = scissor;
        expect_equal(scene);
    }
}

TEST_F(MesaFrontEndState, FacesAreCulledAlike) {
    TriangleScene scene = sphere_grid(3, 16, 24);
    for (const bool front_is_clockwise : {false, true})
        for (const FaceCulling culling : {FaceCulling::none, FaceCulling::front, FaceCulling::back}) {
            scene.state.culling = culling;
            scene.state.front_is_clockwise = front_is_clockwise;
            expect_equal(scene);
        }
}

TEST_F(MesaFrontEndState, DepthClampKeepsTheSamePixels) {
    TriangleScene scene = random_soup(2000, 40.0, 13);
    for (std::size_t i = 0; i < scene.positions.size(); ++i) scene.positions[i].z = scene.positions[i].z * 6.0F - 3.0F;
    scene.state.depth.clamp = true;
    expect_equal(scene);
    // Depths of single triangles, within the rounding of llvmpipe's plane in single precision.
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        TriangleScene one = random_soup(1, 200.0, 100 + seed);
        for (std::size_t i = 0; i < 3; ++i) one.positions[i].z = one.positions[i].z * 6.0F - 3.0F;
        one.state.depth.clamp = true;
        const OwnPicture own = count_fragments(rasterize_scene(one));
        const MesaPicture mesa = renderer_->render(one, MesaMode::nearest);
        for (std::size_t i = 0; i < own.count.size(); ++i)
            if (own.count[i] != 0 && mesa.id[i] != 0) {
                ASSERT_NEAR(own.depth[i], mesa.depth[i], 3e-5F) << seed;
            }
    }
}

TEST_F(MesaFrontEndState, DepthRangesGiveTheSameDepths) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        TriangleScene scene = random_soup(1, 200.0, 300 + seed);
        scene.state.depth.range_near = static_cast<float>(seed % 4) / 4.0F;
        scene.state.depth.range_far = static_cast<float>(seed % 3) / 2.0F;
        scene.state.depth.clamp = seed >= 6;
        if (scene.state.depth.clamp)
            for (std::size_t i = 0; i < 3; ++i) scene.positions[i].z = scene.positions[i].z * 6.0F - 3.0F;
        const OwnPicture own = count_fragments(rasterize_scene(scene));
        const MesaPicture mesa = renderer_->render(scene, MesaMode::nearest);
        for (std::size_t i = 0; i < own.count.size(); ++i)
            if (own.count[i] != 0 && mesa.id[i] != 0) {
                ASSERT_NEAR(own.depth[i], mesa.depth[i], 3e-5F) << seed;
            }
    }
}

TEST_F(MesaFrontEndState, BiasMovesDepthsAlike) {
    double largest = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        TriangleScene scene = random_soup(1, 200.0, 200 + seed);
        const MesaPicture plain = renderer_->render(scene, MesaMode::nearest);
        const OwnPicture own_plain = count_fragments(rasterize_scene(scene));
        scene.state.depth.bias_slope = static_cast<float>(seed % 3) - 1.0F;
        scene.state.depth.bias_constant = static_cast<float>(seed % 4) * 1000.0F;
        const MesaPicture mesa = renderer_->render(scene, MesaMode::nearest);
        const OwnPicture own = count_fragments(rasterize_scene(scene));
        for (std::size_t i = 0; i < own.count.size(); ++i) {
            if (own.count[i] == 0 || mesa.id[i] == 0 || plain.id[i] == 0) continue;
            if (own.depth[i] <= 0 || own.depth[i] >= 1) continue;
            const double moved = static_cast<double>(own.depth[i]) - static_cast<double>(own_plain.depth[i]);
            const double in_mesa = static_cast<double>(mesa.depth[i]) - static_cast<double>(plain.depth[i]);
            largest = std::max(largest, std::fabs(moved - in_mesa));
        }
    }
    fmt::print("biases differ by {} at most\n", largest);
    EXPECT_LT(largest, 1e-6);
}

/// Distance of a point from a line segment.
double distance(const glm::dvec2& point, const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 along = to - from;
    const double length = glm::dot(along, along);
    const double t = length > 0.0 ? std::clamp(glm::dot(point - from, along) / length, 0.0, 1.0) : 0.0;
    return glm::length(point - (from + t * along));
}

TEST_F(MesaFrontEndState, PlanesOfTheUserCutAlikeButForEdgesOfWhatIsCut) {
    std::size_t different = 0;
    std::uint64_t all = 0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        TriangleScene scene = random_soup(60, 120.0, 300 + seed);
        scene.state.clip_planes = 0b1010;
        scene.state.clip_plane[0] = {0, 0, 0, -1}; // would cut everything
        scene.state.clip_plane[1] = {1, 0.25F, 0, -200};
        scene.state.clip_plane[3] = {-0.5F, 1, 30, -100};
        std::uint64_t fragments = 0;
        for (const std::size_t pixel : different_pixels(scene, fragments)) {
            ++different;
            const glm::dvec2 centre(static_cast<double>(pixel % 512) + 0.5, static_cast<double>(pixel / 512) + 0.5);
            bool explained = false; // near an edge of a triangle that is cut, or near the cut
            for (std::size_t i = 0; i < scene.indices.size(); i += 3) {
                std::array<glm::dvec3, 3> corners;
                for (std::size_t k = 0; k < 3; ++k) corners[k] = glm::dvec3(scene.positions[scene.indices[i + k]]);
                for (const std::size_t p : {1U, 3U}) {
                    const glm::dvec4 plane(scene.state.clip_plane[p]);
                    std::vector<glm::dvec2> cuts;
                    for (std::size_t k = 0; k < 3; ++k) {
                        const glm::dvec3 &a = corners[k], &b = corners[(k + 1) % 3];
                        const double da = glm::dot(plane, glm::dvec4(a, 1)), db = glm::dot(plane, glm::dvec4(b, 1));
                        if ((da < 0) == (db < 0)) continue;
                        cuts.emplace_back(glm::dvec2(a + (b - a) * (da / (da - db))));
                    }
                    if (cuts.size() != 2) continue;
                    explained |= distance(centre, cuts[0], cuts[1]) <= 1.0;
                    for (std::size_t k = 0; k < 3; ++k)
                        explained |= distance(centre, glm::dvec2(corners[k]), glm::dvec2(corners[(k + 1) % 3])) <= 1.0;
                }
            }
            EXPECT_TRUE(explained) << pixel % 512 << ", " << pixel / 512;
        }
        all += fragments;
    }
    fmt::print("{} pixels of {} fragments differ\n", different, all);
    EXPECT_LT(static_cast<double>(different), 2e-3 * static_cast<double>(all));
}

TEST_F(MesaFrontEndState, ProvokingVerticesAreTheSame) {
    for (const Topology topology : {Topology::triangles, Topology::triangle_strip, Topology::triangle_fan,
                                    Topology::points, Topology::lines, Topology::line_strip, Topology::line_loop})
        for (const ProvokingVertex which : {ProvokingVertex::first, ProvokingVertex::last}) {
            TriangleScene scene = random_soup(10, 100.0, 14);
            scene.topology = topology;
            scene.state.provoking = which;
            const pipeline::FragmentStream stream = rasterize_scene(scene);
            const OwnPicture own = count_fragments(stream);
            const MesaPicture mesa = renderer_->render(scene, MesaMode::flat);
            const PipelineScene input = pipeline_scene(scene);
            const pipeline::PrimitiveReader read(input.resources, input.resources.geometries[0]);
            std::size_t wrong = 0, compared = 0;
            for (std::size_t i = 0; i < own.id.size(); ++i) {
                if (own.id[i] == 0 || own.id[i] != mesa.id[i]) continue;
                const std::uint32_t primitive = own.id[i] - 1;
                const auto vertex = static_cast<float>(read(primitive)[read.provoking(primitive, which)]);
                wrong += vertex != mesa.colour[i].r ? 1U : 0U;
                ++compared;
            }
            EXPECT_EQ(wrong, 0U) << static_cast<int>(topology) << (which == ProvokingVertex::last ? " last" : " first");
            EXPECT_GT(compared, 10U);
        }
}

TriangleScene scattered(Topology topology, std::uint32_t vertices, std::uint32_t grid, std::uint64_t seed) {
    TriangleScene scene = random_soup((vertices + 2) / 3, 60.0, seed, grid);
    scene.topology = topology;
    return scene;
}

// llvmpipe snaps points half way between two places of the sub-pixel grid upwards, not to the even one; a point in
// thousands shows it.
TEST_F(MesaFrontEndState, PointsCoverTheSamePixels) {
    for (const std::uint32_t grid : {0U, 1U, 2U, 4U})
        for (const float size : {1.0F, 1.5F, 2.0F, 3.0F, 7.25F, 20.0F}) {
            SCOPED_TRACE(fmt::format("size {}, grid {}", size, grid));
            TriangleScene scene = scattered(Topology::points, 3000, grid, 15);
            scene.state.point_size = size;
            expect_equal(scene, grid == 0 ? 8 : 0);
        }
}

TEST_F(MesaFrontEndState, PointsWithTheirCentreOutsideAreDropped) {
    TriangleScene scene = scattered(Topology::points, 3, 1, 16);
    scene.positions = {{-2, 100, 0.5F}, {100, 100, 0.5F}, {200, 514, 0.5F}};
    scene.state.point_size = 9;
    std::uint64_t fragments = 0;
    different_pixels(scene, fragments);
    EXPECT_EQ(fragments, 81U);
    const MesaPicture mesa = renderer_->render(scene, MesaMode::count);
    EXPECT_EQ(mesa.samples_passed, 81U);
}

// llvmpipe decides at the ends of lines in single precision, on places that are neither snapped nor moved for widths,
// so there it may have a pixel, or a row of them across a wide line, more or less. Everywhere else both agree; and at
// ends in the centres of pixels, where no diamond is in doubt.
TEST_F(MesaFrontEndState, LinesCoverTheSamePixelsButAtTheirEnds) {
    struct Kind {
        Topology topology;
        std::uint32_t grid;
        float width;
    };
    for (const Kind& kind : {Kind{Topology::lines, 0, 1},
                             {Topology::lines, 1, 1},
                             {Topology::lines, 2, 1},
                             {Topology::lines, 4, 1},
                             {Topology::lines, 0, 2},
                             {Topology::lines, 1, 3},
                             {Topology::lines, 0, 6},
                             {Topology::line_strip, 0, 1},
                             {Topology::line_strip, 1, 3},
                             {Topology::line_loop, 0, 1},
                             {Topology::line_loop, 1, 1}}) {
        SCOPED_TRACE(fmt::format("{}, grid {}, width {}", static_cast<int>(kind.topology), kind.grid, kind.width));
        TriangleScene scene = scattered(kind.topology, 240, kind.grid, 17);
        scene.state.line_width = kind.width;
        std::uint64_t fragments = 0;
        const std::vector<std::size_t> different = different_pixels(scene, fragments);
        const double reach = 1.5 + static_cast<double>(kind.width) * 0.75;
        std::size_t unexplained = 0;
        for (const std::size_t pixel : different) {
            const glm::dvec2 centre(static_cast<double>(pixel % 512) + 0.5, static_cast<double>(pixel / 512) + 0.5);
            const bool at_an_end =
                std::any_of(scene.positions.begin(), scene.positions.end(),
                            [&](const glm::vec3& end) { return glm::distance(glm::dvec2(end), centre) <= reach; });
            unexplained += at_an_end ? 0U : 1U;
        }
        fmt::print("{}, grid {}, width {}: {} of {} pixels differ, {} of them not at an end\n",
                   static_cast<int>(kind.topology), kind.grid, kind.width, different.size(), fragments, unexplained);
        EXPECT_LT(static_cast<double>(unexplained), 0.004 * static_cast<double>(fragments));
        EXPECT_LT(static_cast<double>(different.size()), 0.01 * static_cast<double>(fragments));
        if (kind.grid == 1 && std::fmod(kind.width, 2.0F) == 1.0F) {
            EXPECT_EQ(different.size(), 0U);
        }
    }
}

} // namespace
} // namespace tests
