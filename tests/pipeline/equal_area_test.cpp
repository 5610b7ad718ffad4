// On-chip bytes of every design, and comparisons of designs with the same number of them.
#include "pipeline/on_chip_area.hpp"
#include "reports/comparison.hpp"
#include "tests/support/replay.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using pipeline::GpuParams;
using pipeline::OnChipArea;
using support::Replay;

const Replay& discs() {
    static const Replay replay("gen:discs?n=20", {.width = 64, .height = 64});
    return replay;
}

std::unique_ptr<pipeline::KBufferDesign> design_named(const std::string& id, const std::vector<std::string>& set = {}) {
    sim::Config config;
    for (const std::string& setting : set) config.set(setting);
    return models::make_design(id, config);
}

OnChipArea area_of(const std::string& design, const GpuParams& gpu = {}, const std::vector<std::string>& set = {}) {
    return pipeline::on_chip_area(gpu, discs().frame, *design_named(design, set));
}

// k = 4 entries of colour and depth: 64 bytes a pixel, 256 for the stores of a quad, 64 for what a fragment is.
TEST(OnChipArea, PayloadsWaitInTheReorderBufferAndInTheQueuesOfTheRops) {
    GpuParams gpu;
    const std::uint64_t queues = std::uint64_t{pipeline::shape_of(gpu).rop_groups} * gpu.rop.queue;
    EXPECT_EQ(area_of("existing", gpu).payload_bytes, 256 * (gpu.reorder_quads() + queues));
    EXPECT_EQ(area_of("blender", gpu).payload_bytes, 64 * (gpu.reorder_quads() + queues));
    // A store from inside a critical section does not wait for its turn.
    EXPECT_EQ(area_of("interlock", gpu).payload_bytes, 256 * queues);
    gpu.rop.queue *= 4;
    EXPECT_EQ(area_of("blender", gpu).payload_bytes, 64 * (gpu.reorder_quads() + 4 * queues));
}

TEST(OnChipArea, OnlyCachesThatAreBuiltCount) {
    const GpuParams gpu;
    for (const char* design : {"existing", "blender", "linked-list"}) {
        const auto caches = area_of(design).tile_caches;
        EXPECT_EQ(caches.kbuffer, gpu.rop.kbuffer_cache_bytes) << design;
        EXPECT_EQ(caches.depth, 0U) << design;
    }
    EXPECT_EQ(area_of("blender").tile_caches.colour, 0U);
    EXPECT_EQ(area_of("linked-list").tile_caches.colour, gpu.rop.colour_cache_bytes)
        << "the pass that sorts writes entries as colours";
    const auto layers = area_of("multipass").tile_caches;
    EXPECT_EQ(layers.kbuffer, 0U);
    EXPECT_EQ(layers.depth, gpu.rop.depth_cache_bytes);
    EXPECT_EQ(layers.colour, gpu.rop.colour_cache_bytes);
    EXPECT_EQ(area_of("framebuffer-fetch").tile_caches.total(), 0U) << "tile memory stands in its place";
}

TEST(OnChipArea, WhatADesignAddsGrowsWithItsOptions) {
    EXPECT_EQ(area_of("existing").added_bytes(), 0U);
    EXPECT_GT(area_of("scoreboard", {}, {"scoreboard.side_buffer=256"}).added_bytes(),
              area_of("scoreboard").added_bytes());
    EXPECT_GT(area_of("cam", {}, {"cam.entries=64"}).added_bytes(),
              area_of("cam", {}, {"cam.entries=8"}).added_bytes());
    EXPECT_GT(area_of("detect").added_bytes(), 0U);
    GpuParams more;
    more.rop.units *= 2;
    EXPECT_EQ(area_of("blender", more).added_bytes(), 2 * area_of("blender").added_bytes());
    GpuParams fast;
    fast.rop.fast_clear = true;
    EXPECT_EQ(area_of("existing", fast).added_bytes(), fast.rop.clear_sectors / 8U) << "one bit for each sector";
}

TEST(OnChipArea, ARunSaysWhatTheFunctionSays) {
    for (const std::string& design : discs().designs()) {
        const auto run = discs().run(design);
        EXPECT_EQ(*run.area, pipeline::area_json(area_of(design))) << design;
        EXPECT_EQ(run.area->at("total_bytes"), run.area->at("tile_cache_bytes").get<std::uint64_t>() +
                                                   run.area->at("payload_bytes").get<std::uint64_t>() +
                                                   run.area->at("added_bytes").get<std::uint64_t>());
    }
}

std::uint64_t line_bytes(const OnChipArea& area, const pipeline::KBufferDesign& design) {
    const pipeline::Frame& frame = discs().frame;
    const auto sector = pipeline::sector_bytes(frame, design.plan(*frame.program, frame.view_of_kbuffer()));
    return std::max({area.tile_caches.depth != 0 ? sector.depth : 0, area.tile_caches.colour != 0 ? sector.colour : 0,
                     area.tile_caches.kbuffer != 0 ? sector.kbuffer : 0});
}

TEST(EqualArea, EveryDesignTakesTheBytesToWithinASectorOfEveryRopGroup) {
    const std::uint64_t groups = pipeline::shape_of({}).rop_groups;
    for (const std::string& design : discs().designs())
        for (const std::uint64_t budget : {200'001U, 524'288U, 1'000'003U}) {
            GpuParams gpu;
            const auto model = design_named(design);
            const auto fitted = pipeline::fit_caches(gpu, discs().frame, *model, budget);
            if (!fitted.fits) continue;
            gpu.rop = fitted.rop;
            const OnChipArea area = area_of(design, gpu);
            EXPECT_LE(area.total_bytes(), budget) << design;
            EXPECT_EQ(area.total_bytes(), fitted.needed) << design;
            if (area.tile_caches.total() == 0) continue;
            EXPECT_GT(area.total_bytes() + groups * line_bytes(area, *model), budget) << design;
        }
}

TEST(EqualArea, CachesOfOneMachineKeepTheirRatio) {
    GpuParams gpu;
    const auto model = design_named("multipass");
    const auto fitted = pipeline::fit_caches(gpu, discs().frame, *model, 1'000'000);
    ASSERT_TRUE(fitted.fits);
    const double before = double(gpu.rop.colour_cache_bytes) / gpu.rop.depth_cache_bytes;
    EXPECT_NEAR(double(fitted.rop.colour_cache_bytes) / fitted.rop.depth_cache_bytes, before, 0.02);
}

TEST(EqualArea, WhatIsNeededIsTheLeastThatFits) {
    for (const std::string& design : discs().designs()) {
        const auto model = design_named(design);
        const auto none = pipeline::fit_caches({}, discs().frame, *model, 1);
        ASSERT_FALSE(none.fits) << design;
        EXPECT_TRUE(pipeline::fit_caches({}, discs().frame, *model, none.needed).fits) << design;
        EXPECT_FALSE(pipeline::fit_caches({}, discs().frame, *model, none.needed - 1).fits) << design;
    }
}

reports::Comparison compared(std::uint64_t bytes) {
    reports::ComparisonRequest request;
    request.scene = "gen:discs?n=20";
    request.width = request.height = 64;
    request.designs = {"existing", "multipass", "blender", "interlock"};
    request.equal_area = bytes;
    return reports::compare(reports::prepare(request));
}

TEST(EqualArea, TheLargestDesignIsTheMeasureWhereNoneIsGiven) {
    const auto comparison = compared(0);
    ASSERT_TRUE(comparison.equal_area.has_value());
    EXPECT_TRUE(comparison.equal_area->does_not_fit.empty());
    EXPECT_EQ(comparison.equal_area->bytes, area_of("existing").total_bytes());
    EXPECT_EQ(comparison.runs[0].area->at("total_bytes"), comparison.equal_area->bytes);
    EXPECT_TRUE(comparison.variants[0].gpu_changes->empty());
    for (std::size_t i = 1; i < comparison.runs.size(); ++i) {
        EXPECT_LE(comparison.runs[i].area->at("total_bytes"), comparison.equal_area->bytes);
        EXPECT_FALSE(comparison.variants[i].gpu_changes->empty()) << comparison.runs[i].design;
        EXPECT_EQ(comparison.runs[i].wrong_pixels, 0U);
    }
}

TEST(EqualArea, WhatDoesNotFitIsNamedWithWhatItNeeds) {
    const auto comparison = compared(300'000);
    ASSERT_EQ(comparison.equal_area->does_not_fit.size(), 1U);
    EXPECT_EQ(comparison.equal_area->does_not_fit[0].name, "existing");
    EXPECT_GT(comparison.equal_area->does_not_fit[0].needed, 300'000U);
    EXPECT_EQ(comparison.runs.size(), 3U);
}

TEST(EqualArea, AVariantIsNamedAfterTheCachesThatItGot) {
    reports::ComparisonRequest request;
    request.scene = "gen:discs?n=20";
    request.width = request.height = 64;
    request.designs = {"blender?rop.kbuffer_cache_bytes=8192&rop.queue=32"};
    request.equal_area = 400'000;
    const auto comparison = reports::compare(reports::prepare(request));
    const auto& variant = comparison.variants.front();
    const std::string bytes = variant.gpu_changes->at("rop.kbuffer_cache_bytes").dump();
    ASSERT_NE(bytes, "8192");
    EXPECT_EQ(variant.label, "blender rop.kbuffer_cache_bytes=" + bytes + " rop.queue=32");
    EXPECT_EQ(variant.text, "blender?rop.kbuffer_cache_bytes=" + bytes + "&rop.queue=32");
}

} // namespace
