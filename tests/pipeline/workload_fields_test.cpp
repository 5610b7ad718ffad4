// Isosurfaces and volumes of scalar fields whose pictures can be computed, and points as sprites (specification 004,
// A15, A16).
#include "models/programs/isosurface.hpp"
#include "models/programs/nearest_k.hpp" // empty_depth
#include "tests/support/box_ray.hpp"
#include "tests/support/replay.hpp"
#include "traces/tetrahedra/tetrahedral_mesh.hpp"
#include "traces/workloads/scalar_field.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace workload_fields_test {

using support::Interval;
using support::PixelRay;
using support::Replay;

constexpr std::uint32_t size = 64;

Replay field(const std::string& scene, const std::string& workload, std::vector<std::string> knobs,
             const std::string& camera = "2,0.7,1.1,0,0,0,35") {
    return Replay(scene,
                  {.width = size, .height = size, .workload = workload, .camera = camera, .knobs = std::move(knobs)});
}

/// What the k-buffer of an isosurface found at a pixel, after the drain.
models::IsosurfaceState state_at(const Replay& replay, std::uint32_t x, std::uint32_t y) {
    const pipeline::ModifyProgram& program = *replay.frame.program;
    const float* begin = replay.reference.kbuffer.data() + (std::size_t{y} * size + x) * program.floats_per_pixel();
    std::vector<float> pixel(begin, begin + program.floats_per_pixel());
    program.drain(pixel.data());
    return models::isosurface_state(program, pixel.data());
}

bool is_finite(const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

/// The plane x = `plane` inside the cube, seen through a pixel.
void expect_plane(const Replay& replay, double plane) {
    std::size_t hits = 0, doubtful = 0;
    double worst = 0.0;
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) {
            const PixelRay ray(replay.frame.view, x, y);
            const double distance = (plane - ray.at(0.0).x) / ray.step().x;
            const glm::dvec3 place = ray.at(distance);
            const double outside = std::max(std::fabs(place.y), std::fabs(place.z)) - 0.5;
            if (std::fabs(outside) < 1e-3) {
                ++doubtful;
                continue;
            }
            const auto state = state_at(replay, x, y);
            if (outside > 0.0) {
                EXPECT_EQ(state.distance, models::empty_depth) << x << ' ' << y;
                continue;
            }
            ++hits;
            worst = std::max(worst, std::fabs(static_cast<double>(state.distance) - distance) / distance);
        }
    EXPECT_GT(hits, 300U);
    EXPECT_LT(doubtful, 50U);
    // Scalars follow the corners snapped to 1/256 of a pixel, depths the corners themselves. Half a step is 5e-5 of the
    // scene here, and a face whose scalar changes ten times as fast across the picture as along the ray is off by 5e-4.
    EXPECT_LT(worst, 5e-4);
    testing::Test::RecordProperty("worst_relative_error", fmt::format("{:.3g}", worst));
}

TEST(Isosurface, OfALinearFieldIsAPlane) {
    expect_plane(field("gen:tetrahedra?n=6&field=linear", "isosurface", {"iso=0.5"}), 0.0);
    expect_plane(field("gen:tetrahedra?n=5&field=linear", "isosurface", {"iso=0.37"}), -0.13);
}

TEST(Isosurface, AtValuesOfVerticesIsThePlaneThroughThem) {
    // Whole layers of vertices, edges and faces have just that value.
    expect_plane(field("gen:tetrahedra?n=4&field=linear", "isosurface", {"iso=0.25"}), -0.25);
    expect_plane(field("gen:tetrahedra?n=2&field=linear", "isosurface", {"iso=0.5"}), 0.0);
}

TEST(Isosurface, OfSeveralValuesIsTheNearestOfThem) {
    const Replay replay = field("gen:tetrahedra?n=6&field=linear", "isosurface", {"iso=[0.2,0.7]"});
    std::size_t both = 0;
    for (std::uint32_t y = 24; y < 40; ++y)
        for (std::uint32_t x = 24; x < 40; ++x) {
            const auto state = state_at(replay, x, y);
            if (state.distance == models::empty_depth) continue;
            const PixelRay ray(replay.frame.view, x, y);
            EXPECT_NEAR(ray.at(static_cast<double>(state.distance)).x, 0.2, 1e-3); // the eye is on the side of 0.7
            EXPECT_EQ(state.iso, 1.0F);
            ++both;
        }
    EXPECT_GT(both, 100U);
}

TEST(Isosurface, OfARadialFieldIsABall) {
    // Between vertices the field is linear, so the surface is off by what a chord is off its arc.
    const Replay replay = field("gen:tetrahedra?n=24", "isosurface", {"iso=0.4"}, "0,0,3,0,0,0,30");
    const double radius = 0.4 * std::sqrt(0.75);
    const PixelRay middle(replay.frame.view, size / 2, size / 2);
    const auto state = state_at(replay, size / 2, size / 2);
    EXPECT_NEAR(static_cast<double>(state.distance), middle.in_sphere(radius).enter, 2e-3);
    EXPECT_EQ(state_at(replay, 2, 2).distance, models::empty_depth);
}

TEST(Isosurface, BeyondTheScalarsThereIsNone) {
    const Replay replay = field("gen:tetrahedra?n=3&field=linear", "isosurface", {"iso=[-1,2]"});
    for (const float value : replay.reference.picture) EXPECT_EQ(value, 1.0F);
    const Replay constant = field("gen:tetrahedra?n=3&field=constant", "isosurface", {});
    for (const float value : constant.reference.picture) EXPECT_EQ(value, 1.0F);
}

TEST(Volume, OfAConstantFieldIsTheClosedForm) {
    for (const double extinction : {0.0, 0.5, 3.0, 1e4}) {
        SCOPED_TRACE(extinction);
        const Replay replay =
            field("gen:tetrahedra?n=4&field=constant", "volume", {fmt::format("extinction={}", extinction)});
        const glm::dvec3 colour(traces::colour_of_share(1.0));
        std::size_t inside = 0;
        double worst = 0.0;
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x) {
                const PixelRay ray(replay.frame.view, x, y);
                const Interval cube = ray.in_box(glm::dvec3(-0.5), glm::dvec3(0.5));
                if (std::fabs(cube.leave - cube.enter) < 0.02) continue;
                inside += !cube.empty();
                // Gaps are measured along the view axis, as distances are.
                const double opacity = cube.empty() ? 0.0 : 1.0 - std::exp(-extinction * (cube.leave - cube.enter));
                for (int channel = 0; channel < 3; ++channel) {
                    const double known = opacity * colour[channel] + 1.0 - opacity;
                    const float found =
                        replay.reference.picture[(std::size_t{y} * size + x) * 4 + static_cast<std::size_t>(channel)];
                    worst = std::max(worst, std::fabs(static_cast<double>(found) - known));
                }
            }
        EXPECT_GT(inside, 500U);
        EXPECT_LT(worst, 1e-4);
        RecordProperty(fmt::format("worst_error_at_{}", extinction), fmt::format("{:.3g}", worst));
    }
}

TEST(Volume, OpacityOneHidesWhatIsBehindAndZeroShowsIt) {
    const Replay clear = field("gen:tetrahedra?n=3", "volume", {"extinction=0", "background=[0.25,0.5,0.75]"});
    for (std::size_t i = 0; i < clear.reference.picture.size(); i += 4) {
        EXPECT_EQ(clear.reference.picture[i], 0.25F);
        EXPECT_EQ(clear.reference.picture[i + 2], 0.75F);
    }
    const std::vector<std::string> opaque{"extinction=1e30", "transfer=uniform"};
    const Replay white = field("gen:tetrahedra?n=3", "volume", opaque);
    const Replay black = field("gen:tetrahedra?n=3", "volume", {opaque[0], opaque[1], "background=[0,0,0]"});
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < white.reference.picture.size(); i += 4)
        hidden += white.reference.picture[i] == black.reference.picture[i];
    EXPECT_GT(hidden, 500U);
}

TEST(Fields, OfTetrahedraWithoutVolumeAreNumbers) {
    // Three of four corners on a line, all in a plane, all in one point; and one of some volume.
    traces::TetrahedralMesh mesh;
    mesh.name = "flat";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0},
                      {0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    mesh.scalars = {0, 1, 0.5F, 1, 0, 1, 0, 1, 0.5F};
    mesh.tetrahedra = {{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 6, 7, 8}, {0, 1, 3, 5}};
    traces::Scene scene = traces::scene_of(std::move(mesh));
    scene.name = "flat";
    traces::finish_scene(scene);
    for (const char* workload : {"isosurface", "volume"}) {
        const Replay replay(scene, {.width = size, .height = size, .workload = workload});
        EXPECT_TRUE(is_finite(replay.reference.picture)) << workload;
        EXPECT_TRUE(is_finite(replay.reference.kbuffer)) << workload;
    }
}

TEST(Fields, AnyKGivesNumbersAndEnoughOfThemTheSame) {
    for (const char* workload : {"isosurface", "volume"}) {
        const std::vector<float> most = field("gen:tetrahedra?n=3", workload, {"k=64"}).reference.picture;
        for (const std::uint32_t k : {1U, 2U, 3U, 5U, 8U, 13U, 15U, 16U, 17U, 33U, 63U, 64U}) {
            const Replay replay = field("gen:tetrahedra?n=3", workload, {fmt::format("k={}", k)});
            EXPECT_TRUE(is_finite(replay.reference.picture)) << workload << ' ' << k;
            EXPECT_TRUE(k < 16 || replay.reference.picture == most) << workload << ' ' << k;
        }
    }
}

TEST(Fields, WithoutAScalarAreRefused) {
    for (const char* workload : {"isosurface", "volume", "particles"}) {
        try {
            Replay("gen:csg", {.width = 16, .height = 16, .workload = workload});
            ADD_FAILURE() << workload;
        } catch (const sim::InputError& error) {
            EXPECT_EQ(
                std::string(error.what()),
                fmt::format("workload {}: expected a scalar as the red of vertex colours, as .vtk and .tetm files "
                            "and gen:tetrahedra have, but sphere has no colours",
                            workload));
        }
    }
}

TEST(Particles, AreSpritesOfConstantSize) {
    // Far and near points alike cover size x size pixels.
    traces::PointCloud cloud;
    cloud.name = "points";
    cloud.positions = {{-1.0F, 0.0F, 0.0F}, {0.0F, 0.0F, -8.0F}, {1.0F, 0.0F, 2.0F}};
    cloud.scalars = {0.0F, 0.5F, 1.0F};
    traces::Scene scene = traces::scene_of(std::move(cloud));
    scene.name = "points";
    traces::finish_scene(scene);
    for (const std::uint32_t edge : {4U, 7U}) {
        const Replay replay(scene, {.width = 128,
                                    .height = 96,
                                    .workload = "particles",
                                    .camera = "0,0,6,0,0,0,50",
                                    .knobs = {"method=layers", fmt::format("size={}", edge)}});
        EXPECT_EQ(replay.kbuffer_stream().fragments, 3U * edge * edge) << edge;
    }
}

TEST(Particles, ShowTheIsosurfaceOfTheirScalar) {
    // Points of a dense ball, their scalar the distance from its middle: the surface at 0.5 is seen near the eye.
    const Replay replay("gen:particles?n=60000&waves=0", {.width = size,
                                                          .height = size,
                                                          .workload = "particles",
                                                          .camera = "0,0,5,0,0,0,30",
                                                          .knobs = {"iso=0.5", "size=3", "k=32"}});
    std::size_t hits = 0;
    double sum = 0.0;
    for (std::uint32_t y = 28; y < 36; ++y)
        for (std::uint32_t x = 28; x < 36; ++x) {
            const auto state = state_at(replay, x, y);
            if (state.distance == models::empty_depth) continue;
            ++hits;
            sum += static_cast<double>(state.distance);
        }
    EXPECT_GT(hits, 56U);
    EXPECT_NEAR(sum / static_cast<double>(hits), 4.5, 0.1);
}

} // namespace workload_fields_test
