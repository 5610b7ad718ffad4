// Soft shadows beside ray-traced truth (specification 004, checks S6 and S7, section 6.2 items 5 to 7).
#include "reports/accuracy/accuracy.hpp"
#include "tests/support/replay.hpp"

#include <gtest/gtest.h>

namespace soft_shadows_truth_test {

using reports::AccuracyPoint;
using reports::AccuracyRequest;

AccuracyRequest shadows_of(const std::string& scene, std::uint32_t width, std::uint32_t height, std::uint32_t rays) {
    AccuracyRequest request;
    request.comparison.scene = scene;
    request.comparison.width = width;
    request.comparison.height = height;
    request.comparison.workload = "soft-shadows";
    request.comparison.designs = {"multipass"};
    request.sampling.rays = rays;
    request.use_cache = false;
    return request;
}

AccuracyRequest bumpy_ball() {
    AccuracyRequest request = shadows_of("gen:blob?triangles=8000+ground", 128, 96, 100);
    request.comparison.camera = "2.5,2,3.5,0,-0.3,0,45";
    return request;
}

// F5.3: a small bias leaves acne, a large one moves the shadows away from what throws them.
TEST(SoftShadowsS7, LongUniformBiasTradesAcneForLostContact) {
    AccuracyRequest request = bumpy_ball();
    request.comparison.workload_settings = {"bias=uniform", "map_size=512"};
    request.sweep = {{"uniform_bias", {"0.001", "0.01", "0.1", "0.3"}}};
    const std::vector<AccuracyPoint> points = reports::measure_accuracy(request).points;
    ASSERT_EQ(points.size(), 4U);
    for (std::size_t i = 1; i < points.size(); ++i) {
        EXPECT_LE(points[i].error.acne, points[i - 1].error.acne) << i;
        EXPECT_GE(points[i].error.too_bright, points[i - 1].error.too_bright) << i;
    }
    EXPECT_GT(points.front().error.acne, 0.05);
    EXPECT_LT(points.back().error.acne, 0.001);
    EXPECT_GT(points.back().error.too_bright, 2.0 * points.front().error.too_bright);
}

TEST(SoftShadowsS6, LongMoreLayersBleedLess) {
    AccuracyRequest request = bumpy_ball();
    request.comparison.workload_settings = {"map_size=512"};
    request.sweep = {{"layers", {"1", "3"}}};
    const std::vector<AccuracyPoint> points = reports::measure_accuracy(request).points;
    EXPECT_LT(points[1].error.too_bright, points[0].error.too_bright);
    EXPECT_GE(points[1].error.too_dark, points[0].error.too_dark); // what overlaps on the light counts twice
    for (const AccuracyPoint& point : points) {
        EXPECT_LE(point.error.mean, 0.05);
        EXPECT_EQ(point.wrong_pixels, 0U);
    }
}

TEST(Accuracy, LongHardShadowsOfManyLightsComeNearerInMoreTime) {
    AccuracyRequest request = bumpy_ball();
    request.comparison.workload_settings = {"map_size=256"};
    request.sweep = {{"method", {"hard"}}};
    request.averaged = 16;
    const std::vector<AccuracyPoint> points = reports::measure_accuracy(request).points;
    ASSERT_EQ(points.size(), 3U); // hard, 4, 16
    EXPECT_LT(points[1].error.rmse, points[0].error.rmse);
    EXPECT_LT(points[2].error.rmse, points[1].error.rmse);
    EXPECT_GT(points[2].sim_ms, 3.0 * points[1].sim_ms);
}

TEST(Accuracy, TransparencyNearsTheTruthAsKGrows) {
    AccuracyRequest request;
    request.comparison.scene = "gen:discs?n=60&overlap=6&width=64&height=64";
    request.comparison.width = request.comparison.height = 64;
    request.comparison.designs = {"blender"};
    request.use_cache = false;
    request.sweep = {{"k", {"1", "2", "4", "8", "32"}}};
    const std::vector<AccuracyPoint> points = reports::measure_accuracy(request).points;
    for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LT(points[i].error.rmse, points[i - 1].error.rmse) << i;
    EXPECT_LT(points.back().error.rmse, 2.0 / 255.0);
    EXPECT_TRUE(points.front().pareto);
    EXPECT_TRUE(points.back().pareto);
}

TEST(Accuracy, HazardsAreNotExcused) {
    AccuracyRequest request;
    request.comparison.scene = "gen:stack?n=40";
    request.comparison.width = request.comparison.height = 32;
    request.comparison.designs = {"existing"};
    request.use_cache = false;
    request.sweep = {{"k", {"8"}}};
    const std::vector<AccuracyPoint> points = reports::measure_accuracy(request).points;
    EXPECT_GT(points.front().wrong_pixels, 0U);
}

// Scenes with layers behind layers: plants, a car with panes, a helmet. Scans of closed surfaces have little that a
// second layer could add, and lose a little to overlaps, which the shares tell.
TEST(SoftShadowsS6Long, ErrorOfRealScenesFallsFromOneLayerToThree) {
    struct Case {
        const char* scene;
        bool falls;
    };
    for (const Case& one : {Case{"glass_vase_flowers/GlassVaseFlowers.gltf", true}, Case{"jungle/scene.gltf", true},
                            Case{"car_corvette/car_corvette.gltf", true},
                            Case{"japanese_bridge_garden/japanese_bridge_garden.gltf", true},
                            Case{"stanford_bunny/stanford_bunny.glb", false}}) {
        const std::string path = support::shared_scene(one.scene);
        if (path.empty()) GTEST_SKIP() << one.scene << " is not there";
        AccuracyRequest request = shadows_of(path + "+ground", 320, 240, 1000);
        request.sweep = {{"layers", {"1", "3"}}};
        const std::vector<AccuracyPoint> points = reports::measure_accuracy(request).points;
        EXPECT_LE(points[1].error.mean, 0.05) << one.scene;
        EXPECT_LT(points[1].error.too_bright, points[0].error.too_bright) << one.scene;
        if (one.falls)
            EXPECT_LT(points[1].error.mean, points[0].error.mean) << one.scene;
        else
            EXPECT_GT(points[1].error.too_dark, points[0].error.too_dark) << one.scene;
    }
}

} // namespace soft_shadows_truth_test
