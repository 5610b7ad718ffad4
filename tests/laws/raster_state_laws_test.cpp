// Whatever state draws have, the machine leaves the surfaces that the reference leaves, bit for bit; and what a pass
// does not do costs nothing.
#include "models/kbuffers/library.hpp"
#include "models/programs/library.hpp"
#include "pipeline/functional/frame_streams.hpp"
#include "pipeline/machine.hpp"
#include "sim/config.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/functional_scene.hpp"
#include "tests/support/random_states.hpp"
#include "traces/pass_graph.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using pipeline::RasterState;
using pipeline::SurfaceFormat;

/// A frame of one clear and one pass whose draws take random states from a list.
struct StateFrame {
    using Fp16Overflow = pipeline::Fp16Overflow;
    pipeline::Frame frame;
    std::vector<pipeline::FragmentStream> streams;
    pipeline::ReferenceImage reference;

    /// With a k-buffer, the same draws go through it afterwards, tested against the depth that is there by then.
    StateFrame(std::uint64_t seed, SurfaceFormat colour, SurfaceFormat depth, std::uint32_t samples = 1,
               bool kbuffer = false, float brightest = 1.0F, Fp16Overflow fp16_overflow = Fp16Overflow::saturate) {
        sim::Random random(seed, "states");
        tests::FunctionalScene scene(40, 28);
        scene.view.samples = samples;
        pipeline::Material blended = scene.resources.materials[0];
        blended.alpha_mode = pipeline::AlphaMode::blend;
        const std::uint32_t material = scene.add_material(blended);
        for (int draw = 0; draw < 12; ++draw) scene.add(mesh(random, brightest), material);
        scene.resources.place();
        scene.resources.validate("states");
        frame.resources = std::make_shared<pipeline::Resources>(scene.resources);
        frame.draws = scene.draws;
        frame.view = scene.view;
        frame.colour_format = colour;
        frame.depth_format = depth;
        if (kbuffer) frame.program = models::make_program("nearest-k", "z", 4);
        std::vector<RasterState> states;
        for (int i = 0; i < 5; ++i) states.push_back(tests::random_state(random));
        std::vector<std::uint32_t> of_draw;
        for (std::size_t i = 0; i < frame.draws.size(); ++i)
            of_draw.push_back(static_cast<std::uint32_t>(random.below(5)));
        traces::PassGraph graph(frame);
        using traces::colour_surface, traces::depth_surface;
        graph.add_clear("clear", {depth_surface, colour_surface});
        graph.add_draw("states", {depth_surface, colour_surface}, {depth_surface, colour_surface}, scene.all_draws(),
                       true);
        graph.set_states(states, of_draw);
        graph.output(colour_surface);
        graph.output(depth_surface);
        if (kbuffer) {
            graph.add_clear("clear layers", {traces::kbuffer_surface});
            graph.add_draw("layers", {depth_surface}, {traces::kbuffer_surface}, scene.all_draws(), true);
            for (RasterState& state : states) {
                state.stencil.test = false;
                state.depth.write = false;
            }
            graph.set_states(states, of_draw);
            graph.output(traces::kbuffer_surface);
        }
        frame = graph.lower();
        streams = pipeline::rasterize_frame(frame);
        reference = pipeline::run_reference(frame, streams, 1, 0, fp16_overflow);
    }

    static tests::MeshData mesh(sim::Random& random, float brightest) {
        tests::MeshData mesh;
        for (const tests::LevelTriangle& triangle : tests::level_triangles(20, 40, 28, 9.0, 7, random))
            for (const glm::vec2& corner : triangle.corners) {
                mesh.positions.emplace_back(corner, triangle.depth);
                mesh.colours.push_back(triangle.colour * brightest);
            }
        return mesh;
    }

    pipeline::RunResult run(const std::string& design, const std::vector<std::string>& settings = {},
                            const pipeline::MachineOptions& options = {}) const {
        sim::Config config;
        for (const std::string& setting : settings) config.set(setting);
        pipeline::GpuParams gpu;
        config.read("", gpu);
        const auto model = models::make_design(design, config);
        return pipeline::Machine(gpu, frame, streams, *model, options).run(reference);
    }
};

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
    std::vector<std::uint32_t> bits(values.size());
    std::transform(values.begin(), values.end(), bits.begin(),
                   [](float of) { return std::bit_cast<std::uint32_t>(of); });
    return bits;
}

pipeline::RunResult expect_reference(const StateFrame& scene, const std::string& design,
                                     const std::vector<std::string>& settings = {}) {
    pipeline::RunResult run = scene.run(design, settings);
    EXPECT_EQ(run.wrong_pixels, 0U);
    EXPECT_EQ(bits_of(run.colour), bits_of(scene.reference.colour));
    EXPECT_EQ(run.depth, scene.reference.depth);
    EXPECT_EQ(run.stencil, scene.reference.stencil);
    return run;
}

TEST(RasterStateLaws, TheMachineLeavesTheSurfacesOfTheReference) {
    // Small caches bring lines back that stores alone had made, slow memory lets quads wait for them.
    const std::vector<std::vector<std::string>> machines{
        {}, {"rop.depth_cache_bytes=512", "rop.colour_cache_bytes=1024"}, {"rop.fast_clear=true", "rop.queue=2"}};
    std::size_t drawn = 0, stencils = 0;
    for (std::uint64_t seed = 0; seed < tests::repetitions(40); ++seed) {
        SCOPED_TRACE(seed);
        const StateFrame scene(seed, SurfaceFormat::rgba8, SurfaceFormat::d24s8);
        for (const auto& settings : machines) expect_reference(scene, "existing", settings);
        const auto differs = [](const auto& values) {
            return std::any_of(values.begin(), values.end(), [&](auto value) { return value != values.front(); });
        };
        drawn += differs(scene.reference.colour) ? 1 : 0;
        stencils += differs(scene.reference.stencil) ? 1 : 0;
    }
    EXPECT_GT(drawn, tests::repetitions(40) * 3 / 4);
    EXPECT_GT(stencils, tests::repetitions(40) / 2);
}

TEST(RasterStateLaws, InEveryFormat) {
    for (const SurfaceFormat colour :
         {SurfaceFormat::r8, SurfaceFormat::srgb8a8, SurfaceFormat::rgb10a2, SurfaceFormat::r11g11b10f,
          SurfaceFormat::rg16f, SurfaceFormat::rgba16f, SurfaceFormat::r32f, SurfaceFormat::rgba32f})
        for (const SurfaceFormat depth :
             {SurfaceFormat::d16, SurfaceFormat::d24, SurfaceFormat::d24s8, SurfaceFormat::d32f, SurfaceFormat::s8}) {
            SCOPED_TRACE(fmt::format("{} {}", info_of(colour).name, info_of(depth).name));
            const StateFrame scene(7, colour, depth);
            expect_reference(scene, "existing");
            EXPECT_EQ(scene.reference.stencil.empty(), !has_stencil(depth));
            EXPECT_EQ(scene.reference.depth.empty(), !has_depth(depth));
        }
}

// Sums of colours as bright as a half can be leave its range; products with factors that bright are not finite at all.
TEST(RasterStateLaws, BeyondTheRangeOfHalves) {
    using Fp16Overflow = pipeline::Fp16Overflow;
    const auto any = [](const std::vector<float>& colours, auto is) {
        return std::any_of(colours.begin(), colours.end(), [&](float of) { return is(of); });
    };
    std::size_t overflows = 0, in_range = 0, infinities = 0, not_numbers = 0;
    for (std::uint64_t seed = 0; seed < tests::repetitions(12); ++seed)
        for (const SurfaceFormat colour : {SurfaceFormat::r16f, SurfaceFormat::rg16f, SurfaceFormat::rgba16f})
            for (const float brightest : {1.0F, 65504.0F}) {
                SCOPED_TRACE(fmt::format("{} {} {}", seed, info_of(colour).name, brightest));
                const auto frame = [&](Fp16Overflow overflow) {
                    return StateFrame(seed, colour, SurfaceFormat::d24s8, 1, false, brightest, overflow);
                };
                const StateFrame saturated = frame(Fp16Overflow::saturate), infinite = frame(Fp16Overflow::infinity);
                const auto count = [](const pipeline::RunResult& run) {
                    return run.stages->at("rop")["counters"]["fp16_overflows"].get<std::uint64_t>();
                };
                const auto run = expect_reference(saturated, "existing");
                const auto ieee = expect_reference(infinite, "existing", {"rop.fp16_overflow=infinity"});
                EXPECT_EQ(run.cycles, ieee.cycles);
                EXPECT_FALSE(any(run.colour, [](float of) { return !std::isfinite(of); }));
                // Up to the first channel that leaves the range both do the same.
                EXPECT_EQ(count(run) == 0, count(ieee) == 0);
                if (count(run) == 0) {
                    EXPECT_EQ(bits_of(run.colour), bits_of(ieee.colour));
                }
                overflows += count(run);
                in_range += count(run) == 0 ? 1 : 0;
                infinities += any(ieee.colour, [](float of) { return std::isinf(of); }) ? 1 : 0;
                not_numbers += any(ieee.colour, [](float of) { return std::isnan(of); }) ? 1 : 0;
            }
    EXPECT_GT(overflows, 0U);
    EXPECT_GT(in_range, 0U);
    EXPECT_GT(infinities, 0U);
    EXPECT_GT(not_numbers, 0U);
}

TEST(RasterStateLaws, WithSamples) {
    for (std::uint64_t seed = 0; seed < 4; ++seed)
        expect_reference(StateFrame(seed, SurfaceFormat::rgba8, SurfaceFormat::d24s8, 4), "blender");
}

// Early depth tests with all compares; what a design without protection gets wrong there, its hazards explain.
TEST(RasterStateLaws, DrawsOfAKBufferPassHaveTheirOwnDepthTest) {
    const StateFrame scene(3, SurfaceFormat::rgba8, SurfaceFormat::d24s8, 1, true);
    EXPECT_TRUE(scene.frame.needs.early_depth);
    EXPECT_GT(scene.reference.accepted_insertions, 0U);
    for (const models::DesignInfo& design : models::designs()) {
        SCOPED_TRACE(design.id);
        const pipeline::RunResult run = scene.run(std::string(design.id));
        EXPECT_EQ(run.unexplained_pixels(), 0U);
        EXPECT_EQ(run.colour, scene.reference.colour);
        EXPECT_EQ(run.depth, scene.reference.depth);
        EXPECT_EQ(run.stencil, scene.reference.stencil);
    }
}

TEST(RasterStateLaws, TheOrderOfTicksDoesNotMatter) {
    const StateFrame scene(5, SurfaceFormat::rgba8, SurfaceFormat::d24s8);
    const pipeline::RunResult run = scene.run("existing");
    for (const sim::Mode mode : {sim::Mode::shuffled, sim::Mode::never_sleep})
        EXPECT_EQ(scene.run("existing", {}, {.mode = mode}).cycles, run.cycles);
}

} // namespace
