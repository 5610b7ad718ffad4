// A16: the pre-integrated table against closed forms and fine integration, and the program against the table.
#include "models/programs/volume.hpp"
#include "sim/check.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace {

using models::PreintegratedTable;
using models::TransferFunction;
using models::VolumeSetup;

constexpr glm::vec3 orange(0.9F, 0.5F, 0.1F);

TransferFunction constant(float extinction) { return {{0.0F, orange, extinction}, {1.0F, orange, extinction}}; }

void expect_constant(float extinction, float length, float longest) {
    const PreintegratedTable table(constant(extinction), longest, 8, 8);
    const double opacity = -std::expm1(-static_cast<double>(extinction) * static_cast<double>(length));
    constexpr double ulps = 4.0 * 6e-8;
    for (const auto& [s1, s2] : {std::pair{0.0F, 1.0F}, std::pair{0.3F, 0.31F}, std::pair{1.0F, 0.2F}}) {
        const glm::vec4 gap = table.gap(s1, s2, length);
        EXPECT_NEAR(gap.a / opacity, 1.0, ulps) << extinction << " " << length;
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(gap[channel] / (opacity * static_cast<double>(orange[channel])), 1.0, ulps);
    }
}

TEST(PreintegratedTable, AConstantFieldGivesTheClosedFormForEveryThickness) {
    for (const float thickness : {1e-30F, 1e-7F, 1e-3F, 0.1F, 1.0F, 10.0F, 100.0F, 1e4F}) {
        expect_constant(thickness, 1.0F, 1.0F);
        expect_constant(thickness * 8.0F, 0.125F, 1.0F);
        expect_constant(thickness / 4.0F, 4.0F, 1.0F); // longer than the table
    }
}

TEST(PreintegratedTable, NothingIsSeenOfAnEmptyOrInfinitelyThinGap) {
    const PreintegratedTable clear(constant(0.0F), 1.0F, 4, 4), some(constant(2.0F), 1.0F, 4, 4);
    EXPECT_EQ(clear.gap(0.2F, 0.7F, 0.5F), glm::vec4(0.0F));
    EXPECT_EQ(some.gap(0.2F, 0.7F, 0.0F), glm::vec4(0.0F));
}

/// What is seen of a gap, by a hundred thousand steps in doubles.
glm::dvec4 integrated(const TransferFunction& transfer, double s1, double s2, double length) {
    constexpr int steps = 100000;
    glm::dvec4 seen(0.0);
    for (int i = 0; i < steps; ++i) {
        const double s = s1 + (s2 - s1) * (i + 0.5) / steps;
        std::size_t right = 1;
        while (right + 1 < transfer.size() && s > static_cast<double>(transfer[right].scalar)) ++right;
        const models::TransferPoint &a = transfer[right - 1], &b = transfer[right];
        const double t = (s - static_cast<double>(a.scalar)) / static_cast<double>(b.scalar - a.scalar);
        const double sigma = glm::mix(static_cast<double>(a.extinction), static_cast<double>(b.extinction), t);
        const double alpha = -std::expm1(-sigma * length / steps);
        const glm::dvec3 colour = glm::mix(glm::dvec3(a.colour), glm::dvec3(b.colour), t);
        seen += (1.0 - seen.a) * glm::dvec4(alpha * colour, alpha);
    }
    return seen;
}

TEST(PreintegratedTable, NodesAgreeWithFineIntegration) {
    const TransferFunction transfer{{0.0F, {1.0F, 0.0F, 0.0F}, 0.0F},
                                    {0.25F, {1.0F, 1.0F, 0.0F}, 8.0F},
                                    {0.5F, {0.0F, 1.0F, 0.5F}, 0.5F},
                                    {1.0F, {0.0F, 0.0F, 1.0F}, 20.0F}};
    const PreintegratedTable table(transfer, 2.0F, 5, 5);
    for (const float s1 : {0.0F, 0.25F, 0.5F, 1.0F})
        for (const float s2 : {0.0F, 0.25F, 0.75F, 1.0F})
            for (const float length : {0.5F, 1.0F, 2.0F}) {
                const glm::vec4 gap = table.gap(s1, s2, length);
                const glm::dvec4 expected =
                    integrated(transfer, static_cast<double>(s1), static_cast<double>(s2), static_cast<double>(length));
                for (int i = 0; i < 4; ++i)
                    EXPECT_NEAR(static_cast<double>(gap[i]), expected[i], 1e-3) << s1 << " " << s2 << " " << length;
            }
}

TEST(PreintegratedTable, ThinGapsShowTheMeanColourByExtinction) {
    const TransferFunction transfer{{0.0F, {1.0F, 0.0F, 0.0F}, 0.0F}, {1.0F, {0.0F, 0.0F, 1.0F}, 3.0F}};
    const PreintegratedTable table(transfer, 1e-6F, 4, 4);
    const glm::vec4 gap = table.gap(0.0F, 1.0F, 1e-6F);
    EXPECT_NEAR(gap.a / 1.5e-6F, 1.0F, 1e-5F);
    EXPECT_NEAR(gap.r / gap.a, 1.0F / 3.0F, 2e-3F); // mean of (1 - t) weighted by t
    EXPECT_NEAR(gap.b / gap.a, 2.0F / 3.0F, 2e-3F);
}

TEST(PreintegratedTable, ExtremesStayFinite) {
    constexpr float huge = std::numeric_limits<float>::max();
    const PreintegratedTable table({{0.0F, orange, 0.0F}, {1.0F, orange, huge}}, huge, 4, 4);
    for (const float length : {0.0F, 1e-38F, 1.0F, huge})
        for (const float scalar : {-huge, 0.0F, 0.5F, huge}) {
            const glm::vec4 gap = table.gap(scalar, 1.0F, length);
            for (int i = 0; i < 4; ++i) EXPECT_TRUE(std::isfinite(gap[i]));
            EXPECT_GE(gap.a, 0.0F);
            EXPECT_LE(gap.a, 1.0F);
        }
}

TEST(PreintegratedTable, RefusesWhatIsNoTransferFunction) {
    const auto error_of = [](const TransferFunction& transfer) -> std::string {
        try {
            const PreintegratedTable table(transfer, 1.0F, 4, 4);
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_EQ(error_of({}), "transfer function: expected at least one point, got none");
    EXPECT_EQ(error_of({{0.0F, orange, 1.0F}, {0.0F, orange, 1.0F}}),
              "transfer function: point 1: expected a scalar greater than the one before, got 0");
    EXPECT_EQ(error_of({{0.0F, orange, -1.0F}}),
              "transfer function: point 0: expected an extinction of at least 0, got -1");
    EXPECT_EQ(error_of({{0.0F, orange, 1.0F}}), "");
}

std::array<float, 4> run(const VolumeSetup& setup, const std::vector<std::array<float, 2>>& samples) {
    const auto program = models::make_volume(setup);
    std::vector<float> pixel(program->floats_per_pixel());
    program->clear(pixel.data());
    for (const auto& sample : samples) program->insert(pixel.data(), sample.data());
    program->drain(pixel.data());
    std::array<float, 4> state;
    std::copy_n(pixel.data() + std::size_t{setup.k} * 2, 4, state.begin());
    return state;
}

TEST(Volume, GapsOfAConstantFieldAddUpToOne) {
    VolumeSetup setup;
    setup.transfer = constant(0.7F);
    setup.longest_gap = 10.0F;
    const auto one = run(setup, {{1.0F, 0.5F}, {5.0F, 0.5F}});
    const auto many = run(setup, {{1.0F, 0.5F}, {1.5F, 0.1F}, {2.25F, 0.9F}, {3.0F, 0.4F}, {3.5F, 0.4F}, {5.0F, 0.5F}});
    EXPECT_NEAR(one[3], -std::expm1(-2.8), 1e-6);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(many[i], one[i], 1e-6F);
}

TEST(Volume, SortsSamplesAndBearsEqualDistances) {
    VolumeSetup setup;
    setup.transfer = {{0.0F, {1.0F, 0.0F, 0.0F}, 0.2F}, {1.0F, {0.0F, 0.0F, 1.0F}, 2.0F}};
    const auto sorted = run(setup, {{1.0F, 0.0F}, {2.0F, 1.0F}, {3.0F, 0.5F}, {3.0F, 0.5F}, {4.0F, 0.1F}});
    const auto moved = run(setup, {{3.0F, 0.5F}, {2.0F, 1.0F}, {1.0F, 0.0F}, {4.0F, 0.1F}, {3.0F, 0.5F}});
    EXPECT_EQ(sorted, moved);
    EXPECT_GT(sorted[3], 0.8F);
    EXPECT_LT(sorted[3], 1.0F);
}

TEST(Volume, NothingBetweenOneSampleAndNone) {
    VolumeSetup setup;
    setup.transfer = constant(1.0F);
    EXPECT_EQ(run(setup, {}), (std::array<float, 4>{}));
    EXPECT_EQ(run(setup, {{1.0F, 0.5F}}), (std::array<float, 4>{}));
    EXPECT_TRUE(models::make_volume(setup)->needs_texture());
}

} // namespace
