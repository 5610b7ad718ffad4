// The depth range of a state: which window depths the near and the far plane have.
#include "sim/check.hpp"
#include "tests/support/functional_scene.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

namespace depth_range_test {
namespace {

using namespace pipeline;
using tests::FunctionalScene;
using tests::MeshData;

RasterState ranged(float at_near, float at_far) {
    RasterState state;
    state.depth.range_near = at_near;
    state.depth.range_far = at_far;
    return state;
}

/// A rectangle over the whole picture whose depth runs from one to the other, from the first row to the last; 0 is the
/// near plane.
FragmentStream sloped(const RasterState& state, float first, float last) {
    FunctionalScene scene(64, 192);
    MeshData mesh = tests::rectangle(0, 0, 64, 192);
    mesh.positions[0].z = mesh.positions[1].z = first;
    mesh.positions[2].z = mesh.positions[3].z = last;
    scene.add(mesh);
    FrontEndOptions options;
    options.states = {&state, 1};
    return scene.rasterize(options);
}

TEST(DepthRange, RunsFromTheNearPlaneToTheFarOne) {
    for (const auto& [at_near, at_far] : {std::pair(0.0F, 1.0F), {0.25F, 0.75F}, {1.0F, 0.0F}, {0.5F, 0.5F}}) {
        const FragmentStream stream = sloped(ranged(at_near, at_far), 0.0F, 1.0F);
        EXPECT_EQ(stream.fragments, 64U * 192U);
        for (std::size_t i = 0; i < stream.quads.size(); ++i)
            for (std::size_t lane = 0; lane < 4; ++lane) {
                const double row = stream.quads[i].y + static_cast<double>(lane / 2) + 0.5;
                const auto from = static_cast<double>(at_near), to = static_cast<double>(at_far);
                ASSERT_NEAR(stream.depths[i][lane], from + (to - from) * row / 192.0, 1e-6);
            }
    }
}

TEST(DepthRange, TheUsualOneChangesNoBit) {
    EXPECT_EQ(sloped(ranged(0.0F, 1.0F), 0.1F, 0.9F).depths, sloped(RasterState(), 0.1F, 0.9F).depths);
}

TEST(DepthRange, WhatIsClampedStaysWithinIt) {
    for (const auto& [at_near, at_far] : {std::pair(0.25F, 0.75F), {0.75F, 0.25F}}) {
        RasterState state = ranged(at_near, at_far);
        state.depth.clamp = true;
        const FragmentStream stream = sloped(state, -1.0F, 2.0F);
        EXPECT_EQ(stream.fragments, 64U * 192U);
        for (std::size_t i = 0; i < stream.quads.size(); ++i)
            for (std::size_t lane = 0; lane < 4; ++lane) {
                const double row = stream.quads[i].y + static_cast<double>(lane / 2) + 0.5;
                const auto from = static_cast<double>(at_near), to = static_cast<double>(at_far);
                const double depth = from + (to - from) * (row * 3.0 / 192.0 - 1.0);
                ASSERT_NEAR(stream.depths[i][lane], std::clamp(depth, 0.25, 0.75), 1e-6);
            }
    }
}

// Beyond the planes nothing is drawn; a bias may leave the range, but not 0 to 1.
TEST(DepthRange, BiasesMayLeaveIt) {
    RasterState state = ranged(0.25F, 0.75F);
    state.depth.bias_constant = 0x1p+22F; // of steps of 2^-24
    FunctionalScene scene(8, 8);
    MeshData mesh = tests::rectangle(0, 0, 8, 8);
    for (auto& position : mesh.positions) position.z = 1.0F;
    scene.add(mesh);
    FrontEndOptions options;
    options.states = {&state, 1};
    options.depth_step = 0x1p-24;
    for (const auto& depths : scene.rasterize(options).depths)
        for (const float depth : depths) EXPECT_EQ(depth, 1.0F);
    state.depth.bias_constant *= 2.0F;
    for (const auto& depths : scene.rasterize(options).depths)
        for (const float depth : depths) EXPECT_EQ(depth, 1.0F);
}

TEST(DepthRange, ReachesPointsAndLines) {
    for (const Topology topology : {Topology::points, Topology::lines}) {
        FunctionalScene scene(16, 8);
        MeshData mesh;
        mesh.positions = {{2, 4, 0.5F}, {14, 4, 0.5F}};
        scene.add(mesh);
        scene.resources.geometries[0].topology = topology;
        const RasterState state = ranged(1.0F, 0.5F);
        FrontEndOptions options;
        options.states = {&state, 1};
        const FragmentStream stream = scene.rasterize(options);
        ASSERT_GT(stream.fragments, 1U);
        for (const auto& depths : stream.depths)
            for (const float depth : depths) EXPECT_EQ(depth, 0.75F);
    }
}

TEST(DepthRange, EndsLieWithinZeroAndOne) {
    for (const float bad : {-0.1F, 1.1F, std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_THROW(sloped(ranged(bad, 1.0F), 0.0F, 1.0F), sim::InputError);
        EXPECT_THROW(sloped(ranged(0.0F, bad), 0.0F, 1.0F), sim::InputError);
    }
}

} // namespace
} // namespace depth_range_test
