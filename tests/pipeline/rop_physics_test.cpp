// Caches, ROPs and crossbar against what theory says of them: bytes that have to move, bounds that nothing exceeds, and
// how near a run comes to its bound. Rates are those of the steady state: the difference of a short and a long run.
#include "tests/support/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>

namespace {

using pipeline::RunResult;
using support::counter;
using support::Replay;

using Settings = std::vector<std::string>;

Settings operator+(Settings a, const Settings& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::uint64_t bytes(const RunResult& run, const char* client) {
    const std::string name = std::string("dram_") + client;
    return run.bytes->contains(name) ? counter(run.bytes, name + "/bytes") : 0;
}

/// `layers` times the whole picture.
const Replay& quads(int layers, std::uint32_t side, const std::string& workload) {
    static std::map<std::tuple<int, std::uint32_t, std::string>, Replay> made;
    const auto key = std::tuple{layers, side, workload};
    if (const auto found = made.find(key); found != made.end()) return found->second;
    const std::vector<std::string> knobs =
        workload == "opaque" ? std::vector<std::string>{} : std::vector<std::string>{"k=4", "entry=rgbz"};
    return made.emplace(key, Replay(fmt::format("gen:quads?n={}", layers), {side, side, workload, "auto", knobs}))
        .first->second;
}

double cycles(const RunResult& run, const char* pass) {
    return static_cast<double>(support::pass_named(run, pass).cycles);
}

/// Fragments per cycle of another 64 layers.
double fragment_rate(const std::string& design, std::uint32_t side, const std::string& workload, const char* pass,
                     const Settings& settings) {
    const RunResult few = quads(32, side, workload).run(design, settings),
                    many = quads(96, side, workload).run(design, settings);
    EXPECT_EQ(many.wrong_pixels, 0U);
    return static_cast<double>(many.fragments - few.fragments) / (cycles(many, pass) - cycles(few, pass));
}

const Settings on_chip{"rop.kbuffer_cache_bytes=4194304"}; // the k-buffer and more

} // namespace

// Both triangles of the quad cover the blocks of the diagonal. With room for all of the picture each sector is cleared,
// changed and written once; with less, those of the diagonal were written back when the second triangle comes.
TEST(RopPhysics, PHY_P11_FastClearSavesTheFirstReadOfEverySector) {
    constexpr std::uint64_t k_buffer = 128 * 128 * 64, diagonal = 64 * 256;
    const Replay& picture = quads(1, 128, "transparency");
    const Settings fast{"rop.fast_clear=true"};
    const RunResult roomy = picture.run("blender", fast + on_chip), run = picture.run("blender", fast),
                    slow = picture.run("blender");
    EXPECT_EQ(bytes(roomy, "tile_read"), 0U);
    EXPECT_EQ(bytes(roomy, "tile_write"), k_buffer);
    EXPECT_EQ(bytes(roomy, "copy"), 0U);
    EXPECT_LE(bytes(run, "tile_read"), diagonal);
    EXPECT_EQ(bytes(slow, "tile_read"), bytes(run, "tile_read") + k_buffer);
    EXPECT_EQ(bytes(slow, "copy"), k_buffer); // the clear
    for (const RunResult* each : {&roomy, &run, &slow}) EXPECT_EQ(each->wrong_pixels, 0U);
}

// A surface beyond the table's size is cleared by writing.
TEST(RopPhysics, PHY_P11_TableOfFastClearsHasASize) {
    const Replay& picture = quads(1, 128, "transparency");
    const RunResult within = picture.run("blender", {"rop.fast_clear=true", "rop.clear_sectors=4096"}),
                    beyond = picture.run("blender", {"rop.fast_clear=true", "rop.clear_sectors=4095"});
    EXPECT_EQ(bytes(within, "copy"), 0U);
    EXPECT_EQ(bytes(beyond, "copy"), 128U * 128 * 64);
    EXPECT_EQ(counter(beyond.stages, "rop/counters/clears"), 128U * 128 * 64);
}

// Shaders read the k-buffer as a texture, and texture units do not know what is cleared.
TEST(RopPhysics, PHY_P11_TextureUnitsNeedTheClearedSectorsWritten) {
    const Replay& picture = quads(1, 64, "transparency");
    for (const char* design : {"existing", "interlock"}) {
        const RunResult run = picture.run(design, {"rop.fast_clear=true"});
        EXPECT_EQ(counter(run.stages, "rop/counters/resolves"), 64U * 64 * 64) << design;
        EXPECT_EQ(counter(run.stages, "rop/counters/clears"), 0U) << design;
    }
    // Each layer but the last is read when the next one is peeled.
    const RunResult peeled = picture.run("multipass", {"rop.fast_clear=true"});
    EXPECT_EQ(counter(peeled.stages, "rop/counters/resolves"), 2U * 64 * 64 * 4); // layers 1 and 2: nothing was drawn
    EXPECT_EQ(peeled.wrong_pixels, 0U);
}

// Stores of whole quads: 64 bytes a pixel, less what is overwritten on chip. Partial ones: whole bursts of two pixels.
TEST(RopPhysics, PHY_P11_StoresMoveWhatTheyStore) {
    const Replay scattered("gen:random-quads?n=2000&area=16384",
                           {128, 128, "transparency", "auto", {"k=4", "entry=rgbz"}});
    const RunResult whole = scattered.run("existing");
    const std::uint64_t stores = counter(whole.stages, "rop/counters/stores");
    EXPECT_LE(bytes(whole, "tile_write"), stores * 64);
    EXPECT_GE(bytes(whole, "tile_write"), stores * 64 / 2);
    EXPECT_EQ(bytes(whole, "tile_read"), 0U);
    const Replay discs("gen:discs?n=200&overlap=4&width=64&height=64",
                       {64, 64, "transparency", "auto", {"k=4", "entry=rgbz"}});
    const RunResult edges = discs.run("existing", {"rop.kbuffer_cache_bytes=1024"}); // a sector for each group
    EXPECT_LE(bytes(edges, "tile_write"), counter(edges.stages, "rop/counters/stores") * 128);
}

// 36 operations on 4 lanes take 9 cycles; the diagonal costs every layer 6% more quads than pixels.
TEST(RopPhysics, PHY_S3_PHY_R2_BlenderRunsAtTheRateOfItsRopsForEveryNumberOfThem) {
    for (const std::uint32_t units : {4U, 8U, 12U, 16U, 32U, 64U}) {
        const double bound = units / 9.0;
        const double rate = fragment_rate("blender", 32, "transparency", "geometry",
                                          on_chip + Settings{fmt::format("rop.units={}", units)});
        EXPECT_LE(rate, bound) << units;
        EXPECT_GE(rate, 0.85 * bound) << units;
    }
}

// Four entries of depth: 3 cycles a quad. A miss takes about 300.
TEST(RopPhysics, PHY_P4_LookAheadHidesAMiss) {
    const Replay replay("gen:discs?n=300&overlap=8&width=64&height=64",
                        {64, 64, "transparency", "auto", {"k=4", "entry=z"}});
    std::map<std::uint32_t, double> time;
    for (const std::uint32_t queue : {16U, 128U, 256U})
        time[queue] = static_cast<double>(replay.run("blender", {fmt::format("rop.queue={}", queue)}).cycles);
    EXPECT_GE(time[256], 0.9 * time[128]);
    EXPECT_GE(time[16], 1.5 * time[128]); // so it is not that nothing misses
    const double interlock = static_cast<double>(replay.run("interlock").cycles);
    EXPECT_LE(time[128], 1.1 * interlock);
}

// Depth and colour on chip, 64x64 pixels. Six pipes of two cycles a quad give 3 quads a cycle; with twelve the four
// groups of ROPs are the limit. The diagonal makes 33 quads of 32.
TEST(RopPhysics, PHY_R4_OpaqueFillIsThatOfTheSlowestUnit) {
    const double six = fragment_rate("existing", 64, "opaque", "opaque", {}) / 4 * 33 / 32;
    EXPECT_LE(six, 3.001);
    EXPECT_GE(six, 0.9 * 3);
    const double twelve = fragment_rate("existing", 64, "opaque", "opaque", {"fragment.pipes=12"}) / 4 * 33 / 32;
    EXPECT_LE(twelve, 4.001);
    EXPECT_GE(twelve, 0.9 * 4);
}
