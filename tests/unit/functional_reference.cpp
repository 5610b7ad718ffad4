// SEQ: frames in submission order; the constant-distance mode.
#include "pipeline/functional/front_end.hpp"
#include "pipeline/reference.hpp"
#include "sim/check.hpp"
#include "sim/random.hpp"
#include "tests/support/functional_scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace pipeline {
namespace {

/// Keeps the k smallest depths, sorted (A6); entries are (r, g, b, depth) or just the depth.
class SmallestDepths : public ModifyProgram {
  public:
    SmallestDepths(std::uint32_t k, std::uint32_t floats) : ModifyProgram(k, floats) {}
    std::string_view id() const override { return "smallest"; }
    std::string_view summary() const override { return "for tests"; }
    ProgramCost cost() const override { return {1}; }
    OrderNeed order_need() const override { return OrderNeed::any; }
    bool needs_texture() const override { return false; }
    bool needs_colour() const override { return floats_per_entry() == 4; }
    std::uint32_t depth_slot() const override { return floats_per_entry() - 1; }
    void clear(float* pixel) const override { std::fill(pixel, pixel + floats_per_pixel(), 2.0F); }
    bool insert(float* pixel, const float* fragment) const override {
        const std::uint32_t n = floats_per_entry();
        std::uint32_t place = k();
        while (place > 0 && fragment[depth_slot()] < pixel[(place - 1) * n + depth_slot()]) --place;
        if (place == k()) return false;
        std::copy_backward(pixel + place * n, pixel + (k() - 1) * n, pixel + k() * n);
        std::copy(fragment, fragment + n, pixel + place * n);
        return true;
    }
    void make_entry(const Fragment& fragment, float* entry) const override {
        if (floats_per_entry() == 4) std::copy(fragment.rgba, fragment.rgba + 3, entry);
        entry[depth_slot()] = fragment.depth;
    }
};

/// A frame over a scene of rectangles, each draw a layer over the whole picture unless it says otherwise.
struct FrameKit {
    tests::FunctionalScene scene;
    Frame frame;

    FrameKit(std::uint32_t width, std::uint32_t height) : scene(width, height) {
        frame.depth_format = SurfaceFormat::d32f;
        frame.colour_format = SurfaceFormat::rgba32f;
    }

    std::uint32_t add_layer(float depth, const glm::vec4& colour) {
        Material material = scene.resources.materials[0];
        material.base_colour = colour;
        const auto w = static_cast<float>(scene.view.width), h = static_cast<float>(scene.view.height);
        return scene.add(tests::rectangle(0, 0, w, h, depth), scene.add_material(material));
    }

    Pass& add_pass(const std::string& name, std::vector<std::uint32_t> draws) {
        Pass pass;
        pass.name = name;
        pass.draws = std::move(draws);
        frame.passes.push_back(pass);
        return frame.passes.back();
    }

    Pass& add_pass(const std::string& name, PassKind kind) {
        Pass& pass = add_pass(name, std::vector<std::uint32_t>{});
        pass.kind = kind;
        return pass;
    }

    ReferenceImage run(QuadId delay = 1, unsigned threads = 0) {
        scene.resources.place();
        scene.resources.validate("scene");
        frame.resources = std::make_shared<Resources>(scene.resources);
        frame.draws = scene.draws;
        frame.view = scene.view;
        tests::bind_surfaces(frame);
        std::vector<FragmentStream> streams;
        for (const Pass& pass : frame.passes)
            if (pass.kind == PassKind::draw)
                streams.push_back(rasterize(scene.resources, scene.draws, pass.draws, scene.view));
        return run_reference(frame, streams, delay, threads);
    }
};

TEST(Reference, TheNearestFragmentWinsAndTheFirstOfEqualOnesStays) {
    FrameKit kit(10, 6);
    kit.add_layer(0.5F, {1, 0, 0, 1});
    kit.add_layer(0.25F, {0, 1, 0, 1});
    kit.add_layer(0.25F, {0, 0, 1, 1});
    kit.add_layer(0.75F, {1, 1, 0, 1});
    Pass& pass = kit.add_pass("opaque", {0, 1, 2, 3});
    pass.states[0].depth = {true, true};
    pass.targets = {tests::colour_surface};
    const ReferenceImage image = kit.run();
    ASSERT_EQ(image.depth.size(), 60U);
    for (std::size_t i = 0; i < 60; ++i) {
        EXPECT_EQ(image.depth[i], 0.25F);
        EXPECT_EQ(image.colour[i * 4 + 1], 1.0F);
        EXPECT_EQ(image.colour[i * 4 + 2], 0.0F);
        EXPECT_EQ(image.depth_complexity[i], 4U);
    }
    EXPECT_TRUE(image.kbuffer.empty());
}

TEST(Reference, DepthsThatAreEqualInTheFormatAreEqual) {
    for (const SurfaceFormat format : {SurfaceFormat::d16, SurfaceFormat::d24}) {
        FrameKit kit(4, 4);
        kit.add_layer(0.4F, {1, 0, 0, 1});
        kit.add_layer(0.4F - 0x1p-20F, {0, 1, 0, 1});
        Pass& pass = kit.add_pass("opaque", {0, 1});
        pass.states[0].depth = {true, true};
        pass.targets = {tests::colour_surface};
        kit.frame.depth_format = format;
        EXPECT_EQ(kit.run().colour[0], format == SurfaceFormat::d16 ? 1.0F : 0.0F);
    }
}

TEST(Reference, UncoveredPixelsHaveBackgroundAndFarthestDepth) {
    FrameKit kit(4, 4);
    kit.scene.add(tests::rectangle(0, 0, 2, 4));
    Pass& pass = kit.add_pass("opaque", {0});
    pass.states[0].depth = {true, true};
    pass.targets = {tests::colour_surface};
    kit.frame.background = glm::vec4(0.25F, 0.5F, 0.75F, 1.0F);
    const ReferenceImage image = kit.run();
    EXPECT_EQ(image.depth[3], 1.0F);
    EXPECT_EQ(image.colour[3 * 4], 0.25F);
    EXPECT_EQ(image.depth[0], 0.5F);
    EXPECT_EQ(image.depth_complexity[3], 0U);
}

/// `count` layers at random depths under a program that keeps k depths; returns the depths in submission order.
std::vector<float> add_random_layers(FrameKit& kit, std::uint32_t count, std::uint32_t k) {
    sim::Random random(3, "layers");
    std::vector<float> depths;
    std::vector<std::uint32_t> draws;
    for (std::uint32_t i = 0; i < count; ++i) {
        depths.push_back(static_cast<float>(random.uniform()));
        draws.push_back(kit.add_layer(depths.back(), {1, 1, 1, 1}));
    }
    kit.add_pass("peel", draws).kbuffer = tests::kbuffer_surface;
    kit.frame.program = std::make_shared<SmallestDepths>(k, 1);
    return depths;
}

TEST(Reference, KeepsTheNearestLayersOfEveryPixel) {
    FrameKit kit(33, 17);
    std::vector<float> depths = add_random_layers(kit, 12, 5);
    const ReferenceImage image = kit.run();
    std::sort(depths.begin(), depths.end());
    ASSERT_EQ(image.kbuffer.size(), 33U * 17U * 8U);
    for (std::size_t pixel = 0; pixel < 33U * 17U; ++pixel) {
        for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(image.kbuffer[pixel * 8 + i], depths[i], 1e-6F);
        EXPECT_EQ(image.depth_complexity[pixel], 12U);
    }
    EXPECT_EQ(image.missed_reads, 0U);
    EXPECT_TRUE(image.depth.empty());
    EXPECT_TRUE(image.picture.empty());
}

TEST(Reference, CountsAcceptedInsertions) {
    for (const bool front_to_back : {true, false}) {
        FrameKit kit(8, 8);
        std::vector<std::uint32_t> draws;
        for (int i = 0; i < 9; ++i) {
            const float depth = 0.1F * static_cast<float>(front_to_back ? i : 9 - i);
            draws.push_back(kit.add_layer(depth, {1, 1, 1, 1}));
        }
        kit.add_pass("peel", draws).kbuffer = tests::kbuffer_surface;
        kit.frame.program = std::make_shared<SmallestDepths>(4, 1);
        EXPECT_EQ(kit.run().accepted_insertions, 64U * (front_to_back ? 4U : 9U));
    }
}

TEST(Reference, AReadOnlyDepthTestKeepsHiddenFragmentsOut) {
    FrameKit kit(8, 8);
    const std::uint32_t wall = kit.add_layer(0.5F, {1, 1, 1, 1});
    const std::uint32_t before = kit.add_layer(0.25F, {1, 1, 1, 1});
    const std::uint32_t behind = kit.add_layer(0.75F, {1, 1, 1, 1});
    Pass& opaque = kit.add_pass("opaque", {wall});
    opaque.states[0].depth = {true, true};
    Pass& peel = kit.add_pass("peel", {before, behind, wall});
    peel.kbuffer = tests::kbuffer_surface;
    peel.states[0].depth = {true, false};
    kit.frame.program = std::make_shared<SmallestDepths>(4, 1);
    const ReferenceImage image = kit.run();
    EXPECT_EQ(image.kbuffer[0], 0.25F);
    EXPECT_EQ(image.kbuffer[1], 2.0F);
    EXPECT_EQ(image.depth_complexity[0], 1U); // only what reached the k-buffer
    EXPECT_EQ(image.depth[0], 0.5F);
}

TEST(Reference, ClearPassesSetSurfacesBack) {
    FrameKit kit(8, 8);
    const std::uint32_t layer = kit.add_layer(0.5F, {1, 0, 0, 1});
    Pass& first = kit.add_pass("first", {layer});
    first.states[0].depth = {true, true};
    first.targets = {tests::colour_surface};
    first.kbuffer = tests::kbuffer_surface;
    kit.frame.program = std::make_shared<SmallestDepths>(1, 1);
    kit.add_pass("clear", PassKind::clear).clears = {tests::depth_surface, tests::colour_surface,
                                                     tests::kbuffer_surface};
    const ReferenceImage image = kit.run();
    EXPECT_EQ(image.depth[0], 1.0F);
    EXPECT_EQ(image.colour[1], 1.0F); // the background is white
    EXPECT_EQ(image.kbuffer[0], 2.0F);
}

/// K1: what is left of a stack of `count` one-quad fragments, the n-th at depth n / count, when reads lag `delay`
/// quads.
std::vector<float> survivors_of_stack(std::uint32_t count, QuadId delay, std::uint32_t k) {
    FrameKit kit(2, 2);
    std::vector<std::uint32_t> draws;
    tests::MeshData triangle;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float depth = static_cast<float>(i) / static_cast<float>(count);
        triangle.positions = {{-1, -1, depth}, {8, -1, depth}, {-1, 8, depth}};
        draws.push_back(kit.scene.add(triangle));
    }
    kit.add_pass("peel", draws).kbuffer = tests::kbuffer_surface;
    kit.frame.program = std::make_shared<SmallestDepths>(k, 1);
    const ReferenceImage image = kit.run(delay);
    std::vector<float> entries(image.kbuffer.begin(), image.kbuffer.begin() + k);
    entries.erase(std::remove(entries.begin(), entries.end(), 2.0F), entries.end());
    return entries;
}

TEST(Reference, K1StackKeepsTheChainOfConstantDistance) {
    for (const QuadId delay : {1U, 8U, 16U, 64U, 128U}) {
        std::vector<float> chain;
        for (int i = 63; i >= 0; i -= static_cast<int>(delay)) chain.push_back(static_cast<float>(i) / 64.0F);
        std::sort(chain.begin(), chain.end());
        EXPECT_EQ(survivors_of_stack(64, delay, 64), chain) << delay;
        chain.resize(std::min<std::size_t>(chain.size(), 4));
        EXPECT_EQ(survivors_of_stack(64, delay, 4), chain) << delay;
    }
}

TEST(Reference, ConstantDistanceCountsReadsThatMissAPredecessor) {
    FrameKit kit(2, 2);
    std::vector<std::uint32_t> draws;
    for (int i = 0; i < 10; ++i) draws.push_back(kit.add_layer(0.5F, {1, 1, 1, 1}));
    kit.add_pass("peel", draws).kbuffer = tests::kbuffer_surface;
    kit.frame.program = std::make_shared<SmallestDepths>(4, 1);
    // A layer is two quads, one per triangle of the rectangle: a pixel's fragments are about two quads apart.
    EXPECT_EQ(kit.run(1).missed_reads, 0U);
    const ReferenceImage image = kit.run(1000);
    EXPECT_EQ(image.missed_reads, 4U * 9U);
    EXPECT_EQ(image.missed_pixels, 4U);
}

TEST(Reference, TheResultIsTheSameForAnyNumberOfThreads) {
    FrameKit kit(70, 50);
    add_random_layers(kit, 30, 4);
    for (const QuadId delay : {1U, 500U}) {
        const ReferenceImage alone = kit.run(delay, 1);
        for (const unsigned threads : {2U, 0U}) {
            const ReferenceImage image = kit.run(delay, threads);
            EXPECT_EQ(image.kbuffer, alone.kbuffer);
            EXPECT_EQ(image.accepted_insertions, alone.accepted_insertions);
            EXPECT_EQ(image.missed_reads, alone.missed_reads);
        }
    }
}

TEST(Reference, TheNumberOfStreamsIsThatOfTheDrawPasses) {
    FrameKit kit(4, 4);
    kit.add_pass("opaque", std::vector{kit.add_layer(0.5F, {1, 1, 1, 1})}).states[0].depth = {true, true};
    kit.run();
    EXPECT_THROW(run_reference(kit.frame, {}), sim::InternalError);
}

} // namespace
} // namespace pipeline
