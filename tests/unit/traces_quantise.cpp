// A3: positions in 16 bits are within half a step of where they were, and are drawn there.
#include "pipeline/functional/vertex_fetch.hpp"
#include "tests/support/preparation_kit.hpp"
#include "traces/preparation/quantise.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck/gtest.h>

namespace traces_quantise_test {

using namespace tests;
using pipeline::ComponentType;
using pipeline::Semantic;
using traces::QuantiseBox;
using traces::QuantiseGrid;
using traces::Scene;

/// A float of any exponent from 2^-120 to 2^120, of either sign.
float any_float(sim::Random& random) {
    const int exponent = static_cast<int>(random.below(240)) - 120;
    const double value = std::ldexp(1.0 + random.uniform(), exponent);
    return static_cast<float>(random.below(2) == 0 ? value : -value);
}

/// Points between two corners, the corners among them.
std::vector<glm::vec3> points_between(const glm::vec3& lo, const glm::vec3& hi, sim::Random& random) {
    std::vector<glm::vec3> points{lo, hi};
    for (int i = 0; i < 200; ++i) {
        glm::vec3 point;
        for (int axis = 0; axis < 3; ++axis) {
            const double place = random.uniform();
            const double value = (1.0 - place) * static_cast<double>(lo[axis]) + place * static_cast<double>(hi[axis]);
            point[axis] = std::clamp(static_cast<float>(value), lo[axis], hi[axis]);
        }
        points.push_back(point);
    }
    return points;
}

/// The largest error of the round trip on any axis, in units of the bound extent / 131068; in 64-bit mantissas.
long double worst_of_bound(const std::vector<glm::vec3>& points, const QuantiseGrid& grid) {
    long double worst = 0.0L;
    for (const glm::vec3& point : points) {
        const std::array<std::int16_t, 3> q = grid.quantise(point);
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const long double extent = grid.extent[axis], lo = grid.lo[axis];
            if (extent == 0.0L) {
                EXPECT_EQ(q[i], 0);
                continue;
            }
            const long double back = (static_cast<long double>(q[i]) / 32767.0L + 1.0L) / 2.0L * extent;
            const long double error = std::fabs(back - (static_cast<long double>(point[axis]) - lo));
            worst = std::max(worst, error / (extent / 131068.0L));
        }
    }
    return worst;
}

RC_GTEST_PROP(Quantise, G11_RoundTripErrorIsAtMostTheExtentOver131068InAnyBox, ()) {
    sim::Random random(*rc::gen::inRange<std::uint64_t>(1, 1'000'000'000), "box");
    glm::vec3 lo, hi;
    for (int axis = 0; axis < 3; ++axis) {
        const float a = any_float(random), b = any_float(random);
        lo[axis] = std::min(a, b);
        hi[axis] = std::max(a, b);
    }
    const std::vector<glm::vec3> points = points_between(lo, hi, random);
    for (const QuantiseBox box : {QuantiseBox::axes, QuantiseBox::cube}) {
        const QuantiseGrid grid = QuantiseGrid::around(points, box);
        RC_ASSERT(worst_of_bound(points, grid) <= 1.0L + 1e-6L);
    }
}

RC_GTEST_PROP(Quantise, G11_BoxesFarFromTheOriginAndAFewStepsOfFloatsWideKeepTheBound, ()) {
    sim::Random random(*rc::gen::inRange<std::uint64_t>(1, 1'000'000'000), "far");
    glm::vec3 lo, hi;
    for (int axis = 0; axis < 3; ++axis) {
        lo[axis] = hi[axis] = any_float(random);
        const std::uint64_t steps = random.below(1000);
        for (std::uint64_t i = 0; i < steps; ++i)
            hi[axis] = std::nextafter(hi[axis], std::numeric_limits<float>::max());
    }
    const std::vector<glm::vec3> points = points_between(lo, hi, random);
    RC_ASSERT(worst_of_bound(points, QuantiseGrid::around(points, QuantiseBox::axes)) <= 1.0L + 1e-6L);
}

TEST(Quantise, G11_TheBoundIsReachedAndCornersOfTheBoxAreExact) {
    std::vector<glm::vec3> points{{-1, 0, 5}, {1, 65534, 5}, {0, 0.5F, 5}, {0, 32767.5F, 5}};
    const QuantiseGrid grid = QuantiseGrid::around(points, QuantiseBox::axes);
    EXPECT_EQ(grid.quantise(points[0]), (std::array<std::int16_t, 3>{-32767, -32767, 0}));
    EXPECT_EQ(grid.quantise(points[1]), (std::array<std::int16_t, 3>{32767, 32767, 0}));
    EXPECT_NEAR(static_cast<double>(worst_of_bound(points, grid)), 1.0, 1e-9); // half a step of size 1
    EXPECT_EQ(grid.step(), glm::dvec3(2.0 / 65534.0, 1.0, 1.0)); // the axis without extent takes the longest
}

std::vector<glm::vec3> world_positions(const Scene& scene) {
    std::vector<glm::vec3> list;
    for (const pipeline::Draw& draw : scene.draws) {
        const pipeline::Geometry& geometry = scene.resources->geometries[draw.geometry];
        const pipeline::AttributeReader read(*scene.resources, *geometry.find(Semantic::position));
        for (const glm::mat4& matrix : draw.instances)
            for (std::uint32_t i = 0; i < geometry.vertex_count; ++i)
                list.emplace_back(matrix * glm::vec4(glm::vec3(read(i)), 1.0F));
    }
    return list;
}

Scene hills_at(const glm::mat4& first, const glm::mat4& second) {
    Scene scene = scene_of({hill_mesh(20, 15, 1)}, traces::VertexLayout::interleaved);
    scene.draws[0].instances = {first, second};
    traces::finish_scene(scene);
    return scene;
}

TEST(Quantise, G11_InstanceMatricesPutPositionsBackWithinTheBound) {
    glm::mat4 turned(0.0F); // by a quarter, and twice as large
    turned[0][1] = 2.0F;
    turned[1][0] = -2.0F;
    turned[2][2] = 2.0F;
    turned[3] = glm::vec4(7, -3, 2, 1);
    const Scene scene = hills_at(glm::mat4(1.0F), turned);
    for (const char* spec : {"quantise", "quantise?box=cube", "quantise?normals=s16&align=1"}) {
        SCOPED_TRACE(spec);
        const traces::PreparedScene result = prepared(scene, spec);
        const auto* position = result.scene.resources->geometries[0].find(Semantic::position);
        EXPECT_EQ(position->type, ComponentType::s16);
        EXPECT_EQ(position->components, 3);
        EXPECT_EQ(result.scene.draws.size(), 1U);
        ASSERT_TRUE(result.steps[0].position_error.has_value());
        // Twice the distance from the middle to a corner of a cell of the longest axis, 20 wide; floats add their own.
        const double bound = 2.0 * std::sqrt(3.0) * 20.0 / 131068.0 + 2e-5;
        EXPECT_LE(*result.steps[0].position_error, bound);
        EXPECT_GT(*result.steps[0].position_error, 1e-6);
        const auto before = world_positions(scene), after = world_positions(result.scene);
        ASSERT_EQ(before.size(), after.size());
        double worst = 0.0;
        for (std::size_t i = 0; i < before.size(); ++i)
            worst = std::max(worst, static_cast<double>(glm::distance(before[i], after[i])));
        EXPECT_LE(worst, bound);
        EXPECT_NEAR(worst, *result.steps[0].position_error, 1e-5);
        EXPECT_EQ(result.steps[0].after.triangles, result.steps[0].before.triangles);
        EXPECT_EQ(result.steps[0].after.vertex_shader_runs, result.steps[0].before.vertex_shader_runs);
    }
}

TEST(Quantise, PositionsTakeFewerBytes) {
    const Scene scene = hills_at(glm::mat4(1.0F), glm::mat4(1.0F));
    const traces::PreparedScene result = prepared(scene, "quantise?normals=s8");
    // 12 + 12 + 4 bytes become 6 + 3 + 4, in elements of 8, 4 and 4.
    EXPECT_EQ(result.steps[0].before.vertex_bytes, 21U * 16U * 28U);
    EXPECT_EQ(result.steps[0].after.vertex_bytes, 21U * 16U * 13U);
    for (const auto& attribute : result.scene.resources->geometries[0].attributes) EXPECT_EQ(attribute.stride, 16U);
}

/// The direction a normal has after the cofactors of its draw's matrix.
glm::dvec3 world_normal(const Scene& scene, std::uint32_t vertex) {
    const pipeline::Geometry& geometry = scene.resources->geometries[0];
    const glm::dvec3 normal{
        glm::vec3(pipeline::AttributeReader(*scene.resources, *geometry.find(Semantic::normal))(vertex))};
    const glm::dmat3 m{glm::mat3(scene.draws[0].instances[0])};
    return glm::normalize(normal.x * glm::cross(m[1], m[2]) + normal.y * glm::cross(m[2], m[0]) +
                          normal.z * glm::cross(m[0], m[1]));
}

TEST(Quantise, NormalsPointWhereTheyDidWhateverTheBox) {
    glm::mat4 stretched(1.0F);
    stretched[1][1] = 3.0F;
    const Scene scene = hills_at(stretched, stretched);
    for (const auto& [spec, tolerance] : {std::pair{"quantise", 1e-5},
                                          {"quantise?box=cube", 1e-6},
                                          {"quantise?box=cube&normals=s16", 1e-4},
                                          {"quantise?box=cube&normals=s8", 0.02}}) {
        const traces::PreparedScene result = prepared(scene, spec);
        double worst = 0.0;
        for (std::uint32_t i = 0; i < 21 * 16; ++i)
            worst = std::max(worst, glm::distance(world_normal(scene, i), world_normal(result.scene, i)));
        EXPECT_LE(worst, tolerance) << spec;
    }
}

TEST(Quantise, CoarseNormalsOfAFlatBoxAreNotedWithTheRemedy) {
    traces::Mesh flat = hill_mesh(20, 20, 1);
    for (glm::vec3& position : flat.positions) position.y *= 1e-3F;
    const traces::PreparedScene bent = prepared(scene_of({flat}), "quantise?normals=s8");
    ASSERT_EQ(bent.steps[0].notes.size(), 2U);
    EXPECT_NE(bent.steps[0].notes[1].find("box=cube"), std::string::npos);
    const traces::PreparedScene kept = prepared(scene_of({flat}), "quantise?normals=s8&box=cube");
    ASSERT_EQ(kept.steps[0].notes.size(), 2U);
    EXPECT_EQ(kept.steps[0].notes[1].find("box=cube"), std::string::npos);
}

TEST(Quantise, G11_WithoutExtentNothingMoves) {
    traces::Mesh flat;
    flat.name = "flat";
    flat.positions = {{0, 3, 0}, {8, 3, 0}, {0, 3, 8}};
    traces::Mesh point = flat;
    point.positions = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    const Scene scene = scene_of({flat, point});
    const traces::PreparedScene result = prepared(scene, "quantise");
    const auto before = world_positions(scene), after = world_positions(result.scene);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(after[i].y, 3.0F);
    for (std::size_t i = 3; i < 6; ++i) EXPECT_EQ(after[i], before[i]);
    EXPECT_LT(*result.steps[0].position_error, 1e-6);
}

TEST(Quantise, BoxesTooSmallForAMatrixStayAsTheyAre) {
    traces::Mesh tiny = hill_mesh(2, 2, 1);
    for (glm::vec3& position : tiny.positions) position *= 1e-36F;
    const Scene scene = scene_of({tiny});
    const traces::PreparedScene result = prepared(scene, "quantise");
    EXPECT_EQ(result.scene.resources->geometries[0].find(Semantic::position)->type, ComponentType::f32);
    EXPECT_EQ(triangle_values(scene, true), triangle_values(result.scene, true));
    ASSERT_EQ(result.steps[0].notes.size(), 2U);
    EXPECT_NE(result.steps[0].notes[1].find("too small"), std::string::npos);
}

} // namespace traces_quantise_test
