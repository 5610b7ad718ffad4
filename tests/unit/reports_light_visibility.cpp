// Visible shares of a square light against closed forms, within the error of stratified sampling.
#include "reports/truth/light_visibility.hpp"

#include "sim/check.hpp"
#include "tests/support/ray_kit.hpp"

#include <array>
#include <gtest/gtest.h>

namespace reports_light_visibility_test {

using reports::SquareLight;
using tests::MeshData;

constexpr double light_height = 4.0, half_edge = 1.0;

class LightVisibility : public support::RayTest {};

SquareLight lamp() { return {{0.0, light_height, 0.0}, {half_edge, 0.0, 0.0}, {0.0, 0.0, half_edge}}; }

/// Four standard deviations where `strata` of the n * n parts are cut by the edge of a shadow: each is then seen or
/// not.
double error_of(std::uint32_t rays, double strata) {
    const double n = reports::light_parts(rays);
    return 4.0 * 0.5 * std::sqrt(strata) / (n * n);
}

// The edge lies along z at height h: a point of the light is seen when the ray to it passes the plane beyond the edge.
TEST_F(LightVisibility, BehindTheEdgeOfAHalfPlane) {
    constexpr double edge = 0.3, height = 1.5;
    MeshData mesh;
    support::add_rectangle(mesh, -40.0, edge, -40.0, 40.0, height);
    const auto scene = support::ray_scene(mesh);
    std::vector<glm::dvec3> points;
    for (double x = -2.0; x <= 3.0; x += 0.05) points.emplace_back(x, 0.0, 0.2);
    for (const std::uint32_t rays : {16U, 256U, 1024U}) {
        const auto seen = reports::light_visibility(*scene, points, lamp(), {.rays = rays});
        std::size_t partly = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double begin = points[i].x + (edge - points[i].x) * light_height / height;
            const double known = std::clamp((half_edge - begin) / (2.0 * half_edge), 0.0, 1.0);
            partly += known > 0.0 && known < 1.0;
            // Shares of neighbouring columns are independent, and the edge cuts one column.
            EXPECT_NEAR(static_cast<double>(seen[i]), known, error_of(rays, reports::light_parts(rays)) + 1e-6)
                << points[i].x << " with " << rays;
        }
        EXPECT_GT(partly, 20U);
    }
}

// From the middle below a disc its image on the light is a disc again, light_height / height times as large.
TEST_F(LightVisibility, BelowADisc) {
    constexpr std::uint32_t corners = 360, rays = 2500;
    constexpr double height = 2.0;
    for (const double radius : {0.1, 0.25, 0.45, 3.0}) {
        const auto scene = support::ray_scene(support::polygon(corners, radius, height));
        const std::array<glm::dvec3, 1> point{glm::dvec3(0.0)};
        const double image = radius * light_height / height;
        const double known = image > 1.5 * half_edge ? 0.0 : 1.0 - support::polygon_area(corners, image) / 4.0;
        const double cut = 4.0 * 2.0 * image * reports::light_parts(rays); // a circle cuts about 8 r / side parts
        EXPECT_NEAR(static_cast<double>(reports::light_visibility(*scene, point, lamp(), {.rays = rays})[0]), known,
                    error_of(rays, cut))
            << radius;
    }
}

// The error falls as stratified sampling's does, and the estimate is not biased.
TEST_F(LightVisibility, IsUnbiasedOverSeeds) {
    MeshData mesh;
    support::add_rectangle(mesh, -40.0, 0.1, -40.0, 40.0, 2.0);
    const auto scene = support::ray_scene(mesh);
    const std::array<glm::dvec3, 1> point{glm::dvec3(0.0)};
    double sum = 0.0;
    constexpr int seeds = 400;
    for (int seed = 0; seed < seeds; ++seed)
        sum += static_cast<double>(reports::light_visibility(
            *scene, point, lamp(), {.rays = 16, .seed = static_cast<std::uint64_t>(seed)})[0]);
    EXPECT_NEAR(sum / seeds, 0.4, error_of(16, 4) / std::sqrt(seeds));
}

TEST_F(LightVisibility, AScaleOrAPlaceInTheWorldChangesNothing) {
    const auto shares = [](double scale, const glm::dvec3& at) {
        MeshData mesh;
        support::add_rectangle(mesh, at.x - 5.0 * scale, at.x + 0.3 * scale, at.z - 5.0 * scale, at.z + 5.0 * scale,
                               at.y + 1.5 * scale);
        support::add_rectangle(mesh, at.x - 5.0 * scale, at.x + 5.0 * scale, at.z - 5.0 * scale, at.z + 5.0 * scale,
                               at.y);
        const auto scene = support::ray_scene(mesh);
        std::vector<glm::dvec3> points;
        for (double x = -0.5; x < 3.0; x += 0.1) points.push_back(at + scale * glm::dvec3(x, 0.0, 0.1));
        SquareLight light = lamp();
        light = {at + scale * light.centre, scale * light.u, scale * light.v};
        return reports::light_visibility(*scene, points, light, {.rays = 100});
    };
    const auto usual = shares(1.0, glm::dvec3(0.0));
    for (const double scale : {0x1p-30, 0x1p-8, 0x1p20}) EXPECT_EQ(shares(scale, glm::dvec3(0.0)), usual) << scale;
    const auto far = shares(1.0, glm::dvec3(1024.0, -512.0, 2048.0));
    for (std::size_t i = 0; i < usual.size(); ++i) EXPECT_NEAR(far[i], usual[i], 0.02F);
}

TEST_F(LightVisibility, NothingShadowsItself) {
    MeshData mesh;
    support::add_rectangle(mesh, -30.0, 30.0, -30.0, 30.0, 0.0);
    const auto scene = support::ray_scene(mesh);
    std::vector<glm::dvec3> points;
    for (double x = -29.0; x < 29.0; x += 0.7) // down to a light that is 8 degrees above the horizon
        for (const double error : {-1e-7, 0.0, 1e-7}) points.emplace_back(x, error, 0.37 * x);
    for (const float share : reports::light_visibility(*scene, points, lamp(), {.rays = 64})) EXPECT_EQ(share, 1.0F);
}

TEST_F(LightVisibility, ALampDrawnWhereTheLightIsHidesNothing) {
    MeshData mesh;
    support::add_rectangle(mesh, -1.0, 1.0, -1.0, 1.0, light_height);
    support::add_rectangle(mesh, -5.0, 5.0, -5.0, 5.0, 0.0);
    const std::array<glm::dvec3, 2> points{glm::dvec3(0.0), glm::dvec3(3.0, 0.0, 1.0)};
    for (const float share : reports::light_visibility(*support::ray_scene(mesh), points, lamp(), {.rays = 100}))
        EXPECT_EQ(share, 1.0F);
}

// The left half of the texture is clear, the right one stands.
TEST_F(LightVisibility, AlphaTestsAreHonoured) {
    tests::FunctionalScene scene(16, 16);
    pipeline::Texture texture = tests::texture_of(2, 1, {0xFFFFFF00U, 0xFFFFFFFFU});
    texture.mag_filter = texture.min_filter = pipeline::Filter::nearest;
    pipeline::Material material;
    material.base_texture = static_cast<std::int32_t>(scene.add_texture(texture));
    material.alpha_mode = pipeline::AlphaMode::mask;
    MeshData mesh;
    support::add_rectangle(mesh, -2.0, 2.0, -2.0, 2.0, 2.0);
    mesh.texcoords = {{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}};
    scene.add(mesh, scene.add_material(material));
    const std::array<glm::dvec3, 3> points{glm::dvec3(-3.0, 0.0, 0.0), glm::dvec3(0.0), glm::dvec3(3.0, 0.0, 0.0)};
    const auto seen = reports::light_visibility(*support::ray_scene(std::move(scene)), points, lamp(), {.rays = 1024});
    EXPECT_EQ(seen[0], 1.0F); // its rays pass the left half
    EXPECT_NEAR(seen[1], 0.5F, 0.01F);
    EXPECT_EQ(seen[2], 0.0F);
}

TEST_F(LightVisibility, PortionsAndThreadsDoNotMatter) {
    const auto scene = support::ray_scene(support::polygon(7, 0.5, 2.0));
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 300; ++i) points.emplace_back(0.01 * i - 1.5, 0.0, 0.003 * i);
    const auto whole = reports::light_visibility(*scene, points, lamp(), {.rays = 25, .seed = 7}, {.threads = 1});
    EXPECT_EQ(reports::light_visibility(*scene, points, lamp(), {.rays = 25, .seed = 7}, {.threads = 4}), whole);
    const std::span<const glm::dvec3> rest = std::span(points).subspan(100);
    EXPECT_EQ(reports::light_visibility(*scene, rest, lamp(), {.rays = 25, .seed = 7, .first_point = 100}),
              std::vector<float>(whole.begin() + 100, whole.end()));
    EXPECT_NE(reports::light_visibility(*scene, points, lamp(), {.rays = 25, .seed = 8}), whole);
}

TEST_F(LightVisibility, StopsAndTellsHowFarItIs) {
    const auto scene = support::ray_scene(support::polygon(7, 0.5, 2.0));
    const std::vector<glm::dvec3> points(1000, glm::dvec3(0.0));
    std::vector<double> shares;
    reports::light_visibility(*scene, points, lamp(), {.rays = 4},
                              {.progress = [&](double share) { shares.push_back(share); }});
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1.0);
    const std::atomic<bool> stop{true};
    EXPECT_THROW(reports::light_visibility(*scene, points, lamp(), {}, {.stop = &stop}), sim::Interrupted);
}

TEST_F(LightVisibility, PointsInTheLightOrFarAwayAreNumbers) {
    const auto scene = support::ray_scene(support::polygon(7, 0.5, 2.0));
    const std::array<glm::dvec3, 3> points{glm::dvec3(0.0, light_height, 0.0), glm::dvec3(1e30, 0.0, 0.0),
                                           glm::dvec3(0.0, 1e300, 0.0)};
    for (const float share : reports::light_visibility(*scene, points, lamp(), {.rays = 9}))
        EXPECT_TRUE(share >= 0.0F && share <= 1.0F);
}

TEST_F(LightVisibility, RaysComeAsSquares) {
    EXPECT_EQ(reports::light_parts(1), 1U);
    EXPECT_EQ(reports::light_parts(1000), 32U);
    EXPECT_EQ(reports::light_parts(1024), 32U);
    EXPECT_EQ(reports::light_parts(30), 5U);
}

} // namespace reports_light_visibility_test
