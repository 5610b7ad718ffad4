// Window depths and distances: both ways, for perspective and parallel projections, up to extreme planes.
#include "pipeline/functional/eye_depth.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace {

using pipeline::EyeDepth;

/// Window depth of a point `distance` before the eye, as the pipeline computes it, in doubles.
double projected(const glm::mat4& projection, double distance) {
    const glm::dvec4 clip = glm::dmat4(projection) * glm::dvec4(0.0, 0.0, -distance, 1.0);
    return 0.5 + 0.5 * clip.z / clip.w;
}

void expect_both_ways(const glm::mat4& projection, double near, double far) {
    const EyeDepth depth(projection);
    for (int step = 0; step <= 20; ++step) {
        const double distance = near * std::pow(far / near, step / 20.0);
        const float window = static_cast<float>(projected(projection, distance));
        EXPECT_NEAR(depth.window(distance), window, 1.2e-7) << distance;
        // Half a quantum of the window depth to either side, as a distance, and the projection's own rounding.
        if (window <= 0.0F || window >= 1.0F) continue;
        const double before = depth.distance(std::nextafter(window, 0.0F));
        const double after = depth.distance(std::nextafter(window, 1.0F));
        EXPECT_LE(before, distance * (1.0 + 1e-12));
        EXPECT_GE(after, distance * (1.0 - 1e-12));
        EXPECT_GT(depth.distance(window), 0.0);
    }
}

TEST(EyeDepth, PerspectiveGoesBothWays) {
    expect_both_ways(glm::perspective(1.0F, 1.5F, 0.5F, 50.0F), 0.5, 50.0);
    expect_both_ways(glm::perspective(1.0F, 1.0F, 0.001F, 1e5F), 0.001, 1e5);
    EXPECT_TRUE(EyeDepth(glm::perspective(1.0F, 1.0F, 1.0F, 2.0F)).perspective());
}

TEST(EyeDepth, ParallelGoesBothWays) {
    expect_both_ways(glm::ortho(-1.0F, 1.0F, -1.0F, 1.0F, 0.5F, 50.0F), 0.5, 50.0);
    const EyeDepth depth(glm::ortho(-1.0F, 1.0F, -1.0F, 1.0F, 2.0F, 4.0F));
    EXPECT_FALSE(depth.perspective());
    EXPECT_NEAR(depth.distance(0.0F), 2.0, 1e-6);
    EXPECT_NEAR(depth.distance(0.5F), 3.0, 1e-6);
    EXPECT_NEAR(depth.distance(1.0F), 4.0, 1e-6);
}

TEST(EyeDepth, PlanesAreWhereTheMatrixSays) {
    const EyeDepth depth(glm::perspective(1.0F, 1.0F, 1.0F, 100.0F));
    EXPECT_NEAR(depth.distance(0.0F), 1.0, 1e-6);
    EXPECT_NEAR(depth.distance(1.0F) / 100.0, 1.0, 1e-5); // what the floats of the matrix leave of the far plane
    // Specification 004, section 6.1: at z = 50 an eps of 1e-4 is a gap of about 0.248.
    const float there = depth.window(50.0);
    EXPECT_NEAR(depth.distance(there + 1e-4F) - depth.distance(there), 0.248, 0.003);
}

TEST(EyeDepth, IsFiniteWithoutAFarPlaneAndOutsideTheRange) {
    const EyeDepth depth(glm::infinitePerspective(1.0F, 1.0F, 0.1F));
    constexpr double largest = std::numeric_limits<float>::max();
    EXPECT_EQ(depth.distance(1.0F), largest);
    EXPECT_EQ(depth.distance(2.0F), largest);
    EXPECT_EQ(depth.distance(std::numeric_limits<float>::quiet_NaN()), largest);
    EXPECT_NEAR(depth.distance(-3.0F), 0.1, 1e-7);
    EXPECT_LT(depth.distance(std::nextafter(1.0F, 0.0F)), largest);
    EXPECT_EQ(depth.window(1e30), 1.0F);
    EXPECT_EQ(depth.window(0.0), 0.0F);
    EXPECT_EQ(depth.window(-1.0), 0.0F);
}

TEST(EyeDepth, DistancesGrowWithEveryWindowDepth) {
    const EyeDepth depth(glm::perspective(1.0F, 1.0F, 0.01F, 1000.0F));
    float window = 0.999F;
    double before = depth.distance(window);
    for (int step = 0; step < 10000; ++step) {
        window = std::nextafter(window, 1.0F);
        const double now = depth.distance(window);
        ASSERT_GT(now, before) << window;
        before = now;
    }
}

} // namespace
