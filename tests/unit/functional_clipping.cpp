// Clipping and culling, and what may reach the rasterizer at all.
#include "pipeline/functional/clip.hpp"
#include "pipeline/functional/cull_and_clip.hpp"
#include "pipeline/functional/raster_triangle.hpp"
#include "sim/random.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck/gtest.h>

namespace pipeline {
namespace {

using tests::FunctionalScene;
using tests::MeshData;

/// What becomes of one triangle given in pixels and window depth, on a screen of 64x64.
FragmentStream one_triangle(const std::array<glm::vec3, 3>& corners, bool double_sided = true,
                            const glm::mat4& model = glm::mat4(1.0F)) {
    FunctionalScene scene(64, 64);
    scene.resources.materials[0].double_sided = double_sided;
    MeshData mesh;
    mesh.positions.assign(corners.begin(), corners.end());
    scene.add(mesh, 0, model);
    return scene.rasterize();
}

PrimitiveFate fate(const FragmentStream& stream) { return stream.primitives.at(0).fate; }

void expect_finite(const FragmentStream& stream) {
    for (const auto& depths : stream.depths)
        for (const float depth : depths) EXPECT_TRUE(depth >= 0.0F && depth <= 1.0F);
    for (const auto& colours : stream.colours)
        for (const glm::vec4& colour : colours)
            for (int i = 0; i < 4; ++i) EXPECT_TRUE(std::isfinite(colour[i]));
}

TEST(Culling, FatesOfSimplePrimitives) {
    EXPECT_EQ(fate(one_triangle({{{1, 1, 0.5F}, {20, 1, 0.5F}, {1, 20, 0.5F}}})), PrimitiveFate::drawn);
    EXPECT_EQ(fate(one_triangle({{{1, 1, 0.5F}, {20, 20, 0.5F}, {40, 40, 0.5F}}})), PrimitiveFate::culled_degenerate);
    EXPECT_EQ(fate(one_triangle({{{1, 1, 0.5F}, {1, 1, 0.5F}, {1, 20, 0.5F}}})), PrimitiveFate::culled_degenerate);
    EXPECT_EQ(fate(one_triangle({{{70, 1, 0.5F}, {80, 1, 0.5F}, {70, 20, 0.5F}}})), PrimitiveFate::culled_outside);
    EXPECT_EQ(fate(one_triangle({{{1, 1, -1}, {20, 1, -0.5F}, {1, 20, -2}}})), PrimitiveFate::culled_outside);
    EXPECT_EQ(fate(one_triangle({{{1, 1, 2}, {20, 1, 2}, {1, 20, 2}}})), PrimitiveFate::culled_outside);
    // Outside of the corner, but not of any one plane: it reaches the rasterizer and covers nothing.
    const FragmentStream corner = one_triangle({{{60, -30, 0.5F}, {94, 4, 0.5F}, {94, -30, 0.5F}}});
    EXPECT_EQ(fate(corner), PrimitiveFate::drawn);
    EXPECT_EQ(corner.fragments, 0U);
    EXPECT_EQ(corner.triangles.at(0).tiles, 1U);
}

TEST(Culling, ClockwiseTrianglesAreBackFaces) {
    const std::array<glm::vec3, 3> clockwise{{{1, 1, 0.5F}, {20, 1, 0.5F}, {1, 20, 0.5F}}};
    const std::array<glm::vec3, 3> counter_clockwise{{{1, 1, 0.5F}, {1, 20, 0.5F}, {20, 1, 0.5F}}};
    EXPECT_EQ(fate(one_triangle(clockwise, false)), PrimitiveFate::culled_facing);
    EXPECT_EQ(fate(one_triangle(counter_clockwise, false)), PrimitiveFate::drawn);
    EXPECT_EQ(fate(one_triangle(clockwise, true)), PrimitiveFate::drawn);
}

TEST(Culling, AMirroringModelMatrixTurnsTheWindingRound) {
    glm::mat4 mirrored(1.0F); // x -> 40 - x
    mirrored[0][0] = -1.0F;
    mirrored[3][0] = 40.0F;
    const std::array<glm::vec3, 3> front{{{1.2F, 1, 0.5F}, {1.2F, 20.3F, 0.5F}, {20.2F, 1, 0.5F}}};
    const std::array<glm::vec3, 3> back{front[0], front[2], front[1]};
    EXPECT_EQ(fate(one_triangle(front, false, mirrored)), PrimitiveFate::drawn);
    EXPECT_EQ(fate(one_triangle(back, false, mirrored)), PrimitiveFate::culled_facing);
    EXPECT_EQ(one_triangle(front, false, mirrored).fragments, one_triangle(front, false).fragments);
}

TEST(Culling, NotFiniteVerticesNeverLeaveTheStage) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN(), 3e38F}) {
        const FragmentStream stream = one_triangle({{{1, 1, 0.5F}, {bad, 1, 0.5F}, {1, 20, bad}}});
        EXPECT_EQ(stream.quads.size(), 0U);
        EXPECT_NE(fate(stream), PrimitiveFate::drawn);
    }
    EXPECT_EQ(fate(one_triangle({{{1, 1, 0.5F}, {infinity, 1, 0.5F}, {1, 20, 0.5F}}})),
              PrimitiveFate::culled_degenerate);
}

TEST(Clipping, DepthIsExactlyZeroAndOneAtTheCuts) {
    // Depth runs from -1 to 2 over the height of the picture.
    FunctionalScene scene(64, 192);
    MeshData mesh = tests::rectangle(0, 0, 64, 192);
    mesh.positions[0].z = mesh.positions[1].z = -1.0F;
    mesh.positions[2].z = mesh.positions[3].z = 2.0F;
    scene.add(mesh);
    const FragmentStream stream = scene.rasterize();
    expect_finite(stream);
    EXPECT_EQ(stream.fragments, 64U * 64U);
    for (const std::uint32_t count : tests::coverage_counts(stream)) EXPECT_LE(count, 1U);
    for (const Primitive& primitive : stream.primitives) EXPECT_TRUE(primitive.clipped);
}

TEST(Clipping, PlanesAtDepthZeroAndOneAreInside) {
    for (const float depth : {0.0F, 1.0F}) {
        FunctionalScene scene(16, 16);
        scene.add(tests::rectangle(0, 0, 16, 16, depth));
        const FragmentStream stream = scene.rasterize();
        EXPECT_EQ(stream.fragments, 256U);
        for (const auto& depths : stream.depths)
            for (const float value : depths) EXPECT_EQ(value, depth);
    }
}

/// A camera at the origin that looks along -z.
FunctionalScene perspective_scene(std::uint32_t width, std::uint32_t height) {
    FunctionalScene scene(width, height);
    scene.view.projection =
        glm::perspective(glm::radians(60.0F), static_cast<float>(width) / static_cast<float>(height), 0.1F, 1000.0F);
    return scene;
}

/// The plane y = -1 as a mesh of n x n cells around the eye, behind it as well.
MeshData ground(float reach, std::uint32_t n) {
    MeshData mesh;
    for (std::uint32_t row = 0; row <= n; ++row)
        for (std::uint32_t column = 0; column <= n; ++column)
            mesh.positions.emplace_back(reach * (2.0F * static_cast<float>(column) / static_cast<float>(n) - 1.0F),
                                        -1.0F, reach * (2.0F * static_cast<float>(row) / static_cast<float>(n) - 1.0F));
    for (std::uint32_t row = 0; row < n; ++row)
        for (std::uint32_t column = 0; column < n; ++column) {
            const std::uint32_t a = row * (n + 1) + column, c = a + n + 1;
            for (const std::uint32_t index : {a, c, a + 1, a + 1, c, c + 1}) mesh.indices.push_back(index);
        }
    return mesh;
}

TEST(Clipping, TrianglesThroughTheEyePlaneStayWatertight) {
    // Farther out, single-precision clip coordinates no longer tell where the near plane cuts.
    for (const float reach : {3.0F, 300.0F, 1e8F})
        for (const std::uint32_t n : {1U, 2U, 7U, 16U}) {
            FunctionalScene scene = perspective_scene(160, 120);
            scene.add(ground(reach, n));
            const FragmentStream stream = scene.rasterize();
            expect_finite(stream);
            const std::vector<std::uint32_t> counts = tests::coverage_counts(stream);
            const float slope = std::tan(glm::radians(30.0F)) / 60.0F; // per pixel row
            for (std::uint32_t y = 0; y < 120; ++y) {
                // Distance at which the pixel's ray meets the ground.
                const float down = (static_cast<float>(y) + 0.5F - 60.0F) * slope;
                const float distance = 1.0F / down;
                const bool certain =
                    reach < 1e3F && down > 0.0F && distance > 0.11F && distance < std::min(reach / 1.5F, 990.0F);
                const bool sky = down < 0.0F;
                for (std::uint32_t x = 0; x < 160; ++x) {
                    const std::uint32_t count = counts[y * 160 + x];
                    EXPECT_LE(count, 1U);
                    EXPECT_TRUE(!certain || count == 1U) << "reach " << reach << " n " << n << " x " << x << " y " << y;
                    EXPECT_TRUE(!sky || count == 0U);
                }
            }
        }
}

TEST(Clipping, HugeCoordinatesInParallelProjectionFillTheScreenOnce) {
    for (const float reach : {1e5F, 1e12F, 1e30F}) {
        FunctionalScene scene(64, 64);
        scene.add(tests::rectangle(-reach, -reach, reach, reach));
        const FragmentStream stream = scene.rasterize();
        expect_finite(stream);
        EXPECT_EQ(stream.fragments, 64U * 64U) << reach;
        for (const std::uint32_t count : tests::coverage_counts(stream)) EXPECT_EQ(count, 1U);
    }
}

TEST(Clipping, TinyMeshesUnderAMatchingMatrixAreOrdinary) {
    FunctionalScene scene(64, 64);
    scene.add(tests::rectangle(0, 0, 6.4e-29F, 6.4e-29F), 0,
              glm::scale(glm::mat4(1.0F), glm::vec3(1e30F, 1e30F, 1.0F)));
    EXPECT_EQ(scene.rasterize().fragments, 64U * 64U);
}

TEST(Clipping, SmallestNumbersCoverNothingAndHarmNothing) {
    FunctionalScene scene = perspective_scene(64, 64);
    scene.add(tests::rectangle(0, 0, 1e-30F, 1e-30F, -1.0F));
    scene.add(tests::rectangle(0, 0, 1e-45F, 1e-45F, -1.0F));
    const FragmentStream stream = scene.rasterize();
    EXPECT_EQ(stream.fragments, 0U);
    for (const Primitive& primitive : stream.primitives) EXPECT_EQ(primitive.fate, PrimitiveFate::culled_degenerate);
}

TEST(Clipping, WNearZeroGivesFiniteResults) {
    // A projection with its near plane in the eye: w comes as close to 0 as the vertices do.
    for (const float w : {0.0F, 1e-40F, 1e-30F, 1e-20F, 1e-6F}) {
        FunctionalScene scene(64, 64);
        scene.view.projection = glm::mat4(0.0F);
        scene.view.projection[0][0] = scene.view.projection[1][1] = 1.0F;
        scene.view.projection[2][3] = -1.0F; // w = -z, z = 0
        MeshData mesh;
        mesh.positions = {{-1, -1, -w}, {1, -1, -1}, {0, 1, -1}};
        mesh.colours = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
        scene.add(mesh);
        expect_finite(scene.rasterize());
    }
}

RC_GTEST_PROP(Clipping, WhateverComesInCornersStayInTheGuardBand, (std::uint64_t seed)) {
    sim::Random random(seed, "clip");
    const Viewport viewport(static_cast<std::uint32_t>(1 + random.below(16384)),
                            static_cast<std::uint32_t>(1 + random.below(16384)));
    const auto number = [&] {
        const double magnitude = std::exp2(random.uniform() * 240.0 - 120.0);
        return static_cast<float>(random.below(8) == 0 ? 0.0 : (random.below(2) == 0 ? -magnitude : magnitude));
    };
    for (int repeat = 0; repeat < 50; ++repeat) {
        std::array<ScreenVertex, 3> vertices;
        for (ScreenVertex& vertex : vertices) {
            const float scale = random.below(2) == 0 ? 1.0F : number();
            for (int i = 0; i < 4; ++i)
                vertex.clip[i] =
                    random.below(2) == 0 ? number() : scale * static_cast<float>(random.uniform() * 4.0 - 2.0);
            if (!std::isfinite(glm::length(glm::dvec4(vertex.clip)))) vertex.clip = glm::vec4(1.0F);
            vertex.outside = viewport.outcode(vertex.clip);
            if ((vertex.outside & (outside::must_clip | outside::not_finite)) == 0) viewport.project(vertex);
        }
        PrimitiveParts parts;
        cull_and_clip(viewport, Culling::none, {.vertices = {&vertices[0], &vertices[1], &vertices[2]}}, parts);
        for (std::uint32_t i = 0; i < parts.count; ++i) {
            const PrimitivePart& part = parts.parts[i];
            for (const ScreenVertex& corner : part.corners) {
                RC_ASSERT(std::abs(corner.x) <= largest_coordinate && std::abs(corner.y) <= largest_coordinate);
                RC_ASSERT(corner.depth >= 0.0F && corner.depth <= 1.0F);
                RC_ASSERT(std::isfinite(corner.window.x) && std::isfinite(corner.window.y));
            }
            RC_ASSERT(signed_area(part.corners[0], part.corners[1], part.corners[2]) != 0);
            if (!parts.clipped) continue;
            for (const glm::vec3& weights : part.weights)
                RC_ASSERT(std::fabs(weights.x + weights.y + weights.z - 1.0F) < 1e-4F);
        }
    }
}

TEST(Clipping, ATriangleBecomesAtMostSevenParts) {
    // Larger than the guard band in x and y, and through the near and far planes.
    FunctionalScene scene(64, 64);
    MeshData mesh;
    mesh.positions = {{-60000, -50000, -1.0F}, {90000, -20000, 2.5F}, {-10000, 90000, 0.5F}};
    scene.add(mesh);
    const FragmentStream stream = scene.rasterize();
    EXPECT_LE(stream.primitives[0].triangles, 7U);
    EXPECT_EQ(stream.primitives[0].triangles, stream.triangles.size());
    for (const std::uint32_t count : tests::coverage_counts(stream)) EXPECT_LE(count, 1U);
}

} // namespace
} // namespace pipeline
