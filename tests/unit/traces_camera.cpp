#include "sim/check.hpp"
#include "traces/camera.hpp"

#include <gtest/gtest.h>
#include <numbers>

namespace traces_camera_test {

using traces::Scene;

Scene unit_scene() {
    Scene scene;
    scene.name = "unit";
    scene.lo = glm::vec3(-1.0F);
    scene.hi = glm::vec3(1.0F);
    scene.radius = 1.0F;
    return scene;
}

glm::vec3 projected(const pipeline::View& view, const glm::vec3& point) {
    const glm::vec4 clip = view.projection * view.view * glm::vec4(point, 1.0F);
    return glm::vec3(clip) / clip.w;
}

std::string error_of(const Scene& scene, const std::string& camera, std::uint32_t width = 8, std::uint32_t height = 8) {
    try {
        traces::make_view(scene, camera, width, height);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

TEST(Cameras, AutoSeesTheWholeSphereWithTightPlanes) {
    for (const auto& [width, height] : {std::pair{512U, 512U}, std::pair{300U, 100U}, std::pair{100U, 300U}}) {
        const auto view = traces::make_view(unit_scene(), "auto", width, height);
        float nearest = 1.0F, farthest = -1.0F, widest = 0.0F;
        for (int i = 0; i < 2000; ++i) { // a spiral over the unit sphere
            const float z = -1.0F + 2.0F * static_cast<float>(i) / 1999.0F, angle = 2.4F * static_cast<float>(i);
            const float across = std::sqrt(std::max(0.0F, 1.0F - z * z));
            const glm::vec3 ndc = projected(view, {across * std::cos(angle), across * std::sin(angle), z});
            widest = std::max({widest, std::abs(ndc.x), std::abs(ndc.y)});
            nearest = std::min(nearest, ndc.z);
            farthest = std::max(farthest, ndc.z);
        }
        EXPECT_LE(widest, 1.0001F);
        EXPECT_GT(widest, 0.97F);
        EXPECT_GE(nearest, -1.0F);
        EXPECT_LT(nearest, -0.9F);
        EXPECT_LE(farthest, 1.0F);
        EXPECT_GT(farthest, 0.9F);
    }
}

TEST(Cameras, AutoTakesTheFirstCameraOfTheScene) {
    Scene scene = unit_scene();
    traces::Camera camera;
    camera.fovy = std::numbers::pi_v<float> / 2;
    camera.near = 1.0F;
    camera.far = 3.0F;
    camera.to_world[3] = glm::vec4(0, 0, 2, 1);
    scene.cameras.push_back(camera);
    const auto view = traces::make_view(scene, "auto", 200, 100);
    EXPECT_NEAR(projected(view, {0, 0, 1}).z, -1.0F, 1e-6F);
    EXPECT_NEAR(projected(view, {0, 0, -1}).z, 1.0F, 1e-6F);
    EXPECT_NEAR(projected(view, {0, 1, 1}).y, 1.0F, 1e-6F);
    EXPECT_NEAR(projected(view, {2, 0, 1}).x, 1.0F, 1e-6F); // twice as wide as high
    EXPECT_EQ(view.projection, traces::make_view(scene, "0", 200, 100).projection);
}

TEST(Cameras, InfiniteFarPlaneAndOrthographicCameras) {
    Scene scene = unit_scene();
    traces::Camera camera;
    camera.fovy = 1.0F;
    camera.near = 0.5F;
    scene.cameras.push_back(camera);
    camera.orthographic = true;
    camera.xmag = 9.0F;
    camera.ymag = 2.0F;
    camera.near = 0.0F;
    camera.far = 10.0F;
    scene.cameras.push_back(camera);
    EXPECT_NEAR(projected(traces::make_view(scene, "0", 8, 8), {0, 0, -1e6F}).z, 1.0F, 1e-5F);
    const auto view = traces::make_view(scene, "1", 8, 8);
    EXPECT_EQ(projected(view, {2, 2, -5}), glm::vec3(1, 1, 0));
}

TEST(Cameras, FreeViewEnclosesTheScene) {
    const auto outside = traces::make_view(unit_scene(), "0,0,5,0,0,0,60", 64, 64);
    for (const float z : {-1.0F, 1.0F}) EXPECT_LE(std::abs(projected(outside, {0, 0, z}).z), 1.0F);
    const auto inside = traces::make_view(unit_scene(), "0,0,0,0,0,-1,90", 64, 64);
    EXPECT_LE(std::abs(projected(inside, {0, 0, -1}).z), 1.0F);
    const auto above = traces::make_view(unit_scene(), "0,4,0,0,0,0,45", 64, 64); // straight down
    EXPECT_LE(std::abs(projected(above, {0, 1, 0}).z), 1.0F);
    const auto away = traces::make_view(unit_scene(), "0,0,5,0,0,9,45", 64, 64); // the scene is behind the eye
    EXPECT_TRUE(std::isfinite(away.projection[2][2]));
}

TEST(Cameras, ScreenSpaceMapsPixelsToPixels) {
    Scene scene = unit_scene();
    scene.screen_space = true;
    const auto view = traces::make_view(scene, "auto", 256, 128);
    EXPECT_EQ(projected(view, {0, 0, 0}), glm::vec3(-1, 1, -1));
    EXPECT_EQ(projected(view, {256, 128, 1}), glm::vec3(1, -1, 1));
    EXPECT_EQ(projected(view, {64, 32, 0.5F}), glm::vec3(-0.5F, 0.5F, 0));
    scene.screen_extent = glm::vec2(1.0F);
    EXPECT_EQ(projected(traces::make_view(scene, "auto", 333, 77), {1, 1, 0}), glm::vec3(1, -1, -1));
}

TEST(Cameras, ErrorsNameWhatWasExpected) {
    EXPECT_EQ(error_of(unit_scene(), "0"), "camera '0': expected a number below 0, as many cameras as unit has");
    EXPECT_EQ(error_of(unit_scene(), "front"),
              "camera 'front': expected auto, the number of a camera, ex,ey,ez,tx,ty,tz,fovy, or the 32 numbers of a "
              "view and a projection matrix");
    EXPECT_EQ(
        error_of(unit_scene(), "1,2,3,4,5,6"),
        "camera '1,2,3,4,5,6': expected auto, the number of a camera, ex,ey,ez,tx,ty,tz,fovy, or the 32 numbers of a "
        "view and a projection matrix");
    EXPECT_EQ(error_of(unit_scene(), "1,2,3,4,5,6,nan"), "camera '1,2,3,4,5,6,nan': expected auto, the number of a "
                                                         "camera, ex,ey,ez,tx,ty,tz,fovy, or the 32 numbers of a "
                                                         "view and a projection matrix");
    EXPECT_EQ(error_of(unit_scene(), "1,2,3,1,2,3,45"),
              "camera '1,2,3,1,2,3,45': expected a target that is not the eye");
    EXPECT_EQ(error_of(unit_scene(), "1,2,3,0,0,0,180"),
              "camera '1,2,3,0,0,0,180': fovy: expected more than 0 and less than 180 degrees, got 180");
    EXPECT_EQ(error_of(unit_scene(), "auto", 0, 5), "resolution: expected 1 to 16384 pixels across and down, got 0x5");
    EXPECT_EQ(error_of(unit_scene(), "auto", 5, 16385),
              "resolution: expected 1 to 16384 pixels across and down, got 5x16385");
}

TEST(Cameras, PlanesThatLeaveTheSceneTooFewDepthsAreMovedWithANote) {
    Scene scene = unit_scene();
    traces::Camera camera;
    camera.fovy = 1.0F;
    camera.near = 1e-4F;
    camera.far = 1e10F;
    camera.to_world[3] = glm::vec4(0, 0, 5, 1);
    scene.cameras.push_back(camera);
    std::vector<std::string> notes;
    const auto view = traces::make_view(scene, "auto", 100, 100, &notes);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(notes[0],
              "the camera's near and far planes, 0.0001 and 1e+10, leave the scene 139 depths of 24 bits: they are "
              "moved to 3.99 and 6.01");
    EXPECT_GT(projected(view, {0, 0, -1}).z - projected(view, {0, 0, 1}).z, 1.9F);
    // Just enough, a scene around the eye, and one that lies behind the far plane stay as they are.
    for (const auto& [near, far, z] :
         {std::tuple(0.01F, 100.0F, 5.0F), std::tuple(1e-6F, 0.0F, 0.0F), std::tuple(1e-4F, 2.0F, 9.0F)}) {
        notes.clear();
        scene.cameras[0].near = near;
        scene.cameras[0].far = far;
        scene.cameras[0].to_world[3].z = z;
        traces::make_view(scene, "0", 100, 100, &notes);
        EXPECT_TRUE(notes.empty()) << near << ": " << notes[0];
    }
    scene.cameras[0] = {"", glm::mat4(1.0F), true, 0, 0, 1, 1, 0.0F, 1e8F};
    scene.cameras[0].to_world[3].z = 5.0F;
    traces::make_view(scene, "0", 100, 100, &notes);
    EXPECT_EQ(notes.size(), 1U);
}

TEST(Cameras, TheTextOfAViewLeadsToItAgain) {
    const auto view = traces::make_view(unit_scene(), "0.1,0.2,4,0.3,0,0,33.3", 200, 100);
    const auto again = traces::make_view(unit_scene(), traces::view_text(view), 200, 100);
    EXPECT_EQ(again.view, view.view);
    EXPECT_EQ(again.projection, view.projection);
    std::string zeros = "0";
    for (int i = 1; i < 32; ++i) zeros += ",0";
    EXPECT_EQ(error_of(unit_scene(), zeros),
              "camera: expected 32 numbers that are a view and a projection matrix, column by column");
}

} // namespace traces_camera_test
