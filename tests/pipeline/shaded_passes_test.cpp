// Frames whose passes bring shaders, on the whole machine: G-buffer and lighting, and a pass that reads a k-buffer.
#include "models/programs/nearest_k.hpp"
#include "tests/support/replay.hpp"
#include "tests/support/test_shaders.hpp"
#include "traces/pass_graph.hpp"
#include "traces/workloads/methods.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numeric>

namespace shaded_passes_test {

using pipeline::Frame;
using pipeline::SurfaceFormat;

struct NoParams {
    static constexpr auto fields() { return std::tuple<>(); }
};

std::vector<std::uint32_t> all_draws(const Frame& frame) {
    std::vector<std::uint32_t> all(frame.draws.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

Frame deferred_frame(const traces::Scene& scene, const pipeline::View& view, const NoParams&) {
    Frame frame = traces::frame_of(scene, view);
    traces::ShadedPass gbuffer, lighting;
    gbuffer.name = "G-buffer";
    gbuffer.shader = std::make_shared<tests::GBufferShader>();
    gbuffer.targets = {"albedo", "normals"};
    gbuffer.draws = all_draws(frame);
    gbuffer.depth = traces::depth_surface;
    gbuffer.states[0].depth = {true, true};
    lighting.name = "lighting";
    lighting.shader = std::make_shared<tests::LightingShader>();
    lighting.reads = {"albedo", "normals"};
    lighting.targets = {"picture"};
    lighting.screen = true;
    traces::PassGraph graph(std::move(frame));
    graph.add_surface("albedo", SurfaceFormat::rgba8);
    graph.add_surface("normals", SurfaceFormat::rgba16f, glm::vec4(0.5F));
    graph.add_surface("picture", SurfaceFormat::rgba8);
    graph.add_clear("clear", {"albedo", "normals", traces::depth_surface});
    graph.add_shaded(gbuffer);
    graph.add_shaded(lighting);
    graph.output("picture");
    return graph.lower();
}

/// Red is the number of entries that hold something, of k.
class CountShader final : public pipeline::Shader {
  public:
    explicit CountShader(std::uint32_t k) : k_(k) {}
    pipeline::ShaderShape shape() const override { return {.reads = 1}; }
    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
               pipeline::ShaderOutput& output) const override {
        const pipeline::QuadPlaces at(input);
        const std::uint32_t targets = surfaces.info(0).program->targets();
        const auto pixels = surfaces.pixels(0, at.x, at.y, input.pixels, 0, targets);
        surfaces.issue(k_, input.pixels);
        for (std::size_t i = 0; i < 4; ++i) {
            if (pixels[i] == nullptr) continue;
            const auto held = std::count_if(pixels[i], pixels[i] + k_, [](float depth) { return depth <= 1.0F; });
            output.colours[0][i] = glm::vec4(static_cast<float>(held) / static_cast<float>(k_), 0, 0, 1);
        }
    }

  private:
    std::uint32_t k_;
};

constexpr std::uint32_t k = 4;

Frame counted_frame(const traces::Scene& scene, const pipeline::View& view, const NoParams&) {
    Frame frame = traces::frame_of(scene, view);
    frame.program = models::make_nearest_k(models::EntryKind::z, k);
    const auto draws = all_draws(frame);
    traces::ShadedPass count;
    count.name = "count";
    count.shader = std::make_shared<CountShader>(k);
    count.reads = {traces::kbuffer_surface};
    count.targets = {"picture"};
    count.screen = true;
    traces::PassGraph graph(std::move(frame));
    graph.add_surface("picture", SurfaceFormat::rgba8);
    graph.add_clear("clear", {traces::kbuffer_surface});
    graph.add_draw("geometry", {}, {traces::kbuffer_surface}, draws, true);
    graph.add_shaded(count);
    graph.output("picture");
    return graph.lower();
}

/// White, or the colour of another surface at its own pixel.
class CopyShader final : public pipeline::Shader {
  public:
    explicit CopyShader(bool reads) : reads_(reads) {}
    pipeline::ShaderShape shape() const override { return {.reads = reads_ ? 1U : 0U}; }
    void shade(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces,
               pipeline::ShaderOutput& output) const override {
        const pipeline::QuadPlaces at(input);
        output.colours[0].fill(glm::vec4(1.0F));
        if (reads_) output.colours[0] = surfaces.fetch(0, at.x, at.y, input.pixels);
    }

  private:
    bool reads_;
};

/// Fragments of a k-buffer whose shader reads a surface that was cleared and never drawn to, if it reads one.
template <bool reads>
Frame filled_frame(const traces::Scene& scene, const pipeline::View& view, const NoParams&) {
    Frame frame = traces::frame_of(scene, view);
    frame.program = models::make_nearest_k(models::EntryKind::rgbz, k);
    traces::ShadedPass fill, count;
    fill.name = "geometry";
    fill.shader = std::make_shared<CopyShader>(reads);
    if (reads) fill.reads = {"given"};
    fill.draws = all_draws(frame);
    fill.kbuffer = traces::kbuffer_surface;
    count.name = "count";
    count.shader = std::make_shared<CountShader>(k);
    count.reads = {traces::kbuffer_surface};
    count.targets = {"picture"};
    count.screen = true;
    traces::PassGraph graph(std::move(frame));
    graph.add_surface({.name = "given", .width = view.width, .height = view.height});
    graph.add_surface("picture", SurfaceFormat::rgba8);
    graph.add_clear("clear", {"given", traces::kbuffer_surface});
    graph.add_shaded(fill);
    graph.add_shaded(count);
    graph.output("picture");
    return graph.lower();
}

using Build = Frame (*)(const traces::Scene&, const pipeline::View&, const NoParams&);

support::Replay replay(const std::string& scene, Build build, std::uint32_t width = 64, std::uint32_t height = 64) {
    support::ReplayOptions options;
    options.width = width;
    options.height = height;
    options.workload = traces::make_workload<NoParams>("shaded", "passes with shaders", build);
    return support::Replay(scene, options);
}

const pipeline::PassJudgement& judged(const pipeline::RunResult& run, const std::string& surface) {
    const auto at = std::find_if(run.judgements.begin(), run.judgements.end(),
                                 [&](const pipeline::PassJudgement& of) { return of.surface == surface; });
    EXPECT_NE(at, run.judgements.end()) << surface;
    return *at;
}

TEST(ShadedPasses, EverySurfaceOfEveryPassIsThatOfTheReferenceOnEveryGpu) {
    for (const auto& [width, height] : {std::pair{64U, 64U}, std::pair{37U, 51U}}) {
        const support::Replay run = replay("gen:blob?triangles=1000", deferred_frame, width, height);
        for (const char* pipes : {"fragment.pipes=1", "fragment.pipes=6"})
            for (const char* clear : {"rop.fast_clear=true", "rop.fast_clear=false"}) {
                const pipeline::RunResult result = run.run("existing", {pipes, clear});
                EXPECT_EQ(result.wrong_pixels, 0U);
                EXPECT_EQ(result.colour, run.reference.colour);
                ASSERT_EQ(result.judgements.size(), 4U); // two colours and depth, then the picture
                for (const pipeline::PassJudgement& judgement : result.judgements) {
                    EXPECT_EQ(judgement.wrong_places, 0U) << judgement.surface;
                    EXPECT_FALSE(judgement.other_inputs);
                }
            }
    }
}

// A block of either surface lies in one line: a quad looks up two, and each of its lines has to come once.
TEST(ShadedPasses, ThePipesFetchWhatTheShaderReads) {
    const support::Replay run = replay("gen:blob?triangles=1000", deferred_frame);
    const pipeline::RunResult result =
        run.run("existing", {"fragment.pipes=1", "fragment.alu_per_clk=1", "texture.l1_bytes=65536"});
    const auto& lighting = support::pass_named(result, "lighting");
    const std::uint64_t quads = 32 * 32, lines_of_albedo = 64 * 64 * 4 / 64, lines_of_normals = 64 * 64 * 8 / 64;
    const std::uint64_t hits = support::counter(*lighting.counters, "fragment/l1/texture_hits"),
                        misses = support::counter(*lighting.counters, "fragment/l1/texture_misses");
    EXPECT_EQ(hits + misses, 2 * quads);
    EXPECT_EQ(misses, lines_of_albedo + lines_of_normals);
    EXPECT_EQ(support::counter(*lighting.counters, "fragment/issue_cycles"), quads * 6); // and the result's own move
}

TEST(ShadedPasses, AllTargetsTravelAndAreStoredTogether) {
    const support::Replay run = replay("gen:blob?triangles=1000", deferred_frame);
    const pipeline::RunResult result = run.run("existing", {"rop.fast_clear=false"});
    const auto& gbuffer = support::pass_named(result, "G-buffer");
    const std::uint64_t bytes_of_fragment = 4 + 4 + 8; // depth, albedo, normal
    EXPECT_EQ(support::counter(*gbuffer.counters, "crossbar/bytes"), run.streams[0].fragments * bytes_of_fragment);
    const auto& clear = support::pass_named(result, "clear");
    EXPECT_EQ(support::counter(*clear.counters, "rop/clears"), 64U * 64 * bytes_of_fragment);
}

// Texture units do not know what is cleared, whichever way fragments take to their entries. What of entries and layers
// has to be written for readers depends on where fragments are alone.
TEST(ShadedPasses, AClearedSurfaceIsWrittenBeforeAKBufferPassReadsIt) {
    const support::Replay reading = replay("gen:discs?n=20", filled_frame<true>),
                          plain = replay("gen:discs?n=20", filled_frame<false>);
    const auto resolved = [](const support::Replay& run, const char* design, const char* clear) {
        return support::counter(run.run(design, {clear}).stages, "rop/counters/resolves");
    };
    for (const char* design : {"existing", "blender", "multipass", "dual-peel", "linked-list"}) {
        EXPECT_EQ(resolved(reading, design, "rop.fast_clear=true"),
                  resolved(plain, design, "rop.fast_clear=true") + 64 * 64 * 4)
            << design;
        EXPECT_EQ(resolved(reading, design, "rop.fast_clear=false"), 0U) << design;
    }
}

TEST(ShadedPasses, TheFaultsOfAPassAreNotCountedBehindIt) {
    const support::Replay run = replay("gen:stack?n=64", counted_frame);
    const pipeline::RunResult existing = run.run("existing");
    ASSERT_GT(existing.hazards.total(), 0U);
    EXPECT_GT(judged(existing, "kbuffer").wrong_places, 0U);
    EXPECT_FALSE(judged(existing, "kbuffer").other_inputs);
    EXPECT_EQ(judged(existing, "picture").wrong_places, 0U); // it shows what it was given
    EXPECT_TRUE(judged(existing, "picture").other_inputs);
    for (const char* design : {"scoreboard", "blender", "multipass", "linked-list"}) {
        const pipeline::RunResult result = run.run(design);
        EXPECT_EQ(judged(result, "kbuffer").wrong_places, 0U) << design;
        EXPECT_EQ(judged(result, "picture").wrong_places, 0U) << design;
        EXPECT_FALSE(judged(result, "picture").other_inputs) << design;
        EXPECT_EQ(result.wrong_pixels, 0U) << design;
        EXPECT_EQ(result.colour, run.reference.colour) << design;
    }
}

} // namespace shaded_passes_test
