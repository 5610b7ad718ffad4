// Generated solids and fields: closed surfaces that look outward, and the counts that follow from their parameters.
#include "pipeline/functional/vertex_fetch.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/generators.hpp"
#include "traces/scene.hpp"

#include <array>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numbers>

namespace {

using pipeline::Semantic;
using traces::Scene;

/// Six times the volume that the triangles of a draw enclose, counted positive when they look outward.
double enclosed_volume(const Scene& scene, std::size_t draw) {
    const pipeline::Geometry& geometry = scene.resources->geometries[scene.draws[draw].geometry];
    const pipeline::AttributeReader position(*scene.resources, *geometry.find(Semantic::position));
    const pipeline::PrimitiveReader corners(*scene.resources, geometry);
    double volume = 0.0;
    for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i) {
        const auto [a, b, c] = corners(i);
        volume += glm::dot(glm::dvec3(position(a)), glm::cross(glm::dvec3(position(b)), glm::dvec3(position(c)))) / 6.0;
    }
    return volume;
}

TEST(Solids, OfCsgAreASphereAndACubeThatLookOutward) {
    const Scene scene = traces::load_scene("gen:csg?radius=1&half_edge=0.75&segments=256");
    ASSERT_EQ(scene.draws.size(), 2U);
    EXPECT_NEAR(enclosed_volume(scene, 0), 4.0 / 3.0 * std::numbers::pi, 1e-2);
    EXPECT_NEAR(enclosed_volume(scene, 1), 1.5 * 1.5 * 1.5, 1e-5);
    EXPECT_EQ(scene.resources->geometries[1].triangle_count(), 12U);
    EXPECT_EQ(scene.resources->geometries[0].triangle_count(), 256U * 127 * 2);
}

TEST(Solids, OfSlabsHaveTheirThickness) {
    const Scene scene = traces::load_scene("gen:slabs?thickness=[0.5,0.125]&gap=1&side=3");
    ASSERT_EQ(scene.draws.size(), 2U);
    EXPECT_NEAR(enclosed_volume(scene, 0), 9.0 * 0.5, 1e-5);
    EXPECT_NEAR(enclosed_volume(scene, 1), 9.0 * 0.125, 1e-5);
    EXPECT_EQ(scene.hi.z, 0.0F);
    EXPECT_EQ(scene.lo.z, -1.625F);
}

TEST(Solids, PlanesLieAtTheirDistancesFromTheCamera) {
    const Scene scene = traces::load_scene("gen:planes?distances=[2,3,5]&checks=8");
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_EQ(scene.cameras[0].to_world, glm::mat4(1.0F));
    EXPECT_EQ(scene.triangles, 3U * 8 * 8 * 2);
    EXPECT_EQ(scene.hi.z, -2.0F);
    EXPECT_EQ(scene.lo.z, -5.0F);
}

TEST(Solids, TetrahedraFillTheCubeWithFacesBetweenThem) {
    for (const std::uint32_t n : {1U, 3U}) {
        const Scene scene = traces::load_scene("gen:tetrahedra?n=" + std::to_string(n));
        EXPECT_EQ(scene.vertices, (n + 1) * (n + 1) * (n + 1));
        // Each tetrahedron has four faces; those inside count twice, two of each cell face at the border once.
        EXPECT_EQ(2 * scene.triangles, 4U * 6 * n * n * n + 2 * 6 * n * n);
    }
}

TEST(Solids, ParticlesAreAsManyAsAskedAndInTheBall) {
    const Scene scene = traces::load_scene("gen:particles?n=1000");
    EXPECT_EQ(scene.vertices, 1000U);
    EXPECT_LE(scene.radius, 1.8F);
    EXPECT_NE(scene.hash, traces::load_scene("gen:particles?n=1000&seed=2").hash);
    EXPECT_EQ(scene.hash, traces::load_scene("gen:particles?n=1000").hash);
}

TEST(Solids, MistakesAreNamed) {
    EXPECT_EQ(support::load_error("gen:tetrahedra?field=quadratic"),
              "gen:tetrahedra: field: expected one of linear | radial | constant, got \"quadratic\"");
    EXPECT_EQ(support::load_error("gen:planes?distances=[1,2]"), "gen:planes: distances: expected 3 values, got [1,2]");
    EXPECT_NE(support::load_error("gen:slabs?thickness=[0,1]").find("thickness.0: expected number"), std::string::npos);
}

TEST(Showroom, HasAsManyTrianglesOfGlassAsAskedFor) {
    for (const auto& [triangles, glass] :
         {std::pair{59'644U, 20'832U}, {59'644U, 10'434U}, {59'644U, 0U}, {64U, 16U}}) {
        const Scene scene =
            traces::load_scene(fmt::format("gen:showroom?triangles={}&transparent={}", triangles, glass));
        std::uint64_t transparent = 0;
        for (const pipeline::Draw& draw : scene.draws)
            if (scene.resources->materials[draw.material].transparent())
                transparent += scene.resources->geometries[draw.geometry].triangle_count();
        EXPECT_EQ(scene.triangles_drawn, triangles);
        EXPECT_EQ(transparent, glass);
    }
    EXPECT_EQ(support::load_error("gen:showroom?triangles=64&transparent=40"),
              "gen:showroom: transparent: expected 0, or 16 to triangles - 28, got 40 of 64");
}

} // namespace
