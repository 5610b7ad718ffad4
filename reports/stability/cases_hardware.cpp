// Machines at their limits: each ends, loses no fragment and no byte, and gives the reference where it should.
#include "reports/stability/catalogue.hpp"
#include "reports/stability/replay.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports::stability::hardware {

using Settings = std::vector<std::string>;

const std::vector<std::string> designs{"existing", "scoreboard", "blender", "multipass", "interlock", "linked-list"};

double number_at(const nlohmann::ordered_json& json, const char* path) {
    const nlohmann::ordered_json::json_pointer pointer(path);
    return json.contains(pointer) ? json.at(pointer).get<double>() : 0.0;
}

/// Fragments of every pass that go in come out or are rejected; the bytes that memory moved are those of its clients.
void conserved(Finding& finding, const pipeline::RunResult& run, const std::string& design) {
    for (const pipeline::PassResult& pass : run.passes) {
        const double in = number_at(pass.counters, "/raster/fragments");
        const double out = number_at(pass.counters, "/rop/fragments") +
                           number_at(pass.counters, "/fragment/peel_rejects") +
                           number_at(pass.counters, "/early_depth/fragments_rejected") +
                           number_at(pass.counters, "/early_depth/fragments_beyond");
        if (pass.counters->contains("raster"))
            finding.require(in == out, fmt::format("{}: {} fragments in, {} out in {}", design, in, out, pass.name));
    }
    double clients = 0.0;
    for (const auto& link : run.bytes->items())
        if (link.key().starts_with("dram_")) clients += number_at(link.value(), "/bytes");
    const double moved = number_at(run.bytes, "/dram/bytes");
    finding.require(moved > 0 && clients == moved, fmt::format("{}: {} bytes moved for {}", design, moved, clients));
    finding.require(run.unexplained_pixels() == 0, design + ": what is wrong is explained");
    if (design == "existing") return;
    finding.require(run.hazards.total() == 0, design + ": no hazard");
    finding.error(static_cast<double>(run.wrong_pixels));
}

/// The usual designs on a small frame with settings of the GPU.
void run_with(Finding& finding, const Settings& settings,
              const char* scene = "gen:discs?n=40&overlap=6&width=24&height=24") {
    const Replay replay(scene, {.width = 24, .height = 24, .threads = 1});
    sim::Cycle slowest = 0;
    for (const std::string& design : designs) {
        const pipeline::RunResult run = replay.run(design, settings);
        conserved(finding, run, design);
        if (design != "multipass" && design != "linked-list") // those work on pixels in passes of their own
            finding.require(run.fragments == replay.streams.back().fragments, design + ": every fragment once");
        slowest = std::max(slowest, run.cycles);
    }
    finding.outcome(fmt::format("six designs end, the slowest after {} cycles", slowest));
}

Case machine(std::string name, Side side, std::string subject, Settings settings) {
    return {"hardware." + std::move(name),
            side,
            std::move(subject),
            "all designs end; fragments and requests are conserved; the reference picture but for unprotected "
            "hardware, whose wrong pixels are explained",
            "pixels",
            0.0,
            [settings = std::move(settings)](Finding& finding) { run_with(finding, settings); }};
}

Case refused(std::string name, Side side, std::string subject, Settings settings, std::string part) {
    return {"hardware." + std::move(name),
            side,
            std::move(subject),
            "refused, with the range",
            "",
            0.0,
            [settings = std::move(settings), part = std::move(part)](Finding& finding) {
                const Replay replay("gen:stack?n=2", {.width = 16, .height = 16, .threads = 1});
                finding.refuses([&] { replay.run("blender", settings); }, part);
            }};
}

/// A machine that is `worse` in one number takes longer than one that is `better`.
Case slower(std::string name, std::string subject, Settings better, Settings worse) {
    return {"hardware." + std::move(name),
            Side::whole,
            std::move(subject),
            "as many fragments, in more time",
            "",
            0.0,
            [better = std::move(better), worse = std::move(worse)](Finding& finding) {
                const Replay replay("gen:discs?n=40&overlap=6&width=24&height=24",
                                    {.width = 24, .height = 24, .threads = 1});
                for (const char* design : {"blender", "interlock"}) {
                    const auto fast = replay.run(design, better), slow = replay.run(design, worse);
                    finding.require(slow.cycles > fast.cycles,
                                    fmt::format("{}: {} > {} cycles", design, slow.cycles, fast.cycles));
                    finding.require(slow.fragments == fast.fragments, "as many fragments");
                }
            }};
}

void add_queues(std::vector<Case>& cases) {
    cases.push_back(refused("queue-0", Side::below, "a ROP queue of 0 quads", {"rop.queue=0"}, "rop.queue"));
    cases.push_back(
        machine("queue-1", Side::at, "queues of one place everywhere",
                {"rop.queue=1", "crossbar.queue=1", "memory.controller.queue=1", "memory.controller.write_queue=1",
                 "scoreboard.side_buffer=1", "reorder_buffer.quads=1", "fragment.quads_in_flight=1",
                 "memory.hub.reads_in_flight=64", "geometry.triangle_setup.queue=2",
                 "geometry.vertex_fetch.vertices_in_flight=1", "geometry.vertex_fetch.lines_in_flight=1"}));
    cases.push_back(machine(
        "queue-4096", Side::above, "queues of 4,096 places",
        {"rop.queue=4096", "crossbar.queue=4096", "memory.controller.queue=4096", "fragment.quads_in_flight=1024"}));
    cases.push_back(machine("in-flight-1", Side::at, "one quad in flight per pipe",
                            {"fragment.quads_in_flight=1", "reorder_buffer.quads=1"}));
    cases.push_back(
        machine("registers-1", Side::at, "one register a lane: fewer than any shader needs", {"fragment.registers=1"}));
}

void add_latencies(std::vector<Case>& cases) {
    cases.push_back(
        machine("latency-1", Side::below, "latencies of one cycle or none everywhere",
                {"fragment.latency=1", "texture.hit_latency=1", "crossbar.latency=1", "rop.read_request_latency=0",
                 "rop.read_return_latency=1", "memory.hub.latency=1", "memory.controller.request_latency=0",
                 "memory.controller.return_latency=0", "early_depth.latency=1", "blender.latency=1"}));
    cases.push_back(machine("latency-usual-jitter", Side::at, "usual latencies with up to 500 cycles of jitter",
                            {"memory.controller.jitter_cycles=500"}));
    cases.push_back(
        machine("latency-1e5", Side::above,
                "reads of 1e6 cycles: 1e5 on each way on the chip, the most there is, and 120 us to open a row",
                {"memory.controller.request_latency=100000", "memory.controller.return_latency=100000",
                 "memory.controller.dram.rcd_read_ns=100000", "memory.controller.dram.rp_ns=20000",
                 "memory.controller.dram.refi_ns=0", "rop.read_return_latency=100000", "clock.core_mhz=6500"}));
    cases.push_back(refused("latency-1e6", Side::above, "an on-chip latency of 1e6 cycles, ten times the most there is",
                            {"memory.controller.return_latency=1000000"}, "memory.controller.return_latency"));
    cases.push_back(slower("latency-costs", "memory latency of 1 and of 10,000 cycles",
                           {"memory.controller.return_latency=1"}, {"memory.controller.return_latency=10000"}));
}

void add_units(std::vector<Case>& cases) {
    cases.push_back(machine("pipes-1", Side::below, "one fragment pipe", {"fragment.pipes=1"}));
    cases.push_back(machine("pipes-64", Side::at, "64 fragment pipes, the most there are", {"fragment.pipes=64"}));
    cases.push_back(refused("pipes-65", Side::above, "65 fragment pipes", {"fragment.pipes=65"}, "1 to 64"));
    cases.push_back(
        refused("partitions-0", Side::below, "no memory partition", {"memory.partitions=0"}, "memory.partitions"));
    cases.push_back(machine("partitions-1", Side::at, "one memory partition", {"memory.partitions=1"}));
    cases.push_back(machine("partitions-64", Side::above, "64 memory partitions", {"memory.partitions=64"}));
    cases.push_back(machine("rops-4", Side::below, "four ROPs: one group", {"rop.units=4", "rop.bytes_per_clk=1"}));
    cases.push_back(
        machine("rops-256", Side::above, "256 ROPs, 64 groups", {"rop.units=256", "rop.kbuffer_cache_bytes=1048576"}));
    cases.push_back(machine("widths-1", Side::below, "one quad, one tile, one byte a cycle everywhere",
                            {"raster.quads_per_clk=1", "raster.tiles_per_clk=1", "early_depth.quads_per_clk=1",
                             "reorder_buffer.retire_per_clk=1", "crossbar.bytes_per_clk=1", "rop.bytes_per_clk=1",
                             "scoreboard.lookups=1"}));
}

void add_memory(std::vector<Case>& cases) {
    cases.push_back(machine("bandwidth-0.1", Side::below, "memory of 0.1 GB/s", {"memory.bandwidth=0.1"}));
    cases.push_back(machine("bandwidth-1000", Side::above, "memory of 1000 GB/s", {"memory.bandwidth=1000"}));
    cases.push_back(slower("bandwidth-costs", "memory of 1000 and of 0.1 GB/s", {"memory.bandwidth=1000"},
                           {"memory.bandwidth=0.1"}));
    cases.push_back(
        machine("cache-of-one-line", Side::at, "caches of one line: texture, and a tile in every ROP group",
                {"texture.l1_bytes=64", "texture.l1_ways=1", "rop.depth_cache_bytes=256", "rop.colour_cache_bytes=1024",
                 "rop.kbuffer_cache_bytes=1024", "geometry.vertex_fetch.cache.bytes=32",
                 "geometry.vertex_fetch.cache.ways=1", "geometry.vertex_reuse.entries=3"}));
    cases.push_back(machine("no-cache", Side::below, "no texture cache at all", {"texture.l1_bytes=0"}));
    cases.push_back(machine("cache-16-mib", Side::above,
                            "k-buffer caches of 16 MiB, texture caches of 1 MiB: larger than the frame",
                            {"rop.kbuffer_cache_bytes=16777216", "texture.l1_bytes=1048576"}));
    cases.push_back(refused("cache-63", Side::below, "a tile cache smaller than one line",
                            {"rop.kbuffer_cache_bytes=63"}, "rop.kbuffer_cache_bytes: expected whole number 64 to"));
    cases.push_back(
        machine("clock-1", Side::below, "a memory clock of 1 MHz beside a core of 650", {"memory.clock_mhz=1"}));
    cases.push_back(machine("clock-uneven", Side::at, "clocks that do not divide each other: 333.333 and 650 MHz",
                            {"memory.clock_mhz=333.333"}));
    cases.push_back(
        machine("clock-1e5", Side::above, "a core of 99,999 MHz before the usual memory", {"clock.core_mhz=99999"}));
    cases.push_back(machine("row-of-64-bytes", Side::below, "DRAM rows of 64 bytes in one bank, no overtaking",
                            {"memory.controller.dram.row_bytes=64", "memory.controller.dram.banks=1",
                             "memory.controller.dram.overtakes=0", "memory.controller.dram.write_batch=1",
                             "memory.controller.dram.read_batch=1"}));
    cases.push_back(machine("refresh-below", Side::below,
                            "a refresh of 50 ns asked for every 60 ns: no row could be opened between two of them",
                            {"memory.controller.dram.refi_ns=60", "memory.controller.dram.rfc_ns=50"}));
    cases.push_back(machine("refresh-at", Side::at,
                            "a refresh of 50 ns every 110 ns: rows that close late leave less than an access needs",
                            {"memory.controller.dram.refi_ns=110", "memory.controller.dram.rfc_ns=50"}));
    cases.push_back(machine("refresh-above", Side::above, "a refresh of 52 ns every 0.1 ms",
                            {"memory.controller.dram.refi_ns=100000"}));
    cases.push_back(machine("slow-rows", Side::below,
                            "rows that take 100 us to open and 100 us to close, refreshed every 3.9 us",
                            {"memory.controller.dram.rcd_read_ns=100000", "memory.controller.dram.rp_ns=100000"}));
    cases.push_back({"hardware.seeds", Side::whole, "jitter of 300 cycles with eight seeds",
                     "as many fragments, the reference picture with every seed, and not always the same time", "pixels",
                     0.0, [](Finding& finding) {
                         const Replay replay("gen:discs?n=40&overlap=6&width=24&height=24",
                                             {.width = 24, .height = 24, .threads = 1});
                         bool differ = false;
                         sim::Cycle first = 0;
                         for (std::uint64_t seed = 1; seed <= 8; ++seed) {
                             pipeline::MachineOptions options;
                             options.seed = seed;
                             const auto run = replay.run("blender", {"memory.controller.jitter_cycles=300"}, options);
                             finding.error(static_cast<double>(run.wrong_pixels));
                             if (seed == 1) first = run.cycles;
                             differ = differ || run.cycles != first;
                         }
                         finding.require(differ, "jitter changes the time");
                     }});
}

} // namespace reports::stability::hardware

std::vector<reports::stability::Case> reports::stability::hardware_cases() {
    std::vector<Case> cases;
    hardware::add_queues(cases);
    hardware::add_latencies(cases);
    hardware::add_units(cases);
    hardware::add_memory(cases);
    return cases;
}
