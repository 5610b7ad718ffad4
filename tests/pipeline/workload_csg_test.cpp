// Constructive solid geometry of a sphere and a cube against what a ray meets of them (specification 004, A13, 10.4).
#include "models/kbuffers/library.hpp"
#include "tests/support/box_ray.hpp"
#include "tests/support/replay.hpp"
#include "traces/workloads/csg_surface.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace workload_csg_test {

using support::Interval;
using support::Replay;

constexpr std::uint32_t size = 96;
constexpr double none = traces::SurfaceImage::none;

const Replay& sphere_and_cube() {
    static const Replay replay("gen:csg?segments=512&half_edge=0.8&offset=[0.35,0.3,0.5]",
                               {.width = size, .height = size, .workload = "csg", .knobs = {"expression=A - B"}});
    return replay;
}

/// Distance of the first point of a solid on the ray, from the intervals of A and B.
using Expected = double (*)(Interval a, Interval b);

double first_of_a(Interval a, Interval) { return a.empty() ? none : a.enter; }
double first_of_b(Interval, Interval b) { return b.empty() ? none : b.enter; }
double first_of_both(Interval a, Interval b) {
    const Interval both{std::max(a.enter, b.enter), std::min(a.leave, b.leave)};
    return a.empty() || b.empty() || both.empty() ? none : both.enter;
}
double first_of_a_without_b(Interval a, Interval b) {
    if (a.empty()) return none;
    if (b.empty() || a.enter < b.enter || a.enter > b.leave) return a.enter;
    return b.leave < a.leave ? b.leave : none;
}
double first_of_either(Interval a, Interval b) { return std::min(first_of_a(a, b), first_of_b(a, b)); }

/// Pixels whose answer hangs on less than a thousandth of the scene: silhouettes and edges.
bool is_doubtful(Interval a, Interval b) {
    constexpr double least = 2e-3;
    const auto thin = [](Interval i) {
        return std::fabs(i.leave - i.enter) < least && !(i.enter == 0 && i.leave == 0);
    };
    for (const double x : {a.enter, a.leave})
        for (const double y : {b.enter, b.leave})
            if (std::fabs(x - y) < least) return true;
    return thin(a) || thin(b);
}

void expect_depths(const char* text, Expected expected) {
    SCOPED_TRACE(text);
    const Replay& replay = sphere_and_cube();
    const auto surface = traces::csg_surface(replay.frame, replay.reference.kbuffer, traces::CsgExpression(text, 2));
    std::size_t surfaces = 0, doubtful = 0;
    double worst = 0.0;
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) {
            const support::PixelRay ray(replay.frame.view, x, y);
            const glm::dvec3 middle(0.35, 0.3, 0.5);
            const Interval a = ray.in_sphere(1.0), b = ray.in_box(middle - 0.8, middle + 0.8);
            if (is_doubtful(a, b)) {
                ++doubtful;
                continue;
            }
            const double known = expected(a, b), found = surface.image.distance(x, y);
            surfaces += known != none;
            if (known == none) {
                EXPECT_EQ(found, none) << x << ' ' << y;
            } else {
                EXPECT_NEAR(found, known, 1e-3 * known) << x << ' ' << y;
                worst = std::max(worst, std::fabs(found - known) / known);
            }
        }
    EXPECT_GT(surfaces, size * size / 20);
    EXPECT_LT(doubtful, size * size / 50);
    testing::Test::RecordProperty(fmt::format("worst_relative_error_of_{}", text), fmt::format("{:.3g}", worst));
}

TEST(Csg, DepthsAreThoseOfTheAnalyticSolids) {
    expect_depths("A", first_of_a);
    expect_depths("B", first_of_b);
    expect_depths("A & B", first_of_both);
    expect_depths("A - B", first_of_a_without_b);
    expect_depths("A & !B", first_of_a_without_b);
    expect_depths("A | B", first_of_either);
}

TEST(Csg, SurfacesAreLitInTheColourOfTheirObject) {
    const Replay& replay = sphere_and_cube();
    const traces::CsgExpression difference("A - B", 2);
    const auto surface = traces::csg_surface(replay.frame, replay.reference.kbuffer, difference);
    const std::vector<float>& picture = replay.reference.picture;
    std::array<std::size_t, 2> seen{};
    for (std::size_t i = 0; i < picture.size() / 4; ++i) {
        const auto x = static_cast<std::uint32_t>(i % size), y = static_cast<std::uint32_t>(i / size);
        const float* pixel = picture.data() + 4 * i;
        if (!surface.image.sees(x, y)) {
            EXPECT_EQ(pixel[0], 1.0F);
            continue;
        }
        ++seen[surface.objects[i]];
        const auto& material = replay.frame.resources->materials[replay.frame.draws[surface.objects[i]].material];
        EXPECT_NEAR(pixel[0] / pixel[2], material.base_colour.r / material.base_colour.b, 1e-4F);
        EXPECT_LE(pixel[2], material.base_colour.b);
    }
    EXPECT_GT(seen[0], 100U);
    EXPECT_GT(seen[1], 100U);
}

TEST(Csg, NormalsOfTheSphereAreItsRadii) {
    const Replay& replay = sphere_and_cube();
    const auto surface = traces::csg_surface(replay.frame, replay.reference.kbuffer, traces::CsgExpression("A", 2));
    const traces::ViewRays rays(replay.frame.view);
    const glm::dvec3 middle(replay.frame.view.view * glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
    std::size_t compared = 0;
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) {
            if (!surface.image.sees(x, y)) continue;
            const glm::dvec3 place = rays.place(x, y, surface.image.distance(x, y));
            const glm::dvec3 radius = glm::normalize(place - middle);
            if (radius.z < 0.5) continue; // differences over a pixel are coarse where the surface turns away
            EXPECT_GT(glm::dot(radius, surface.image.normal(x, y)), 0.999) << x << ' ' << y;
            ++compared;
        }
    EXPECT_GT(compared, 1000U);
}

TEST(Csg, PixelsWithMoreFragmentsThanKLoseThoseBehind) {
    // With one entry nobody leaves the sphere; nothing is inside both.
    const Replay replay("gen:csg",
                        {.width = 32, .height = 32, .workload = "csg", .knobs = {"expression=A & B", "k=1"}});
    for (const float value : replay.reference.picture) EXPECT_EQ(value, 1.0F);
}

} // namespace workload_csg_test
