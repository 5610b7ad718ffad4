// Generators through the functional front end: what they draw lands exactly where they say.
#include "pipeline/functional/front_end.hpp"
#include "pipeline/reference.hpp"
#include "traces/camera.hpp"
#include "traces/workloads.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <string>
#include <vector>

namespace scenes_generators_test {

using pipeline::FragmentStream;
using pipeline::Quad;

struct Drawn {
    traces::Scene scene;
    FragmentStream stream;
};

Drawn draw(const std::string& spec, std::uint32_t width, std::uint32_t height) {
    Drawn result;
    result.scene = traces::load_scene(spec);
    std::vector<std::uint32_t> all(result.scene.draws.size());
    std::iota(all.begin(), all.end(), 0U);
    result.stream = pipeline::rasterize(*result.scene.resources, result.scene.draws, all,
                                        traces::make_view(result.scene, "auto", width, height));
    return result;
}

std::vector<std::uint32_t> fragments_per_pixel(const FragmentStream& stream) {
    std::vector<std::uint32_t> counts(std::size_t{stream.width} * stream.height);
    for (const Quad& quad : stream.quads)
        for (unsigned i = 0; i < 4; ++i)
            if ((quad.alive >> i & 1U) != 0) ++counts[(quad.y + i / 2) * stream.width + quad.x + i % 2];
    return counts;
}

TEST(SceneGenerators, StackLayersAreOneQuadOfFourPixelsEach) {
    for (const auto& [width, height] : {std::pair{512U, 512U}, std::pair{640U, 480U}, std::pair{333U, 211U}}) {
        const Drawn stack = draw("gen:stack?n=64", width, height);
        ASSERT_EQ(stack.stream.quads.size(), 64U);
        for (std::size_t i = 0; i < 64; ++i) {
            const Quad& quad = stack.stream.quads[i];
            EXPECT_EQ(quad.x, 8U);
            EXPECT_EQ(quad.y, 8U);
            EXPECT_EQ(quad.covered, 15U);
            for (const float depth : stack.stream.depths[i])
                EXPECT_NEAR(depth, (static_cast<float>(i) + 1.0F) / 65.0F, 1e-6F);
        }
    }
}

TEST(SceneGenerators, StackOfAnyRectangleCoversItsPixelsNTimes) {
    const Drawn stack = draw("gen:stack?n=5&x=3&y=10&w=17&h=6", 64, 32);
    const auto counts = fragments_per_pixel(stack.stream);
    for (std::uint32_t y = 0; y < 32; ++y)
        for (std::uint32_t x = 0; x < 64; ++x)
            EXPECT_EQ(counts[y * 64 + x], x >= 3 && x < 20 && y >= 10 && y < 16 ? 5U : 0U) << x << "," << y;
}

TEST(SceneGenerators, StackOrdersDepthsAsAsked) {
    const auto depths = [](const char* order) {
        std::vector<float> list;
        for (const auto& quad : draw(std::string("gen:stack?n=32&order=") + order, 32, 32).stream.depths)
            list.push_back(quad[0]);
        return list;
    };
    const auto front = depths("front-to-back"), back = depths("back-to-front"), random = depths("random");
    EXPECT_TRUE(std::is_sorted(front.begin(), front.end()));
    EXPECT_TRUE(std::is_sorted(back.rbegin(), back.rend()));
    EXPECT_FALSE(std::is_sorted(random.begin(), random.end()));
    EXPECT_TRUE(std::is_permutation(random.begin(), random.end(), front.begin()));
}

TEST(SceneGenerators, QuadsCoverEveryPixelOfAnyScreenNTimes) {
    for (const auto& [width, height] : {std::pair{64U, 64U}, std::pair{37U, 21U}, std::pair{1U, 1U}}) {
        const auto counts = fragments_per_pixel(draw("gen:quads?n=7", width, height).stream);
        EXPECT_EQ(std::count(counts.begin(), counts.end(), 7U), std::ptrdiff_t{width} * height);
    }
}

TEST(SceneGenerators, RandomQuadsAreOneWholeQuadEachAndFillTheirArea) {
    // The area is the screen itself: triangles of the last column must not lose pixels at its edge.
    const Drawn random = draw("gen:random-quads?n=20000&area=4096", 64, 64);
    ASSERT_EQ(random.stream.quads.size(), 20000U);
    for (const Quad& quad : random.stream.quads) ASSERT_EQ(quad.covered, 15U);
    const auto counts = fragments_per_pixel(random.stream);
    EXPECT_EQ(std::count(counts.begin(), counts.end(), 0U), 0);
    const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
    EXPECT_GT(*least, 2U); // mean 19.5
    EXPECT_LT(*most, 50U);
}

TEST(SceneGenerators, K4_RandomQuadsMissTheirPredecessorsAsOftenAsPredicted) {
    const Drawn drawn = draw("gen:random-quads?n=200000&area=4096", 64, 64);
    traces::WorkloadOptions options;
    options.set("entry=z");
    const auto view = traces::make_view(drawn.scene, "auto", 64, 64);
    const auto frame = traces::build_frame(drawn.scene, view, "transparency", options);
    const auto image = pipeline::run_reference(frame, std::span(&drawn.stream, 1), 256);
    const double share = static_cast<double>(image.missed_reads) / static_cast<double>(drawn.stream.fragments);
    EXPECT_NEAR(share, 0.221, 0.02);
}

TEST(SceneGenerators, LongDiscsOverlapAsOftenAsAsked) {
    for (const double overlap : {1.0, 8.0, 40.0}) {
        const Drawn discs = draw("gen:discs?n=3000&overlap=" + std::to_string(overlap), 512, 512);
        EXPECT_NEAR(static_cast<double>(discs.stream.fragments) / (512.0 * 512.0), overlap, 0.01 * overlap);
    }
}

TEST(SceneGenerators, GrassIsInViewOfItsCamera) {
    const Drawn grass = draw("gen:grass?blades=20000", 256, 256);
    std::size_t drawn = 0;
    for (const auto& primitive : grass.stream.primitives)
        drawn += primitive.fate != pipeline::PrimitiveFate::culled_outside ? 1U : 0U;
    EXPECT_GT(drawn, grass.stream.primitives.size() / 2);
    const auto counts = fragments_per_pixel(grass.stream);
    EXPECT_LT(std::count(counts.begin(), counts.end(), 0U), 256 * 256 * 6 / 10);
}

TEST(SceneGenerators, BlobIsSeenWholeAndHasDepth) {
    const Drawn blob = draw("gen:blob?triangles=40000", 256, 256);
    for (const auto& primitive : blob.stream.primitives)
        ASSERT_NE(primitive.fate, pipeline::PrimitiveFate::culled_outside);
    const auto counts = fragments_per_pixel(blob.stream);
    const auto covered = 256 * 256 - std::count(counts.begin(), counts.end(), 0U);
    EXPECT_GT(covered, 256 * 256 / 4);
    // A closed surface is entered as often as it is left; some pixels of the outline see one side only.
    EXPECT_GT(*std::max_element(counts.begin(), counts.end()), 3U);
    const double mean = static_cast<double>(blob.stream.fragments) / static_cast<double>(covered);
    EXPECT_GE(mean, 2.0);
    const auto odd = std::count_if(counts.begin(), counts.end(), [](std::uint32_t count) { return count % 2 != 0; });
    EXPECT_LT(odd, covered / 20);
}

TEST(SceneGenerators, SoupHasManyLayers) {
    const Drawn soup = draw("gen:grid-soup?boxes=3000&boxes_per_draw=700", 128, 128);
    EXPECT_EQ(soup.scene.draws.size(), 5U);
    const auto counts = fragments_per_pixel(soup.stream);
    EXPECT_GT(*std::max_element(counts.begin(), counts.end()), 8U);
}

} // namespace scenes_generators_test
