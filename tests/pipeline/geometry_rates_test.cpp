// What a stream of small triangles takes when nothing but the front end works: its slowest stage.
#include "tests/support/replay.hpp"

#include <algorithm>
#include <deque>
#include <gtest/gtest.h>

namespace {

using support::Replay;

constexpr double blades = 20'000; // five triangles of seven vertices each
constexpr double setup = 2;       // cycles of a drawn triangle
constexpr std::size_t queue = 64; // triangles in front of setup

const Replay& grass() {
    static const Replay replay("gen:grass?blades=20000", {.width = 16, .height = 16, .workload = "opaque"});
    return replay;
}

double cycles(const Replay& replay, const std::vector<std::string>& settings = {}) {
    return static_cast<double>(support::pass_named(replay.run("existing", settings), "opaque").cycles);
}

/// Cycles of a stream whose primitives come one a cycle, in order, and of which setup sees those that are drawn.
double bound(const pipeline::FragmentStream& stream) {
    double arrived = 0, done = 0;
    std::deque<double> taken; // when those in the queue left it
    for (const pipeline::Primitive& primitive : stream.primitives) {
        ++arrived;
        for (std::uint32_t i = 0; i < primitive.triangles; ++i) {
            if (taken.size() == queue) {
                arrived = std::max(arrived, taken.front());
                taken.pop_front();
            }
            taken.push_back(std::max(arrived, done));
            done = taken.back() + setup;
        }
    }
    return done;
}

} // namespace

// Where none is culled, 32-bit indices come fast enough.
TEST(GeometryRates, PHY_R6_SetupTakesTwoCyclesPerDrawnTriangle) {
    const Replay discs("gen:discs?n=2000&overlap=1&width=16&height=16",
                       {.width = 16, .height = 16, .workload = "opaque"});
    const pipeline::FragmentStream& stream = discs.streams[0];
    ASSERT_EQ(stream.triangles.size(), stream.primitives.size());
    ASSERT_TRUE(discs.frame.needs.index_buffer);
    const double drawn = static_cast<double>(stream.triangles.size()), taken = cycles(discs);
    EXPECT_GE(taken, setup * drawn);
    EXPECT_LE(taken, 1.03 * setup * drawn);
}

// Two cycles for each drawn blade's triangle is less than the front end can do on this field: of its tenths, between 8
// and 95 % are drawn, and where few are, the triangles that face away set the pace at one a cycle. A part of that is
// caught by the queue in front of setup.
TEST(GeometryRates, PHY_R6_CulledTrianglesSetThePaceWhereFewAreDrawn) {
    const pipeline::FragmentStream& stream = grass().streams[0];
    const double least = bound(stream), taken = cycles(grass());
    EXPECT_GT(least, 1.2 * setup * static_cast<double>(stream.triangles.size()));
    EXPECT_GE(taken, least);
    EXPECT_LE(taken, 1.05 * least);
}

TEST(GeometryRates, PHY_R6_FewVertexUnitsTakeFourCyclesPerVertexEach) {
    EXPECT_NEAR(cycles(grass(), {"geometry.vertex_shader.units=2"}) / blades, 14, 0.02 * 14);
    EXPECT_NEAR(cycles(grass(), {"geometry.vertex_shader.units=1"}) / blades, 28, 0.02 * 28);
}
