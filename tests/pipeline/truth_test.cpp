// Rasterized frames in submission order beside their ray-traced truth (specification 004, section 10.4): two ways to
// the same fragments that share neither rasterizer nor sorting.
#include "reports/truth/against_truth.hpp"
#include "reports/truth/frame_surfaces.hpp"
#include "sim/check.hpp"
#include "tests/support/box_ray.hpp"
#include "tests/support/ray_kit.hpp"
#include "tests/support/replay.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace truth_test {

using reports::Truth;
using reports::TruthError;
using support::Replay;
using support::ReplayOptions;

class TruthTest : public support::RayTest {};

struct Traced {
    traces::TruthMethod method;
    Truth truth;
};

traces::TruthMethod method_of(const Replay& replay) {
    return traces::truth_method(replay.scene, replay.frame, replay.options.workload,
                                traces::WorkloadOptions::of(replay.options.knobs));
}

Traced traced(const Replay& replay) {
    const reports::RayScene scene(replay.frame.resources, replay.frame.draws);
    traces::TruthMethod method = method_of(replay);
    Truth truth = reports::trace_truth(replay.frame, scene, method);
    return {std::move(method), std::move(truth)};
}

Truth truth_of(const Replay& replay) { return traced(replay).truth; }

std::vector<TruthError> errors_of(const Replay& replay) {
    const Traced beside = traced(replay);
    return reports::errors_of_reference(beside.truth, beside.method, replay.frame, replay.reference);
}

std::string text_of(const TruthError& error) {
    return fmt::format("{}: {} of {} pixels wrong, {} doubtful, {} over k, worst {:.3g}", error.what, error.wrong,
                       error.compared, error.doubtful, error.overflown, error.worst);
}

/// Every layer and the picture; at least `pixels` pixels are compared in the picture. Exclusions stay exceptions.
void expect_truth(const Replay& replay, std::uint64_t pixels, double most_doubtful = 0.05) {
    const auto errors = errors_of(replay);
    ASSERT_FALSE(errors.empty());
    for (const TruthError& error : errors) {
        // Of few pixels a thousandth is less than what one silhouette brings.
        EXPECT_TRUE(error.holds() || error.wrong <= 8) << text_of(error);
        EXPECT_LE(static_cast<double>(error.doubtful), 20.0 + most_doubtful * static_cast<double>(error.compared))
            << text_of(error);
        testing::Test::RecordProperty(error.what, text_of(error));
    }
    EXPECT_GE(errors.back().compared, pixels) << text_of(errors.back());
    EXPECT_EQ(errors.back().overflown, 0U) << "k is below the depth complexity";
}

Replay transparent(const std::string& scene, std::uint32_t size, std::vector<std::string> knobs = {"k=64"}) {
    return Replay(scene, {.width = size, .height = size, .knobs = std::move(knobs)});
}

TEST_F(TruthTest, BlobEqualsItsFrame) { expect_truth(transparent("gen:blob?triangles=20000", 256), 20000); }
TEST_F(TruthTest, SlabsEqualTheirFrame) { expect_truth(transparent("gen:slabs", 256, {"k=4"}), 20000); }
TEST_F(TruthTest, StackEqualsItsFrame) { expect_truth(transparent("gen:stack", 64), 4); }
TEST_F(TruthTest, DiscsEqualTheirFrame) { expect_truth(transparent("gen:discs", 128), 10000, 0.1); }
TEST_F(TruthTest, GrassEqualsItsFrame) { expect_truth(transparent("gen:grass?blades=100", 512), 20000); }

TEST_F(TruthTest, OneSidedMaterialsLoseTheirBacks) {
    const Replay both = transparent("gen:blob?triangles=5000", 128, {"k=16"});
    const Replay fronts = transparent("gen:blob?triangles=5000", 128, {"k=16", "faces=material"});
    expect_truth(fronts, 2000);
    const auto surfaces = [](const Replay& replay) { return truth_of(replay).counts.surfaces; };
    EXPECT_EQ(surfaces(both) % 2, 0U);
    EXPECT_LE(surfaces(fronts), surfaces(both));
}

TEST_F(TruthTest, OpaqueFrameIsTheNearestSurface) {
    expect_truth(Replay("gen:csg", {.width = 192, .height = 192, .workload = "opaque"}), 5000);
}

TEST_F(TruthTest, SolidsAreWhereTheFrameHasThem) {
    for (const char* expression : {"A & B", "A & !B", "A ^ B", "B - A"}) {
        SCOPED_TRACE(expression);
        const Replay replay(
            "gen:csg",
            {.width = 192, .height = 192, .workload = "csg", .knobs = {fmt::format("expression={}", expression)}});
        const Traced beside = traced(replay);
        const auto error = reports::distance_error(beside.truth, beside.method, replay.frame, replay.reference);
        EXPECT_TRUE(error.holds()) << text_of(error);
        EXPECT_GT(error.compared, 1000U);
    }
}

// The sphere alone, and where the cube cuts it: closed forms.
TEST_F(TruthTest, SolidsAreWhereIntervalLogicHasThem) {
    const Replay replay("gen:csg?segments=512",
                        {.width = 96, .height = 96, .workload = "csg", .knobs = {"expression=A & B"}});
    const Truth truth = truth_of(replay);
    std::size_t compared = 0;
    for (std::uint32_t y = 0; y < 96; ++y)
        for (std::uint32_t x = 0; x < 96; ++x) {
            const support::PixelRay ray(replay.frame.view, x, y);
            const auto sphere = ray.in_sphere(1.0);
            const auto cube = ray.in_box(glm::dvec3(-0.1, -0.2, -0.1), glm::dvec3(1.1, 1.0, 1.1));
            const double enter = std::max(sphere.enter, cube.enter), leave = std::min(sphere.leave, cube.leave);
            if (std::fabs(leave - enter) < 0.03) continue;
            const std::size_t pixel = std::size_t{y} * 96 + x;
            const bool inside = !sphere.empty() && !cube.empty() && enter < leave;
            ASSERT_EQ(truth.channels[0].has(pixel), inside) << x << ' ' << y;
            if (!inside) continue;
            EXPECT_NEAR(static_cast<double>(truth.channels[0].values[pixel]), enter, 1e-4 * enter) << x << ' ' << y;
            ++compared;
        }
    EXPECT_GT(compared, 500U);
}

TEST_F(TruthTest, LengthsInsideParallelSlabsAreThoseOfTheirRays) {
    const Replay replay("gen:slabs", {.width = 96,
                                      .height = 96,
                                      .workload = "translucency",
                                      .camera = "0.7,0.5,5,0,0,-0.6,25",
                                      .knobs = {"sigma=[2,0.25]"}});
    const Truth truth = truth_of(replay);
    std::size_t compared = 0;
    for (std::uint32_t y = 0; y < 96; ++y)
        for (std::uint32_t x = 0; x < 96; ++x) {
            const support::PixelRay ray(replay.frame.view, x, y);
            const auto a = ray.in_box({-1.0, -1.0, -0.5}, {1.0, 1.0, 0.0});
            const auto b = ray.in_box({-1.0, -1.0, -1.25}, {1.0, 1.0, -1.0});
            const auto length = [&](support::Interval i) {
                return i.empty() ? 0.0 : (i.leave - i.enter) * ray.stretch();
            };
            if (std::fabs(a.leave - a.enter) < 0.01 || std::fabs(b.leave - b.enter) < 0.01) continue;
            const std::size_t pixel = std::size_t{y} * 96 + x;
            const double known = length(a) + length(b);
            EXPECT_NEAR(static_cast<double>(truth.channels[0].values[pixel]), known, 1e-4 * known) << x << ' ' << y;
            EXPECT_NEAR(static_cast<double>(truth.colours[4 * pixel]), std::exp(-2.0 * length(a) - 0.25 * length(b)),
                        1e-5);
            compared += known > 0.0;
        }
    EXPECT_GT(compared, 3000U);
    expect_truth(replay, 5000);
}

TEST_F(TruthTest, TranslucentBlobWithFresnelEqualsItsFrame) {
    expect_truth(Replay("gen:blob?triangles=20000",
                        {.width = 192, .height = 192, .workload = "translucency", .knobs = {"k=16", "fresnel=true"}}),
                 5000);
}

TEST_F(TruthTest, EveryNumberOfThreadsGivesTheSameBytes) {
    const Replay replay = transparent("gen:blob?triangles=5000", 96);
    const reports::RayScene scene(replay.frame.resources, replay.frame.draws);
    const auto run = [&](unsigned threads) {
        reports::TruthPlan plan;
        plan.light = {{0.0, 5.0, 0.0}, {0.5, 0.0, 0.0}, {0.0, 0.0, 0.5}};
        plan.sampling.rays = 16;
        return reports::trace_truth(replay.frame, scene, method_of(replay), plan, {.threads = threads});
    };
    const Truth one = run(1);
    for (const unsigned threads : {2U, 5U}) {
        const Truth many = run(threads);
        EXPECT_EQ(many.colours, one.colours);
        EXPECT_EQ(many.depths, one.depths);
        EXPECT_EQ(many.surfaces, one.surfaces);
        EXPECT_EQ(many.visibility, one.visibility);
        EXPECT_EQ(many.marks, one.marks);
    }
    EXPECT_GT(one.counts.pixels_lit, 100U);
    EXPECT_LT(*std::min_element(one.visibility.begin(), one.visibility.end()), 0.1F);
}

// The rules must be able to fail.
TEST_F(TruthTest, WrongLayersAndColoursAreFound) {
    Replay replay = transparent("gen:slabs", 128, {"k=4"});
    const Traced beside = traced(replay);
    for (float& value : replay.reference.kbuffer)
        if (value < 1.0F) value *= 0.999F; // depths among them
    for (std::size_t i = 0; i < replay.reference.picture.size(); ++i) replay.reference.picture[i] += 0.01F;
    for (const TruthError& error :
         reports::errors_of_reference(beside.truth, beside.method, replay.frame, replay.reference))
        EXPECT_FALSE(error.holds()) << text_of(error);
}

TEST_F(TruthTest, PixelsOverKAreLeftOutOfTheColours) {
    const Replay replay = transparent("gen:slabs", 128, {"k=2"});
    const auto error = reports::colour_error(truth_of(replay), replay.frame, replay.reference.picture);
    EXPECT_GT(error.overflown, 1000U);
    EXPECT_GT(error.compared, 500U);
    EXPECT_TRUE(error.holds()) << text_of(error);
}

TEST_F(TruthTest, WorkloadsWithoutATruthAreRefused) {
    const auto message = [](const std::string& scene, const ReplayOptions& options) -> std::string {
        try {
            method_of(Replay(scene, options));
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(
        message("gen:slabs", {.workload = "blended"}),
        "truth: expected a workload of transparency, opaque, translucency, csg, soft-shadows, deferred, got blended");
    EXPECT_EQ(message("gen:slabs", {.knobs = {"entry=z"}}),
              "truth: workload transparency: entry: expected rgbz, the one that has colours");
    EXPECT_EQ(message("gen:slabs", {}), "");
}

struct SharedScene {
    std::string file;
    std::vector<std::string> knobs;
};

// Textures, alpha tests, mirrored and repeated nodes, opaque surfaces behind transparent ones.
TEST_F(TruthTest, LongSharedScenesEqualTheirFrames) {
    const std::vector<SharedScene> scenes{
        {"suzanne/Suzanne.gltf", {"k=32"}},
        {"stanford_bunny/stanford_bunny.glb", {"k=32"}},
        {"test_negative_scale/NegativeScaleTest.glb", {"k=16", "faces=material"}},
        {"simple_instancing/SimpleInstancing.glb", {"k=64"}},
        {"glass_vase_flowers/GlassVaseFlowers.gltf", {"k=64", "transparent=materials"}},
        {"alpha_blend_mode_test/AlphaBlendModeTest.glb", {"k=16"}},
    };
    std::size_t compared = 0;
    for (const SharedScene& scene : scenes) {
        const std::string file = support::shared_scene(scene.file);
        if (file.empty()) continue;
        SCOPED_TRACE(scene.file);
        const Replay replay(file, {.width = 512, .height = 512, .knobs = scene.knobs});
        expect_truth(replay, 1000, 0.2);
        ++compared;
    }
    if (compared == 0) GTEST_SKIP() << "no further scenes here: set ROPSIM_SHARED_DIR";
}

} // namespace truth_test
