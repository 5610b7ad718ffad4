// Translucency of two slabs against Beer's law along the rays through them (specification 004, A12, 10.4).
#include "tests/support/box_ray.hpp"
#include "tests/support/replay.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace workload_translucency_test {

using support::Interval;
using support::PixelRay;
using support::Replay;

constexpr std::uint32_t size = 64;

Replay slabs(std::vector<std::string> knobs, const std::string& scene = "gen:slabs") {
    return Replay(scene, {.width = size,
                          .height = size,
                          .workload = "translucency",
                          .camera = "0.7,0.5,5,0,0,-0.6,25",
                          .knobs = std::move(knobs)});
}

struct Way {
    double front = 0.0, back = 0.0; ///< length inside each slab
    bool doubtful = false;          ///< near an edge
    bool through_faces = false;     ///< of both slabs, from front to back
    double cosine = 0.0;            ///< to the normal of the front sides
};

Way way_through_slabs(const pipeline::View& view, std::uint32_t x, std::uint32_t y, double gap = 0.5) {
    const PixelRay ray(view, x, y);
    const glm::dvec3 lo(-1.0, -1.0, -0.5), back_lo(-1.0, -1.0, -0.75 - gap);
    const glm::dvec3 hi(1.0, 1.0, 0.0), back_hi(1.0, 1.0, -0.5 - gap);
    const Interval a = ray.in_box(lo, hi), b = ray.in_box(back_lo, back_hi);
    Way way;
    const auto length = [&](Interval i) { return i.empty() ? 0.0 : (i.leave - i.enter) * ray.stretch(); };
    way.front = length(a);
    way.back = length(b);
    way.doubtful = std::fabs(a.leave - a.enter) < 0.03 || std::fabs(b.leave - b.enter) < 0.03;
    way.cosine = std::fabs(ray.step().z) / ray.stretch();
    way.through_faces =
        std::fabs(way.front * way.cosine - 0.5) < 1e-9 && std::fabs(way.back * way.cosine - 0.25) < 1e-9;
    return way;
}

/// Compares every pixel with expected(way); returns how many lie inside a slab.
template <class Expected>
std::size_t expect_transmittance(const Replay& replay, double relative, Expected expected) {
    std::size_t inside = 0;
    double worst = 0.0;
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) {
            const Way way = way_through_slabs(replay.frame.view, x, y);
            if (way.doubtful) continue;
            inside += way.front + way.back > 0.0;
            const double known = expected(way);
            const float* pixel = replay.reference.picture.data() + 4 * (std::size_t{y} * size + x);
            EXPECT_NEAR(static_cast<double>(pixel[0]), known, relative * known) << x << ' ' << y;
            EXPECT_EQ(pixel[0], pixel[1]);
            if (known > 0.0) worst = std::max(worst, std::fabs(static_cast<double>(pixel[0]) - known) / known);
        }
    testing::Test::RecordProperty("worst_relative_error", fmt::format("{:.3g}", worst));
    return inside;
}

TEST(Translucency, OfTwoSlabsIsBeersLaw) {
    const Replay replay = slabs({"sigma=1.5"});
    EXPECT_GT(expect_transmittance(replay, 1e-4, [](const Way& w) { return std::exp(-1.5 * (w.front + w.back)); }),
              1500U);
}

TEST(Translucency, EachDrawHasItsOwnExtinction) {
    const Replay replay = slabs({"sigma=[2,0.25]"});
    EXPECT_GT(expect_transmittance(replay, 1e-4, [](const Way& w) { return std::exp(-2.0 * w.front - 0.25 * w.back); }),
              1500U);
}

TEST(Translucency, OneMediumNeedsDepthsOnly) {
    const Replay replay = slabs({"sigma=1.5", "media=one"});
    EXPECT_EQ(replay.frame.program->floats_per_entry(), 1U);
    EXPECT_FALSE(replay.frame.needs.colours);
    EXPECT_GT(expect_transmittance(replay, 1e-4, [](const Way& w) { return std::exp(-1.5 * (w.front + w.back)); }),
              1500U);
}

TEST(Translucency, NoExtinctionIsClearAndAHugeOneIsBlack) {
    for (const float value : slabs({"sigma=0"}).reference.picture) EXPECT_EQ(value, 1.0F);
    const Replay opaque = slabs({"sigma=4e4"}); // times a quarter: an optical depth of 1e4 and more
    EXPECT_GT(expect_transmittance(opaque, 0.0, [](const Way& w) { return w.front + w.back > 0.0 ? 0.0 : 1.0; }),
              1500U);
    for (const float value : slabs({"sigma=1e30"}).reference.picture) EXPECT_TRUE(value == 0.0F || value == 1.0F);
}

TEST(Translucency, OverlappingObjectsArePairedEachOnItsOwn) {
    // The back slab begins inside the front one.
    const Replay replay = slabs({"sigma=[1,3]"}, "gen:slabs?gap=-0.375");
    std::size_t compared = 0;
    for (std::uint32_t y = 8; y < size - 8; ++y)
        for (std::uint32_t x = 8; x < size - 8; ++x) {
            const Way way = way_through_slabs(replay.frame.view, x, y, -0.375);
            if (way.doubtful || way.front == 0.0) continue;
            const float* pixel = replay.reference.picture.data() + 4 * (std::size_t{y} * size + x);
            const double known = std::exp(-way.front - 3.0 * way.back);
            EXPECT_NEAR(static_cast<double>(pixel[0]), known, 1e-4 * known) << x << ' ' << y;
            ++compared;
        }
    EXPECT_GT(compared, 1000U);
}

TEST(Translucency, FresnelIsTheProductOverTheSurfaces) {
    const Replay replay = slabs({"sigma=0", "fresnel=true"});
    EXPECT_TRUE(replay.frame.needs.normals);
    EXPECT_EQ(replay.frame.needs.fragment_colour, pipeline::FragmentColour::cosine);
    std::size_t compared = 0;
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) {
            const Way way = way_through_slabs(replay.frame.view, x, y);
            if (way.doubtful || !way.through_faces) continue;
            const double known = std::pow(1.0 - std::pow(1.0 - way.cosine, 5), 4);
            const float* pixel = replay.reference.picture.data() + 4 * (std::size_t{y} * size + x);
            EXPECT_NEAR(static_cast<double>(pixel[0]), known, 1e-5) << x << ' ' << y;
            ++compared;
        }
    EXPECT_GT(compared, 1000U);
}

TEST(Translucency, EveryKGivesNumbersAndFromFourOnTheSame) {
    const std::vector<float> four = slabs({"k=4"}).reference.picture;
    for (std::uint32_t k = 1; k <= 64; ++k) {
        const Replay replay = slabs({fmt::format("k={}", k)});
        for (const float value : replay.reference.picture) EXPECT_TRUE(std::isfinite(value) && value >= 0.0F);
        EXPECT_TRUE(k < 4 || replay.reference.picture == four) << k;
    }
}

TEST(Translucency, AskedForTheWrongNumberOfExtinctionsSaysSo) {
    try {
        slabs({"sigma=[1,2,3]"});
        ADD_FAILURE() << "accepted";
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(),
                     "workload translucency: sigma: expected one number, or 2 (one for each object), got 3");
    }
}

} // namespace workload_translucency_test
