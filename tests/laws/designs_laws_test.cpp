// What must hold for every design, scene and seed: hazards and pictures, conservation, activities, determinism.
#include "tests/support/effort.hpp"
#include "tests/support/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

namespace {

using pipeline::MachineOptions;
using pipeline::RunResult;
using support::counter;
using support::Replay;
using support::ReplayOptions;

using Json = nlohmann::ordered_json;
using Settings = std::vector<std::string>;

struct Case {
    std::string scene;
    ReplayOptions options;
    Replay replay;

    Case(std::string spec, ReplayOptions knobs)
        : scene(std::move(spec)), options(std::move(knobs)), replay(scene, options) {}
};

/// Small frames that differ in what they use: indices, draws, layers or meshes, entries, samples.
const std::vector<Case>& cases() {
    static const std::vector<Case> list = [] {
        std::vector<Case> made;
        made.emplace_back("gen:discs?n=60&overlap=8&width=32&height=32", ReplayOptions{32, 32});
        made.emplace_back("gen:stack?n=12&x=1&y=1&w=29&h=29&order=random",
                          ReplayOptions{32, 32, "transparency", "auto", {"k=2"}});
        made.emplace_back("gen:random-quads?n=2000&area=1024",
                          ReplayOptions{32, 32, "transparency", "auto", {"entry=z", "k=16"}});
        made.emplace_back("gen:blob?triangles=3000", ReplayOptions{48, 48});
        made.emplace_back("gen:grid-soup?boxes=60&boxes_per_draw=7",
                          ReplayOptions{48, 48, "transparency", "auto", {"k=8"}});
        made.emplace_back("gen:grass?blades=300", ReplayOptions{48, 48, "transparency", "auto", {"k=1"}});
        made.emplace_back("gen:discs?n=60&overlap=8&width=32&height=32", ReplayOptions{32, 32, "opaque"});
        made.emplace_back("gen:discs?n=30&overlap=6&width=24&height=22",
                          ReplayOptions{.width = 24, .height = 22, .knobs = {"k=2"}, .samples = 4});
        made.emplace_back("gen:blob?triangles=400",
                          ReplayOptions{.width = 15, .height = 21, .knobs = {"entry=z", "k=4"}, .samples = 8});
        made.emplace_back("gen:blob?triangles=400",
                          ReplayOptions{.width = 16, .height = 17, .workload = "opaque", .samples = 8});
        return made;
    }();
    return list;
}

/// Every design as it is, and variants that use other parts of the machine.
const std::vector<std::pair<std::string, Settings>>& variants() {
    static const std::vector<std::pair<std::string, Settings>> list = [] {
        std::vector<std::pair<std::string, Settings>> made;
        for (const std::string& design : support::design_ids()) made.push_back({design, {}});
        made.push_back({"existing", {"existing.visibility=rop_cache", "existing.tex_coherence=invalidate_on_write"}});
        made.push_back({"existing", {"existing.visibility=never_until_flush", "existing.flush_triangles=16"}});
        made.push_back(
            {"existing", {"existing.atomic_reads=true", "existing.flush_draws=true", "existing.drain=false"}});
        made.push_back({"scoreboard",
                        {"scoreboard.granularity=tile8", "scoreboard.visibility=writeback", "scoreboard.entries=9"}});
        made.push_back({"blender", {"blender.interlock=forward"}});
        made.push_back({"blender", {"blender.interlock=none", "blender.latency=200"}});
        made.push_back({"interlock", {"interlock.area=tile", "interlock.grants_per_clk=1"}});
        made.push_back({"interlock", {"interlock.ordered=false"}});
        made.push_back({"peel-rop", {"peel-rop.retirement=out_of_order", "peel-rop.early_reject=pixel"}});
        made.push_back({"linked-list", {"linked-list.nodes=400"}});
        made.push_back({"stencil-routed", {"stencil-routed.samples=2", "stencil-routed.passes=3"}});
        made.push_back({"batched", {"batched.batches.batch=3", "batched.batches.drain=false"}});
        return made;
    }();
    return list;
}

const Settings jitter{"memory.controller.jitter_cycles=300"};

Settings join(Settings settings, const Settings& more) {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

std::string describe(const Case& one, const std::string& design, const Settings& settings) {
    return fmt::format("{} {} on {} {} {}, {} samples", design, fmt::join(settings, " "), one.options.workload.name(),
                       one.scene, fmt::join(one.options.knobs, " "), one.options.samples);
}

/// The design can run the program of this case.
bool runs(const Case& one, const std::string& design) {
    const std::vector<std::string> able = one.replay.designs();
    return std::find(able.begin(), able.end(), design) != able.end();
}

/// check(case, design, settings) for all runs, or for one of `every` of them, spread over cases and designs.
template <class Check>
void for_every_run(const Settings& more, Check check, std::size_t every = 1) {
    std::size_t number = 0;
    for (const Case& one : cases())
        for (const auto& [design, settings] : variants()) {
            if (!runs(one, design) || number++ % every != 0) continue;
            SCOPED_TRACE(describe(one, design, settings));
            check(one, design, join(settings, more));
        }
}

bool same_picture(const Case& one, const RunResult& run) {
    return run.kbuffer == one.replay.reference.kbuffer && run.colour == one.replay.reference.colour;
}

} // namespace

namespace {

void expect_the_reference_without_hazards(std::uint64_t seeds) {
    std::set<std::uint64_t> outcomes;
    for (const Case& one : cases())
        for (const std::string& design : one.replay.designs())
            for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
                SCOPED_TRACE(fmt::format("{}, seed {}", describe(one, design, {}), seed));
                const RunResult run = one.replay.run(design, jitter, {.seed = seed});
                EXPECT_EQ(run.unexplained_pixels(), 0U);
                // Triangles in another order have a reference of their own: it differs in ties.
                const bool same = support::keeps_submission(design) ? same_picture(one, run) : run.wrong_pixels == 0;
                EXPECT_EQ(same, run.wrong_pixels == 0);
                if (support::protects(design)) {
                    EXPECT_EQ(run.hazards.total(), 0U);
                    EXPECT_TRUE(same || (run.overflow_pixels > 0 && !support::holds_everything(design)));
                } else {
                    EXPECT_TRUE(same || run.hazards.total() > 0);
                }
                if (design == "existing" && &one == &cases()[0]) outcomes.insert(run.cycles);
            }
    EXPECT_GT(outcomes.size(), seeds / 4); // seeds matter
}

} // namespace

TEST(Laws, NoHazardMeansTheReferencePictureForEverySeed) {
    expect_the_reference_without_hazards(tests::repetitions(4));
}
TEST(LawsLong, NoHazardMeansTheReferencePictureForManySeeds) { expect_the_reference_without_hazards(16); }

TEST(Laws, EveryWrongPixelIsExplainedByARecordedHazard) {
    for_every_run(jitter, [](const Case& one, const std::string& design, const Settings& settings) {
        for (std::uint64_t seed = 1; seed <= tests::repetitions(2); ++seed) {
            const RunResult run = one.replay.run(design, settings, {.seed = seed});
            EXPECT_EQ(run.unexplained_pixels(), 0U);
            const auto& hazards = run.hazards;
            EXPECT_EQ(hazards.total(), hazards.of(pipeline::HazardClass::h1_in_flight) +
                                           hazards.of(pipeline::HazardClass::h2_write_path) +
                                           hazards.of(pipeline::HazardClass::h3_stale_line) +
                                           hazards.of(pipeline::HazardClass::h4_torn_read));
            EXPECT_LE(hazards.pixels, hazards.total());
            EXPECT_EQ(std::accumulate(run.hazard_distance.begin(), run.hazard_distance.end(), std::uint64_t{0}),
                      hazards.total());
            EXPECT_EQ(std::count(run.wrong_mask.begin(), run.wrong_mask.end(), 1),
                      static_cast<std::ptrdiff_t>(run.wrong_pixels));
            EXPECT_EQ(run.hazard_mask.empty(), hazards.total() == 0);
            if (!run.hazard_mask.empty()) {
                EXPECT_EQ(run.hazard_mask.size() -
                              static_cast<std::size_t>(std::count(run.hazard_mask.begin(), run.hazard_mask.end(), 0)),
                          hazards.pixels);
            }
            for (const pipeline::HazardPair& pair : run.pairs) {
                EXPECT_LT(pair.aggressor, pair.victim);
                const std::size_t pixel = std::size_t{pair.y} * one.options.width + pair.x;
                EXPECT_NE(run.hazard_mask[pixel] >> static_cast<unsigned>(pair.cause) & 1U, 0U);
            }
        }
    });
}

namespace {

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
    for_every_run({}, [](const Case& one, const std::string& design, const Settings& settings) {
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
    for_every_run({}, [](const Case& one, const std::string& design, const Settings& settings) {
        const RunResult run = one.replay.run(design, settings);
        std::uint64_t cycles = 0, bytes = 0, draw_bytes = 0, quads = 0, fragments = 0;
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
            for (const std::string& name : run.draw_counters)
                if (name.starts_with("dram_")) draw_bytes += run.draw_counter(draw, name);
            if (run.draw_counter(draw, "quads") != 0) {
                EXPECT_LE(run.draw_counter(draw, "first_cycle"), run.draw_counter(draw, "last_cycle"));
            }
        }
        EXPECT_EQ(quads, counter(run.stages, "rop/counters/quads"));
        EXPECT_EQ(fragments, run.fragments);
        EXPECT_EQ(draw_bytes, bytes);
        expect_passes_to_add_up(run);
    });
}

TEST(Laws, HitsAndMissesAreAllAccesses) {
    for_every_run({}, [](const Case& one, const std::string& design, const Settings& settings) {
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

TEST(Laws, ActivitiesOfEveryUnitSumToTheElapsedTime) {
    for_every_run(jitter, [](const Case& one, const std::string& design, const Settings& settings) {
        const RunResult run = one.replay.run(design, settings);
        for (const auto& stage : run.stages->items()) {
            SCOPED_TRACE(stage.key());
            std::uint64_t sum = 0;
            for (const auto& activity : stage.value().at("activity").items())
                sum += activity.value().get<std::uint64_t>();
            const std::uint64_t units = stage.key() == "memory_partition" ? 4
                                        : stage.value().contains("units") ? counter(stage.value(), "units")
                                                                          : 1;
            EXPECT_EQ(sum, units * run.cycles);
        }
        for (const auto& stage : run.stalls->items()) {
            double sum = 0;
            for (const auto& activity : stage.value().items()) sum += activity.value().get<double>();
            EXPECT_NEAR(sum, 1.0, 1e-9) << stage.key();
        }
    });
}

TEST(Laws, SameInputsGiveTheSameBytes) {
    for (const Case& one : cases()) {
        ReplayOptions one_thread = one.options, two_threads = one.options;
        one_thread.threads = 1;
        two_threads.threads = 2;
        const Replay first(one.scene, one_thread), second(one.scene, two_threads);
        EXPECT_TRUE(first.reference.kbuffer == second.reference.kbuffer);
        EXPECT_TRUE(first.reference.colour == second.reference.colour);
        EXPECT_TRUE(first.reference.picture == second.reference.picture);
        for (const auto& [design, settings] : variants()) {
            if (!runs(one, design)) continue;
            SCOPED_TRACE(describe(one, design, settings));
            const RunResult run = one.replay.run(design, join(settings, jitter), {.seed = 7});
            EXPECT_EQ(support::difference(run, first.run(design, join(settings, jitter), {.seed = 7})), "");
            EXPECT_EQ(support::difference(run, second.run(design, join(settings, jitter), {.seed = 7})), "");
        }
    }
}

TEST(Laws, ResultDoesNotDependOnTheOrderOfTicks) {
    for_every_run(jitter, [](const Case& one, const std::string& design, const Settings& settings) {
        const RunResult run = one.replay.run(design, settings, {.seed = 3});
        EXPECT_EQ(support::difference(run, one.replay.run(design, settings, {.seed = 3, .mode = sim::Mode::shuffled})),
                  "");
    });
}

namespace {

void expect_the_same_without_sleep(std::size_t every) {
    for_every_run(
        jitter,
        [](const Case& one, const std::string& design, const Settings& settings) {
            const RunResult run = one.replay.run(design, settings, {.seed = 3});
            EXPECT_EQ(
                support::difference(run, one.replay.run(design, settings, {.seed = 3, .mode = sim::Mode::never_sleep})),
                "");
        },
        every);
}

} // namespace

TEST(Laws, ResultDoesNotDependOnSleeping) { expect_the_same_without_sleep(5); }
TEST(LawsLong, ResultDoesNotDependOnSleepingInAnyRun) { expect_the_same_without_sleep(1); }

namespace {

/// Sees everything and does nothing.
class Watcher final : public sim::Observer {
  public:
    void activity(const sim::Component&, sim::Activity, sim::Time, sim::Time) override { ++seen; }
    void message(const sim::ChannelBase&, sim::Time, sim::Time) override { ++seen; }
    std::uint64_t seen = 0;
};

} // namespace

TEST(Laws, WatchingChangesNothing) {
    for (const std::string& design : cases()[0].replay.designs()) {
        SCOPED_TRACE(design);
        Watcher watcher;
        std::atomic<std::uint64_t> quads{0};
        const RunResult run = cases()[0].replay.run(design);
        EXPECT_EQ(
            support::difference(run, cases()[0].replay.run(design, {}, {.quads_done = &quads, .observer = &watcher})),
            "");
        EXPECT_GT(watcher.seen, 0U);
    }
}
