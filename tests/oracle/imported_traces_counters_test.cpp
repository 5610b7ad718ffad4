// What a machine counts when it replays apitrace files, beside what follows from their vertices and pixels alone.
#include "sim/check.hpp"
#include "tests/support/drawn_recording.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/replay.hpp"
#include "traces/glsl.hpp"
#include "traces/recording/record_program.hpp"

#include <atomic>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

namespace imported_traces_counters_test {

using drawn_recording::Drawn;
using pipeline::RunResult;
using support::counter;

namespace {

/// Nothing where the test is to be skipped, with the reason.
std::optional<traces::Recording> imported(const char* name, std::string& reason) {
    const auto file = ropsim_test::shared_file(std::filesystem::path("traces") / name);
    if (!file) reason = std::string(name) + " is not there";
    if (!traces::can_compile_glsl()) reason = "built without glslang (packages glslang-dev and spirv-tools)";
    if (!reason.empty()) return std::nullopt;
    const std::atomic<bool> stop{false};
    try {
        return traces::record_apitrace(*file, {}, stop).recording;
    } catch (const sim::InputError& error) {
        if (std::string(error.what()).find("which was not found: Debian package") == std::string::npos) throw;
        reason = error.what();
        return std::nullopt;
    }
}

/// One frame on hardware without a k-buffer, whose caches hold all of its surfaces.
RunResult replayed(const Drawn& drawn) {
    sim::Config config;
    const auto design = models::make_design("existing", config);
    pipeline::GpuParams gpu;
    gpu.rop.colour_cache_bytes = gpu.rop.depth_cache_bytes = 1U << 24U;
    pipeline::Machine machine(gpu, drawn.frame, drawn.streams, *design);
    return machine.run(drawn.image);
}

/// Of a surface of four bytes a pixel, in lines of two blocks: those that a quad lies in.
std::uint64_t lines_drawn(const pipeline::FragmentStream& stream) {
    const pipeline::SurfaceLayout layout{stream.width, stream.height};
    std::set<std::uint32_t> lines;
    for (const pipeline::Quad& quad : stream.quads)
        if (quad.alive != 0) lines.insert(layout.block_of(quad.x, quad.y) / 2);
    return lines.size();
}

} // namespace

// Depths are tested and written, colours replaced. Every line is fetched once, for its depths, and written back once
// of each surface, as the first fragment of a pixel passes. Both surfaces are cleared by writing them.
TEST(ImportedTracesCounters, LongBunnyMovesTheBytesOfItsPixels) {
    std::string reason;
    const auto recording = imported("bunny_glmark2_3frames.trace", reason);
    if (!recording) GTEST_SKIP() << reason;
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
        SCOPED_TRACE(frame);
        const Drawn drawn(*recording, {.first_frame = frame, .last_frame = frame});
        const RunResult run = replayed(drawn);
        const pipeline::Pass& pass = drawn.frame.passes.back();
        const pipeline::SurfaceFormat colour = drawn.frame.surfaces.at(pass.targets.at(0)).format,
                                      depth = drawn.frame.surfaces.at(pass.depth).format;
        ASSERT_EQ(pipeline::bytes_of(colour), 4U);
        ASSERT_EQ(pipeline::bytes_of(depth), 4U);
        const bool keeps_colour = pass.states.back().write_mask[0] != 15; // a window without alpha

        constexpr std::uint64_t burst = 32, pixels = 640 * 480;
        const std::uint64_t lines = lines_drawn(drawn.streams.back());
        EXPECT_EQ(counter(run.bytes, "dram_copy/bytes"), pixels * (4 + 4));
        EXPECT_EQ(counter(run.bytes, "dram_tile_read/bytes"), lines * burst * (keeps_colour ? 2 : 1));
        EXPECT_EQ(counter(run.bytes, "dram_tile_write/bytes"), lines * burst * 2);
        EXPECT_FALSE(run.bytes->contains("dram_texture"));
        EXPECT_EQ(run.wrong_pixels, 0U);
    }
}

// Without indices a vertex is a run of the vertex shader, as Mesa counts, in whichever primitives it stands.
TEST(ImportedTracesCounters, LongVerticesWithoutIndicesAreShadedOnce) {
    for (const auto& [name, vertices] :
         {std::pair{"bunny_glmark2_3frames.trace", 21516U}, std::pair{"ideas_glmark2_2frames.trace", 3370U}}) {
        SCOPED_TRACE(name);
        std::string reason;
        const auto recording = imported(name, reason);
        if (!recording) GTEST_SKIP() << reason;
        const RunResult run = replayed(Drawn(*recording, {.first_frame = 1, .last_frame = 1}));
        std::uint64_t runs = 0;
        for (std::size_t draw = 0; draw < run.draws.size(); ++draw)
            if (!run.draws[draw].name.starts_with("glClear")) runs += run.draw_counter(draw, "vertex_shader_runs");
        EXPECT_EQ(runs, vertices);
    }
}

} // namespace imported_traces_counters_test
