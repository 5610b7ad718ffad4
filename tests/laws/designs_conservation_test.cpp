// What must hold for every design and scene: what enters a stage leaves it, and parts add up to the run.
#include "tests/support/design_runs.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using pipeline::RunResult;
using support::counter;
using support::DesignCase;
using support::for_every_run;
using support::Replay;
using support::Settings;

using Json = nlohmann::ordered_json;

/// The draw passes of the frame as the design executed them, each with its stream.
template <class Visit>
void for_each_executed_pass(const Replay& replay, const RunResult& run, Visit visit) {
    std::size_t next = 0;
    for (const pipeline::Pass& pass : replay.frame.passes) {
        if (pass.kind != pipeline::PassKind::draw) continue;
        const pipeline::FragmentStream& stream = replay.streams[next++];
        for (const pipeline::PassResult& executed : run.passes)
            if (executed.name == pass.name || executed.name.starts_with(pass.name + " layer ") ||
                executed.name.starts_with(pass.name + " pass "))
                visit(pass, stream, executed.counters);
    }
}

/// Fragments in = retired + killed, from stage to stage; a multisampled group counts as one quad up to the ROP.
void expect_conserved(const pipeline::Pass& pass, const pipeline::FragmentStream& stream, const Json& counters,
                      bool multisampled) {
    const support::TaskCounts tasks = support::count_tasks(stream, multisampled);
    const auto count = [&](const char* path) { return counter(counters, path); };
    EXPECT_EQ(count("raster/triangles"), stream.triangles.size());
    EXPECT_EQ(count("raster/quads"), tasks.tasks);
    EXPECT_EQ(count("raster/fragments"), tasks.covered);
    std::uint64_t alive = stream.fragments - stream.fragments_discarded;
    std::uint64_t quads = tasks.tasks;
    if (count("early_depth/quads") != 0) {
        EXPECT_EQ(count("early_depth/quads"), quads);
        EXPECT_EQ(count("early_depth/fragments"), alive);
        alive -= count("early_depth/fragments_rejected") + count("early_depth/fragments_beyond");
        quads -= count("early_depth/quads_rejected");
    }
    EXPECT_EQ(count("scheduler/quads"), quads);
    EXPECT_EQ(count("fragment/quads"), quads);
    EXPECT_EQ(count("fragment/fragments"), count("scheduler/fragments"));
    EXPECT_EQ(count("reorder_buffer/retired") + count("reorder_buffer/dropped"), quads);
    EXPECT_EQ(count("crossbar/quads"), count("reorder_buffer/retired"));
    if (!multisampled || count("early_depth/quads") == 0) {
        EXPECT_EQ(count("scheduler/fragments"), multisampled ? tasks.alive : alive);
    }
    if (!multisampled) {
        EXPECT_EQ(count("rop/quads"), count("reorder_buffer/retired"));
    }
    EXPECT_EQ(count("rop/fragments") + count("fragment/peel_rejects"), alive);
    EXPECT_EQ(count("rop/depth_passed") + count("rop/depth_failed") + count("rop/stores") + count("rop/program_runs") +
                  count("rop/kept") + count("rop/not_kept") + count("rop/passed_over"),
              count("rop/fragments"));
    if (!pass.runs_program()) {
        EXPECT_EQ(count("rop/stores") + count("rop/program_runs"), 0U);
    }
    for (const char* cache : {"depth_tiles", "colour_tiles", "kbuffer_tiles"}) {
        const std::string at = std::string("rop/") + cache;
        EXPECT_EQ(counter(counters, at + "/hits") + counter(counters, at + "/misses"),
                  counter(counters, at + "/accesses"));
    }
    EXPECT_EQ(count("memory/reads") + count("memory/writes"), count("memory/requests"));
    EXPECT_EQ(count("memory/row_hits") + count("memory/row_misses"), count("memory/requests"));
}

} // namespace

TEST(Laws, FragmentsThatEnterAStageLeaveItOrAreKilledThere) {
    for_every_run({}, [](const DesignCase& one, const std::string& design, const Settings& settings) {
        if (!support::keeps_submission(design)) return; // these make streams of their own
        const RunResult run = one.replay.run(design, settings);
        std::uint64_t fragments = 0;
        std::size_t passes = 0;
        for_each_executed_pass(one.replay, run, [&](const auto& pass, const auto& stream, const Json& counters) {
            expect_conserved(pass, stream, counters, support::multisampled(one.replay, pass, design));
            fragments += counter(counters, "rop/fragments");
            ++passes;
        });
        EXPECT_GE(passes, one.replay.streams.size());
        for (const pipeline::PassResult& pass : run.passes) // over the screen, of lists
            if (pass.name.ends_with(" sort")) fragments += counter(pass.counters, "rop/fragments");
        EXPECT_EQ(run.fragments, fragments);
        EXPECT_EQ(counter(run.stages, "rop/counters/fragments"), fragments);
    });
}

TEST(Laws, FragmentsAreConservedThroughAlphaTestAndEarlyDepth) {
    const std::string file = support::shared_scene("glass_vase_flowers/GlassVaseFlowers.gltf");
    if (file.empty()) GTEST_SKIP() << "no further scenes here: set ROPSIM_SHARED_DIR";
    const Replay replay(file, {96, 96, "transparency", "auto", {"transparent=materials"}});
    ASSERT_TRUE(replay.frame.needs.early_depth);
    ASSERT_TRUE(replay.frame.needs.alpha_test);
    std::uint64_t rejected = 0, discarded = 0;
    for (const std::string& design : replay.designs()) {
        if (!support::keeps_submission(design)) continue;
        SCOPED_TRACE(design);
        const RunResult run = replay.run(design);
        for_each_executed_pass(replay, run, [&](const auto& pass, const auto& stream, const Json& counters) {
            expect_conserved(pass, stream, counters, false);
            rejected += counter(counters, "early_depth/fragments_rejected");
            discarded += stream.fragments_discarded;
        });
    }
    EXPECT_GT(rejected, 0U);
    EXPECT_GT(discarded, 0U);
}

namespace {

/// What passes add to draws is all that draws have, but for bytes of clears, which belong to passes without draws.
void expect_passes_to_add_up(const RunResult& run) {
    std::vector<std::vector<std::uint64_t>> left;
    for (const pipeline::DrawResult& draw : run.draws) left.push_back(draw.counters);
    for (const pipeline::PassDrawResult& part : run.pass_draws)
        for (std::size_t i = 0; i < part.counters.size(); ++i) {
            EXPECT_GE(left[part.draw][i], part.counters[i]) << run.draw_counters[i];
            left[part.draw][i] -= part.counters[i];
        }
    for (const auto& counters : left)
        for (std::size_t i = 0; i < counters.size(); ++i)
            EXPECT_TRUE(counters[i] == 0 || run.draw_counters[i].starts_with("dram_") ||
                        run.draw_counters[i].ends_with("_cycle"))
                << run.draw_counters[i];
}

} // namespace

TEST(Laws, PassesAndDrawsAddUpToTheRun) {
    for_every_run({}, [](const DesignCase& one, const std::string& design, const Settings& settings) {
        const RunResult run = one.replay.run(design, settings);
        std::uint64_t cycles = 0, bytes = 0, draw_bytes = 0, quads = 0, fragments = 0, passed = 0;
        for (const pipeline::PassResult& pass : run.passes) {
            EXPECT_EQ(pass.first_cycle, cycles); // back to back
            cycles += pass.cycles;
            for (const Json& of_client : pass.counters->at("memory").at("bytes"))
                bytes += of_client.get<std::uint64_t>();
        }
        EXPECT_EQ(cycles, run.cycles);
        EXPECT_EQ(bytes, counter(run.bytes, "dram/bytes"));
        for (std::size_t draw = 0; draw < run.draws.size(); ++draw) {
            quads += run.draw_counter(draw, "quads");
            fragments += run.draw_counter(draw, "fragments");
            passed += run.draw_counter(draw, "samples_passed");
            for (const std::string& name : run.draw_counters)
                if (name.starts_with("dram_")) draw_bytes += run.draw_counter(draw, name);
            if (run.draw_counter(draw, "quads") != 0) {
                EXPECT_LE(run.draw_counter(draw, "first_cycle"), run.draw_counter(draw, "last_cycle"));
            }
        }
        EXPECT_EQ(quads, counter(run.stages, "rop/counters/quads"));
        EXPECT_EQ(fragments, run.fragments);
        EXPECT_EQ(passed + counter(run.stages, "rop/counters/depth_failed") +
                      counter(run.stages, "rop/counters/stencil_failed"),
                  fragments);
        EXPECT_EQ(draw_bytes, bytes);
        expect_passes_to_add_up(run);
    });
}

TEST(Laws, HitsAndMissesAreAllAccesses) {
    for_every_run({}, [](const DesignCase& one, const std::string& design, const Settings& settings) {
        const RunResult run = one.replay.run(design, settings);
        EXPECT_FALSE(run.caches->empty());
        for (const auto& cache : run.caches->items()) {
            SCOPED_TRACE(cache.key());
            EXPECT_EQ(counter(cache.value(), "hits") + counter(cache.value(), "misses"),
                      counter(cache.value(), "accesses"));
            EXPECT_GT(counter(cache.value(), "accesses"), 0U);
        }
        // Accesses are those of whoever asks.
        if (run.caches->contains("texture_l1_kbuffer")) {
            const std::uint64_t lines =
                support::counter(run.stages, "fragment_pipeline/counters/kbuffer_reads") *
                (design == "framebuffer-fetch" || // reads all render targets at once
                         std::find(settings.begin(), settings.end(), "existing.atomic_reads=true") != settings.end()
                     ? 1
                     : one.replay.frame.program->targets());
            EXPECT_EQ(counter(run.caches, "texture_l1_kbuffer/accesses"), lines);
        }
        if (run.caches->contains("kbuffer_tiles")) {
            // The pass that sorts lists writes its entries through the colour cache.
            const std::uint64_t sorted =
                run.caches->contains("colour_tiles") ? counter(run.caches, "colour_tiles/accesses") : 0;
            EXPECT_EQ(counter(run.caches, "kbuffer_tiles/accesses") + sorted,
                      counter(run.stages, "rop/counters/quads"));
        }
    });
}
