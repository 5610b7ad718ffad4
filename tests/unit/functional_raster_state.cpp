// What the state of a draw does before its fragments: viewport, scissor, culling, depth clamp and bias, planes of the
// user, provoking vertex.
#include "pipeline/functional/cull_and_clip.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <set>

namespace functional_raster_state_test {
namespace {

using namespace pipeline;

using tests::FunctionalScene;
using tests::MeshData;
using tests::rectangle;

FragmentStream rasterize(FunctionalScene& scene, const RasterState& state, FrontEndOptions options = {}) {
    options.states = {&state, 1};
    return scene.rasterize(options);
}

/// A rectangle that fills clip space.
FunctionalScene full_scene(std::uint32_t width, std::uint32_t height, std::uint32_t samples = 1) {
    FunctionalScene scene(width, height);
    scene.view.samples = samples;
    scene.add(rectangle(0, 0, static_cast<float>(width), static_cast<float>(height)));
    return scene;
}

bool lies_in(const PixelRectangle& r, std::int64_t x, std::int64_t y) {
    return x >= r.x && x < std::int64_t{r.x} + r.width && y >= r.y && y < std::int64_t{r.y} + r.height;
}

/// Every pixel in both rectangles is covered once, no other.
void expect_only(const FragmentStream& stream, const PixelRectangle& a, const PixelRectangle& b) {
    const auto counts = tests::coverage_counts(stream);
    for (std::uint32_t y = 0; y < stream.height; ++y)
        for (std::uint32_t x = 0; x < stream.width; ++x)
            ASSERT_EQ(counts[y * stream.width + x], lies_in(a, x, y) && lies_in(b, x, y) ? 1U : 0U) << x << ", " << y;
}

TEST(ViewportState, ClipSpaceFillsExactlyTheViewport) {
    for (const PixelRectangle& viewport : {PixelRectangle{0, 0, 40, 30},
                                           {3, 5, 17, 11},
                                           {8, 8, 16, 16},
                                           {-7, -9, 30, 20},
                                           {25, 21, 100, 9},
                                           {-50, -50, 200, 300},
                                           {39, 29, 1, 1}}) {
        FunctionalScene scene = full_scene(40, 30);
        RasterState state;
        state.viewport = viewport;
        expect_only(rasterize(scene, state), viewport, {0, 0, 40, 30});
    }
}

TEST(ViewportState, OutsideOfTheViewNothingIsDrawn) {
    for (const PixelRectangle& viewport : {PixelRectangle{40, 0, 10, 10}, {-10, 0, 10, 10}, {0, 16384, 16384, 16384}}) {
        FunctionalScene scene = full_scene(40, 30);
        RasterState state;
        state.viewport = viewport;
        const FragmentStream stream = rasterize(scene, state);
        EXPECT_EQ(stream.fragments, 0U);
        for (const Primitive& primitive : stream.primitives) EXPECT_EQ(primitive.fate, PrimitiveFate::culled_outside);
    }
}

TEST(ViewportState, OneThatIsTheViewIsTheDefault) {
    FunctionalScene scene = full_scene(37, 21);
    RasterState state;
    state.viewport = PixelRectangle{0, 0, 37, 21};
    EXPECT_TRUE(tests::equal(rasterize(scene, state), scene.rasterize()));
}

TEST(ScissorState, CutsPixelsNotPrimitives) {
    for (const std::uint32_t samples : {1U, 4U})
        for (const PixelRectangle& scissor : {PixelRectangle{0, 0, 40, 30},
                                              {3, 5, 17, 11},
                                              {8, 8, 16, 16},
                                              {-7, -9, 30, 20},
                                              {25, 21, 100, 9},
                                              {9, 9, 0, 5},
                                              {-2000000000, 0, 2000000001, 1},
                                              {2147483647, 2147483647, 4294967295U, 1}}) {
            FunctionalScene scene = full_scene(40, 30, samples);
            RasterState state;
            state.scissor = scissor;
            const FragmentStream stream = rasterize(scene, state);
            EXPECT_EQ(stream.triangles.size(), 2U);
            for (const Triangle& triangle : stream.triangles) EXPECT_GE(triangle.tiles, 1U);
            if (samples == 1) expect_only(stream, scissor, {0, 0, 40, 30});
            std::uint64_t expected = 0;
            for (std::uint32_t y = 0; y < 30; ++y)
                for (std::uint32_t x = 0; x < 40; ++x) expected += lies_in(scissor, x, y) ? samples : 0;
            EXPECT_EQ(stream.fragments, expected);
        }
}

RC_GTEST_PROP(ScissorState, LeavesTheQuadsOfTheWholePictureWithFewerPixels, ()) {
    const auto number = [](int from, int to) { return *rc::gen::inRange(from, to); };
    FunctionalScene scene(64, 48);
    MeshData mesh;
    for (int i = 0; i < 9; ++i) mesh.positions.emplace_back(number(-20, 90), number(-20, 70), 0.5F);
    scene.add(mesh);
    RasterState state;
    state.scissor = PixelRectangle{number(-5, 60), number(-5, 40), static_cast<std::uint32_t>(number(1, 50)),
                                   static_cast<std::uint32_t>(number(1, 50))};
    const auto whole = tests::coverage_counts(scene.rasterize());
    const auto cut = tests::coverage_counts(rasterize(scene, state));
    for (std::uint32_t y = 0; y < 48; ++y)
        for (std::uint32_t x = 0; x < 64; ++x)
            RC_ASSERT(cut[y * 64 + x] == (lies_in(*state.scissor, x, y) ? whole[y * 64 + x] : 0U));
}

TEST(CullingState, WindingByFaceTable) {
    for (const bool clockwise : {false, true})
        for (const bool front_is_clockwise : {false, true})
            for (const FaceCulling culling :
                 {FaceCulling::none, FaceCulling::front, FaceCulling::back, FaceCulling::both}) {
                FunctionalScene scene(32, 32);
                scene.resources.materials[0].double_sided = false; // is not asked
                MeshData mesh;
                mesh.positions = {{1, 1, 0.5F}, {20, 1, 0.5F}, {1, 20, 0.5F}};
                if (!clockwise) std::swap(mesh.positions[1], mesh.positions[2]);
                glm::mat4 mirror(1.0F); // is not asked either: the winding on the screen counts
                mirror[0][0] = -1.0F;
                mirror[3][0] = 32.0F;
                scene.add(mesh);
                scene.add(mesh, 0, mirror);
                RasterState state;
                state.culling = culling;
                state.front_is_clockwise = front_is_clockwise;
                const FragmentStream stream = rasterize(scene, state);
                for (const bool mirrored : {false, true}) {
                    const bool front = (clockwise != mirrored) == front_is_clockwise;
                    const bool culled = culling == FaceCulling::both ||
                                        (culling != FaceCulling::none && (culling == FaceCulling::front) == front);
                    EXPECT_EQ(stream.primitives[mirrored ? 1 : 0].fate,
                              culled ? PrimitiveFate::culled_facing : PrimitiveFate::drawn);
                }
            }
}

TEST(DepthClampState, KeepsWhatLiesBeyondThePlanes) {
    FunctionalScene scene(64, 192); // depth from -1 to 2 over the height of the picture
    MeshData mesh = rectangle(0, 0, 64, 192);
    mesh.positions[0].z = mesh.positions[1].z = -1.0F;
    mesh.positions[2].z = mesh.positions[3].z = 2.0F;
    scene.add(mesh);
    RasterState state;
    state.depth.clamp = true;
    const FragmentStream stream = rasterize(scene, state);
    EXPECT_EQ(stream.fragments, 64U * 192U);
    for (const Primitive& primitive : stream.primitives) EXPECT_FALSE(primitive.clipped);
    for (std::size_t i = 0; i < stream.quads.size(); ++i)
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const double row = stream.quads[i].y + static_cast<double>(lane / 2) + 0.5;
            EXPECT_NEAR(stream.depths[i][lane], std::clamp(row * 3.0 / 192.0 - 1.0, 0.0, 1.0), 1e-6);
        }
}

TEST(DepthClampState, CutsBehindTheEyeAllTheSame) {
    FunctionalScene scene(64, 64);
    scene.view.projection = glm::mat4(1.0F);
    scene.view.projection[2] = glm::vec4(0, 0, -1, -1); // w = -z
    scene.view.projection[3] = glm::vec4(0, 0, -0.2F, 0);
    scene.add({.positions = {{-1, -1, 5}, {1, -1, 5}, {0, -1, -5}, {-1, 0, 1}, {1, 0, 2}, {0, 1, 3}},
               .normals = {},
               .colours = {},
               .texcoords = {},
               .indices = {}});
    RasterState state;
    state.depth.clamp = true;
    const FragmentStream stream = rasterize(scene, state);
    EXPECT_EQ(stream.primitives[0].fate, PrimitiveFate::drawn);
    EXPECT_EQ(stream.primitives[1].fate, PrimitiveFate::culled_outside); // wholly behind the eye
    for (const auto count : tests::coverage_counts(stream)) EXPECT_LE(count, 1U);
    for (const auto& depths : stream.depths)
        for (const float depth : depths) EXPECT_TRUE(depth >= 0.0F && depth <= 1.0F);
}

/// Depths at the pixels (0, 0) and (1, 0) of a triangle whose depth grows by `slope` per pixel to the right.
std::array<float, 2> depths(const RasterState& state, double step, float slope, float depth) {
    FunctionalScene scene(64, 64);
    MeshData mesh;
    mesh.positions = {{0, 0, depth}, {64, 0, depth + 64 * slope}, {0, 64, depth}};
    scene.add(mesh);
    FrontEndOptions options;
    options.depth_step = step;
    const FragmentStream stream = rasterize(scene, state, options);
    return {stream.depths.at(0)[0], stream.depths.at(0)[1]};
}

RasterState biased(float slope, float constant) {
    RasterState state;
    state.depth.bias_slope = slope;
    state.depth.bias_constant = constant;
    return state;
}

TEST(DepthBias, ConstantCountsSmallestSteps) {
    for (const double step : {0x1p-16, 0x1p-24})
        for (const float constant : {-3.0F, 0.0F, 0.5F, 7.0F})
            EXPECT_EQ(depths(biased(0, constant), step, 0, 0.25F)[0],
                      static_cast<float>(0.25 + static_cast<double>(constant) * step));
}

TEST(DepthBias, StepOfFloatsIsThatOfTheGreatestDepth) {
    EXPECT_EQ(depths(biased(0, 5), 0.0, 0, 0.25F)[0], 0.25F + 5 * 0x1p-25F);
    EXPECT_EQ(depths(biased(0, 5), 0.0, 0, 0.1875F)[0], 0.1875F + 5 * 0x1p-26F);
    // The greatest depth of the corners is in [0.5, 1).
    EXPECT_EQ(depths(biased(0, 4), 0.0, 0x1p-7F, 0.25F)[0], static_cast<float>(0.25 + 0x1p-8 + 4 * 0x1p-24));
    EXPECT_EQ(depths(biased(0, 5), 0.0, 0, 0.0F)[0], 0.0F);
}

TEST(DepthBias, SlopeIsTheLargestStepPerPixel) {
    const auto plain = depths(biased(0, 0), 0x1p-24, 0x1p-8F, 0.25F);
    EXPECT_EQ(plain[1] - plain[0], 0x1p-8F);
    EXPECT_EQ(depths(biased(2, 0), 0x1p-24, 0x1p-8F, 0.25F)[0], plain[0] + 0x1p-7F);
    EXPECT_EQ(depths(biased(-1, 0), 0x1p-24, 0x1p-8F, 0.25F)[0], plain[0] - 0x1p-8F);
    EXPECT_EQ(depths(biased(2, 0), 0x1p-24, -0x1p-9F, 0.75F)[0], depths({}, 0x1p-24, -0x1p-9F, 0.75F)[0] + 0x1p-8F);
}

TEST(DepthBias, StaysWithinDepths) {
    EXPECT_EQ(depths(biased(0, 1e9F), 0x1p-24, 0, 0.25F)[0], 1.0F);
    EXPECT_EQ(depths(biased(0, -1e9F), 0x1p-24, 0, 0.25F)[0], 0.0F);
}

/// Column counts of a rectangle of 32x32 pixels that `planes` cut.
std::vector<std::uint32_t> columns(const std::vector<glm::vec4>& planes, FragmentStream& stream) {
    FunctionalScene scene = full_scene(32, 32);
    RasterState state;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        state.clip_plane[i] = planes[i];
        state.clip_planes = static_cast<std::uint8_t>(state.clip_planes | 1U << i);
    }
    stream = rasterize(scene, state);
    const auto counts = tests::coverage_counts(stream);
    std::vector<std::uint32_t> result(32);
    for (std::size_t i = 0; i < counts.size(); ++i) {
        EXPECT_LE(counts[i], 1U);
        result[i % 32] += counts[i];
    }
    return result;
}

TEST(UserClipPlanes, CutAtPixelsBelowAtAndAbove) {
    FragmentStream stream;
    for (const float at : {10.0F, 10.25F, 10.5F, 10.75F, 11.0F}) {
        const auto right = columns({{1, 0, 0, -at}}, stream); // keeps x >= at
        const auto left = columns({{-1, 0, 0, at}}, stream);
        for (std::size_t x = 0; x < 32; ++x) {
            const float centre = static_cast<float>(x) + 0.5F;
            EXPECT_EQ(right[x], centre >= at ? 32U : 0U) << at << " at column " << x; // a left edge owns its points
            EXPECT_EQ(left[x], centre < at ? 32U : 0U) << at << " at column " << x;
        }
    }
}

TEST(UserClipPlanes, VerticesOnThePlaneAreInside) {
    FragmentStream stream;
    columns({{1, 0, 0, 0}}, stream);
    EXPECT_EQ(stream.fragments, 1024U);
    for (const Primitive& primitive : stream.primitives) EXPECT_FALSE(primitive.clipped);
    columns({{1, 0, 0, -32}}, stream); // only corners lie on it
    EXPECT_EQ(stream.fragments, 0U);
    columns({{1, 0, 0, -33}}, stream);
    for (const Primitive& primitive : stream.primitives) EXPECT_EQ(primitive.fate, PrimitiveFate::culled_outside);
    columns({{0, 0, 0, -1}}, stream); // everything is outside of such a plane, of the next nothing
    EXPECT_EQ(stream.fragments, 0U);
    columns({{0, 0, 0, 0}}, stream);
    EXPECT_EQ(stream.fragments, 1024U);
}

TEST(UserClipPlanes, EightCutAnOctagon) {
    std::vector<glm::vec4> planes;
    for (int i = 0; i < 8; ++i) {
        const double turn = 0.3 + i * std::acos(-1.0) / 4;
        const glm::vec2 inwards(std::cos(turn), std::sin(turn));
        planes.emplace_back(inwards.x, inwards.y, 0.0F, 10.0F - 16.0F * (inwards.x + inwards.y));
    }
    FunctionalScene scene(32, 32);
    MeshData mesh;
    mesh.positions = {{-20, -20, 0.5F}, {100, -20, 0.5F}, {-20, 100, 0.5F}};
    scene.add(mesh);
    RasterState state;
    std::copy(planes.begin(), planes.end(), state.clip_plane.begin());
    state.clip_planes = 0xFF;
    const FragmentStream stream = rasterize(scene, state);
    EXPECT_EQ(stream.primitives[0].triangles, 6U); // a polygon of eight corners
    const auto counts = tests::coverage_counts(stream);
    for (std::uint32_t i = 0; i < 1024; ++i) {
        float least = 1e9F;
        for (const glm::vec4& plane : planes)
            least = std::min(least, glm::dot(plane, glm::vec4(static_cast<float>(i % 32) + 0.5F,
                                                              static_cast<float>(i / 32) + 0.5F, 0.5F, 1.0F)));
        if (std::fabs(least) > 0.01F) {
            EXPECT_EQ(counts[i], least > 0.0F ? 1U : 0U) << i;
        }
    }
}

// Both sides of a plane together cover what the triangles cover, each pixel once; the sides share the cut exactly.
RC_GTEST_PROP(UserClipPlanes, TwoSidesMakeTheWhole, ()) {
    const auto number = [](int from, int to) { return static_cast<float>(*rc::gen::inRange(from, to)); };
    FunctionalScene scene(64, 64);
    MeshData mesh;
    for (int i = 0; i < 6; ++i) mesh.positions.emplace_back(number(0, 640) / 10, number(0, 640) / 10, 0.5F);
    scene.add(mesh);
    const glm::vec4 plane(number(-9, 10), number(-9, 10), 0.0F, number(-300, 300));
    RasterState state;
    const auto counts = [&](const glm::vec4& side) {
        state.clip_planes = 1;
        state.clip_plane[0] = side;
        return tests::coverage_counts(rasterize(scene, state));
    };
    const auto whole = tests::coverage_counts(scene.rasterize()), front = counts(plane), back = counts(-plane);
    std::size_t different = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) different += front[i] + back[i] != whole[i] ? 1U : 0U;
    // New corners on the grid may move the outer edges by less than a sub-pixel unit.
    RC_ASSERT(different <= 4U);
}

/// Numbers of the vertices whose colours the primitives of a flat material have.
std::vector<std::uint32_t> provoking_vertices(Topology topology, ProvokingVertex which) {
    FunctionalScene scene(64, 64);
    scene.resources.materials[0].flat = true;
    MeshData mesh;
    for (std::uint32_t i = 0; i < 6; ++i) {
        // Every second one lies below, so that strips and fans have an area.
        const auto x = static_cast<float>(4 + 10 * i);
        mesh.positions.emplace_back(topology == Topology::triangle_fan && i == 0 ? glm::vec3(30, 60, 0.5F)
                                                                                 : glm::vec3(x, i % 2 * 30 + 2, 0.5F));
        mesh.colours.emplace_back(static_cast<float>(i) / 8, 0.0F, 0.0F, 1.0F);
    }
    scene.add(mesh);
    scene.resources.geometries[0].topology = topology;
    RasterState state;
    state.provoking = which;
    const FragmentStream stream = rasterize(scene, state);
    std::vector<std::uint32_t> result;
    for (const Primitive& primitive : stream.primitives) {
        std::set<float> reds;
        const Triangle& triangle = stream.triangles.at(primitive.first_triangle);
        for (QuadId quad = triangle.first_quad; quad < triangle.first_quad + triangle.quads; ++quad)
            for (std::size_t lane = 0; lane < 4; ++lane)
                if ((stream.quads[quad].covered >> lane & 1) != 0) reds.insert(stream.colours[quad][lane].r);
        EXPECT_EQ(reds.size(), 1U);
        result.push_back(reds.empty() ? 99 : static_cast<std::uint32_t>(std::lround(*reds.begin() * 8)));
    }
    return result;
}

TEST(ProvokingVertexState, IsThatOfTheTable) {
    using Numbers = std::vector<std::uint32_t>;
    const auto first = [](Topology topology) { return provoking_vertices(topology, ProvokingVertex::first); };
    const auto last = [](Topology topology) { return provoking_vertices(topology, ProvokingVertex::last); };
    EXPECT_EQ(first(Topology::triangles), (Numbers{0, 3}));
    EXPECT_EQ(last(Topology::triangles), (Numbers{2, 5}));
    EXPECT_EQ(first(Topology::triangle_strip), (Numbers{0, 1, 2, 3}));
    EXPECT_EQ(last(Topology::triangle_strip), (Numbers{2, 3, 4, 5}));
    EXPECT_EQ(first(Topology::triangle_fan), (Numbers{1, 2, 3, 4}));
    EXPECT_EQ(last(Topology::triangle_fan), (Numbers{2, 3, 4, 5}));
    EXPECT_EQ(first(Topology::points), (Numbers{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(last(Topology::lines), (Numbers{1, 3, 5}));
    EXPECT_EQ(first(Topology::line_strip), (Numbers{0, 1, 2, 3, 4}));
    EXPECT_EQ(first(Topology::line_loop), (Numbers{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(last(Topology::line_loop), (Numbers{1, 2, 3, 4, 5, 0}));
}

} // namespace
} // namespace functional_raster_state_test
