// Pictures show what the numbers say.
#include "reports/pictures.hpp"

#include "reports/colours.hpp"
#include "reports/glyphs.hpp"
#include "reports/legend.hpp"
#include "tests/support/sample_comparison.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace {

using reports::Colour;
using reports::KBufferLayout;
using reports::Picture;
using ropsim_test::sample_comparison;
using ropsim_test::sample_depth_comparison;

constexpr reports::Size size{8, 4};

int brightness(const Colour& colour) { return 2 * colour[0] + 7 * colour[1] + colour[2]; }

TEST(ReportsPictures, SrgbHasKnownValues) {
    EXPECT_EQ(reports::encode_srgb(0.0F), 0);
    EXPECT_EQ(reports::encode_srgb(1.0F), 255);
    EXPECT_EQ(reports::encode_srgb(0.0031308F), 10);   // end of the straight part: 12.92 * 0.0031308 * 255 = 10.3
    EXPECT_EQ(reports::encode_srgb(0.21404114F), 128); // middle grey, 0.50196 encoded
    EXPECT_EQ(reports::encode_srgb(-1.0F), 0);
    EXPECT_EQ(reports::encode_srgb(2.0F), 255);
    EXPECT_EQ(reports::encode_srgb(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(reports::encode_srgb(std::numeric_limits<float>::infinity()), 255);
}

TEST(ReportsPictures, HeatRisesInBrightnessAndDepthFalls) {
    for (int i = 1; i <= 100; ++i) {
        EXPECT_GE(brightness(reports::heat(i / 100.0)), brightness(reports::heat((i - 1) / 100.0))) << i;
        EXPECT_LE(brightness(reports::depth_shade(i / 100.0)), brightness(reports::depth_shade((i - 1) / 100.0))) << i;
    }
}

TEST(ReportsPictures, RampsClampWhatLiesOutside) {
    EXPECT_EQ(reports::heat(-1), reports::heat(0));
    EXPECT_EQ(reports::heat(7), reports::heat(1));
    EXPECT_EQ(reports::heat(std::numeric_limits<double>::quiet_NaN()), reports::heat(1));
}

TEST(ReportsPictures, LayoutFindsEmptyEntries) {
    const auto comparison = sample_comparison();
    const KBufferLayout layout(*comparison.frame->program);
    EXPECT_TRUE(layout.is_empty(comparison.reference.kbuffer, 0, 0));  // x = 0: no fragment
    EXPECT_FALSE(layout.is_empty(comparison.reference.kbuffer, 1, 0)); // x = 1: one
    EXPECT_TRUE(layout.is_empty(comparison.reference.kbuffer, 1, 1));
    EXPECT_FALSE(layout.is_empty(comparison.reference.kbuffer, 2, 1)); // x = 2: two
    EXPECT_FLOAT_EQ(layout.depth(comparison.reference.kbuffer, 2, 1), 0.6F);
}

TEST(ReportsPictures, ColourLayerShowsItsColoursAndChequersTheRest) {
    const auto comparison = sample_comparison();
    const KBufferLayout layout(*comparison.frame->program);
    const Picture picture = reports::layer_picture(size, layout, comparison.reference.kbuffer, 0, {});
    EXPECT_EQ(picture.width, 8U);
    EXPECT_EQ(picture.height, 4U);
    EXPECT_EQ(picture.at(3, 1), (Colour{255, 0, 0}));
    EXPECT_EQ(picture.at(0, 0), reports::empty_colour(0, 0));
}

TEST(ReportsPictures, DepthLayerIsShadedOverTheRangeOfTheReference) {
    const auto comparison = sample_depth_comparison();
    const KBufferLayout layout(*comparison.frame->program);
    const auto range = reports::depth_range(layout, comparison.reference.kbuffer, size.pixels());
    EXPECT_FLOAT_EQ(range.near, 0.4F);
    EXPECT_FLOAT_EQ(range.far, 0.6F);
    const Picture near = reports::layer_picture(size, layout, comparison.reference.kbuffer, 0, range);
    const Picture far = reports::layer_picture(size, layout, comparison.reference.kbuffer, 1, range);
    EXPECT_EQ(near.at(3, 1), reports::depth_shade(0));
    EXPECT_EQ(far.at(3, 1), reports::depth_shade(1));
    EXPECT_GT(near.height, 4U); // the scale is below
}

TEST(ReportsPictures, EmptyKBufferHasARange) {
    const auto comparison = sample_depth_comparison();
    const KBufferLayout layout(*comparison.frame->program);
    std::vector<float> cleared(comparison.reference.kbuffer.size());
    for (std::size_t pixel = 0; pixel < size.pixels(); ++pixel)
        comparison.frame->program->clear(&cleared[pixel * comparison.frame->program->floats_per_pixel()]);
    const auto range = reports::depth_range(layout, cleared, size.pixels());
    EXPECT_EQ(range.near, 0.0F);
    EXPECT_EQ(range.far, 1.0F);
    const Picture picture = reports::layer_picture(size, layout, cleared, 0, range);
    EXPECT_EQ(picture.at(3, 1), reports::empty_colour(3, 1));
}

TEST(ReportsPictures, HazardsHaveTheColourOfTheirClass) {
    const auto comparison = sample_comparison();
    const auto& run = comparison.runs[0];
    const Picture picture =
        reports::hazard_picture(size, comparison.pixels[0].composite, run.hazard_mask, run.hazards, run.design);
    EXPECT_EQ(picture.at(2, 1), reports::hazard_colour(0));
    EXPECT_EQ(picture.at(5, 2), reports::hazard_colour(2));
    const Colour grey = picture.at(1, 0);
    EXPECT_EQ(grey[0], grey[1]);
    EXPECT_EQ(grey[1], grey[2]);
}

TEST(ReportsPictures, OfSeveralClassesTheHighestIsShown) {
    auto comparison = sample_comparison();
    auto& run = comparison.runs[0];
    run.hazard_mask[10] = 1 | 2 | 8;
    const Picture picture =
        reports::hazard_picture(size, comparison.pixels[0].composite, run.hazard_mask, run.hazards, run.design);
    EXPECT_EQ(picture.at(2, 1), reports::hazard_colour(3));
}

TEST(ReportsPictures, DifferenceFactorBringsTheUsualErrorToTheTop) {
    const std::vector<float> reference(4 * 32, 0.5F);
    const auto factor = [&](float error) {
        std::vector<float> pixels = reference;
        pixels[4 * 7 + 1] += error;
        reports::DifferenceScale scale;
        scale.note(size, pixels, reference);
        return scale.factor();
    };
    EXPECT_EQ(factor(0.0F), 1U);
    EXPECT_EQ(factor(0.5F), 1U);
    EXPECT_EQ(factor(0.2F), 4U);
    EXPECT_EQ(factor(0.06F), 16U);
    EXPECT_EQ(factor(1e-6F), 256U);
}

TEST(ReportsPictures, DifferenceIsDarkWhereEqualAndTealWhereOnlyTheKBufferDiffers) {
    const auto comparison = sample_comparison();
    auto wrong = comparison.runs[0].wrong_mask;
    wrong[0] = 1;
    const Picture picture = reports::difference_picture(size, comparison.pixels[0].composite,
                                                        comparison.reference.composite, wrong, 1, "racy");
    EXPECT_EQ(picture.at(1, 1), reports::heat(0));
    EXPECT_GT(brightness(picture.at(2, 1)), brightness(reports::heat(0)));
    EXPECT_NE(picture.at(0, 0), reports::heat(0));
}

TEST(ReportsPictures, OverlapIsBrighterWhereMoreFragmentsFell) {
    const auto comparison = sample_comparison();
    const Picture picture = reports::overlap_picture(size, comparison.depth_complexity);
    EXPECT_EQ(picture.at(0, 0), reports::heat(0));
    EXPECT_EQ(picture.at(1, 0), reports::heat(0.5));
    EXPECT_EQ(picture.at(2, 0), reports::heat(1));
}

TEST(ReportsPictures, OverlapOfNothingIsDark) {
    const Picture picture = reports::overlap_picture(size, std::vector<std::uint32_t>(32, 0));
    EXPECT_EQ(picture.at(0, 0), reports::heat(0));
}

TEST(ReportsPictures, AFewVeryDeepPixelsDoNotDarkenTheOthers) {
    std::vector<std::uint32_t> counts(100 * 100, 2);
    counts[5] = 1000;
    const Picture picture = reports::overlap_picture({100, 100}, counts);
    EXPECT_EQ(picture.at(0, 0), reports::heat(1));
    EXPECT_EQ(picture.at(5, 0), reports::heat(1));
}

TEST(ReportsPictures, LegendKeepsThePixelsAndMakesRoomForItsText) {
    Picture picture(8, 4, {1, 2, 3});
    const Picture with = reports::with_legend(picture, {"A title that is wider than eight pixels", nullptr, {}, {}});
    EXPECT_GE(with.width, reports::text_width("A title that is wider than eight pixels", 1));
    for (std::uint32_t y = 0; y < 4; ++y)
        for (std::uint32_t x = 0; x < 8; ++x) EXPECT_EQ(with.at(x, y), picture.at(x, y));
}

TEST(ReportsPictures, TextIsCutOffAtTheEdges) {
    Picture picture(9, 5, {0, 0, 0});
    reports::draw_text(picture, 4, 2, "HHH", 2, {255, 255, 255});
    EXPECT_EQ(picture.at(4, 2), (Colour{255, 255, 255}));
    EXPECT_EQ(picture.at(3, 2), (Colour{0, 0, 0}));
}

TEST(ReportsPictures, EveryPrintableCharacterHasItsOwnGlyph) {
    for (char a = '!'; a <= '~'; ++a)
        for (char b = '!'; b < a; ++b) EXPECT_NE(reports::glyph_of(a), reports::glyph_of(b)) << a << b;
    EXPECT_EQ(reports::glyph_of('\xe4'), reports::glyph_of('?'));
}

} // namespace
