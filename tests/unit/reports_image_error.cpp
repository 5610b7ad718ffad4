// Errors of pictures against truth, and which points no other beats.
#include "reports/accuracy/accuracy.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace {

using reports::AccuracyPoint;
using reports::ImageError;
using reports::PixelKind;

TEST(ImageErrors, OfShadowsAreThoseOfInnerPixelsByKind) {
    const std::vector<float> truth{1.0F, 1.0F, 0.5F, 0.5F, 0.0F, 1.0F, 0.0F};
    const std::vector<float> seen{1.0F, 0.5F, 0.25F, 0.5F, 1.0F, 0.0F, 1.0F};
    std::vector<float> picture;
    for (const float value : seen) picture.insert(picture.end(), {9.0F, 9.0F, 9.0F, value});
    const std::vector<PixelKind> kinds{PixelKind::inner, PixelKind::inner,      PixelKind::inner,     PixelKind::inner,
                                       PixelKind::inner, PixelKind::silhouette, PixelKind::background};
    const ImageError error = reports::shadow_error(picture, truth, kinds);
    EXPECT_EQ(error.compared, 5U);
    EXPECT_EQ(error.excluded, 1U);
    EXPECT_DOUBLE_EQ(error.mean, (0.5 + 0.25 + 1.0) / 5);
    EXPECT_DOUBLE_EQ(error.rmse, std::sqrt((0.25 + 0.0625 + 1.0) / 5));
    EXPECT_DOUBLE_EQ(error.worst, 1.0);
    EXPECT_DOUBLE_EQ(error.acne, 0.2);
    EXPECT_DOUBLE_EQ(error.too_dark, 0.2);
    EXPECT_DOUBLE_EQ(error.too_bright, 0.2);
}

// An inclined plane has none within, however steep; a step has two pixels on either side.
TEST(ImageErrors, SilhouettesAreStepsNotSlopes) {
    pipeline::View view;
    view.width = 16;
    view.height = 8;
    const float near = 1.0F, far = 100.0F;
    view.projection = glm::mat4(0.0F);
    view.projection[0][0] = view.projection[1][1] = 1.0F;
    view.projection[2][2] = -(far + near) / (far - near);
    view.projection[2][3] = -1.0F;
    view.projection[3][2] = -2.0F * far * near / (far - near);
    std::vector<float> slope, step;
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            slope.push_back(0.2F + 0.04F * static_cast<float>(x)); // window depth is linear on planes
            step.push_back(x < 8 ? 0.5F : x < 14 ? 0.8F : 1.0F);
        }
    const auto slopes = reports::kinds_of_pixels(view, slope), steps = reports::kinds_of_pixels(view, step);
    for (std::uint32_t x = 2; x < 14; ++x) EXPECT_EQ(slopes[4 * 16 + x], PixelKind::inner) << x;
    for (std::uint32_t x = 0; x < 16; ++x) {
        const PixelKind expected = x >= 14                                           ? PixelKind::background
                                   : x == 6 || x == 7 || x == 8 || x == 9 || x >= 12 ? PixelKind::silhouette
                                                                                     : PixelKind::inner;
        EXPECT_EQ(steps[4 * 16 + x], expected) << x;
    }
}

TEST(ImageErrors, PointsOnTheFrontAreBeatenByNone) {
    std::vector<AccuracyPoint> points(4);
    const std::array<std::array<double, 3>, 4> values{{{1, 5, 0.5}, {2, 4, 0.4}, {3, 6, 0.45}, {2, 3, 0.4}}};
    for (std::size_t i = 0; i < 4; ++i) {
        points[i].sim_ms = values[i][0];
        points[i].host_s = values[i][1];
        points[i].error.rmse = values[i][2];
    }
    reports::mark_pareto(points);
    EXPECT_TRUE(points[0].pareto);
    EXPECT_TRUE(points[1].pareto); // as good as the fourth
    EXPECT_FALSE(points[2].pareto);
    EXPECT_TRUE(points[3].pareto);
    EXPECT_FALSE(points[0].pareto_host);
    EXPECT_FALSE(points[1].pareto_host);
    EXPECT_TRUE(points[3].pareto_host);
}

} // namespace
