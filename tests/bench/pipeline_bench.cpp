// Whole runs of the machine: simulated cycles and fragments per host second, triangles per second, memory per quad.
#include "tests/support/replay.hpp"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <string>

namespace {

void run_design(benchmark::State& state, const char* design, const std::string& scene, const char* entry) {
    support::ReplayOptions options;
    options.width = options.height = 512;
    options.knobs = {std::string("entry=") + entry};
    const support::Replay replay(scene, options);
    double cycles = 0, fragments = 0;
    for (auto _ : state) {
        const pipeline::RunResult result = replay.run(design);
        cycles += static_cast<double>(result.cycles);
        fragments += static_cast<double>(result.fragments);
    }
    const pipeline::FragmentStream& stream = replay.kbuffer_stream();
    state.counters["cycles/s"] = benchmark::Counter(cycles, benchmark::Counter::kIsRate);
    state.counters["fragments/s"] = benchmark::Counter(fragments, benchmark::Counter::kIsRate);
    state.counters["stream bytes/quad"] =
        static_cast<double>(stream.bytes()) / static_cast<double>(std::max<std::size_t>(stream.quads.size(), 1));
}

// Four layers over the whole screen: every unit behind the rasterizer is busy.
constexpr const char* fragment_bound = "gen:quads?n=4";
constexpr const char* million_triangles = "gen:blob?triangles=1000000";

} // namespace

BENCHMARK_CAPTURE(run_design, existing_quads_rgbz, "existing", fragment_bound, "rgbz")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_design, scoreboard_quads_rgbz, "scoreboard", fragment_bound, "rgbz")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_design, blender_quads_rgbz, "blender", fragment_bound, "rgbz")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_design, multipass_quads_rgbz, "multipass", fragment_bound, "rgbz")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_design, blender_quads_z, "blender", fragment_bound, "z")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_design, existing_million_triangles, "existing", million_triangles, "rgbz")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_design, blender_million_triangles, "blender", million_triangles, "rgbz")
    ->Unit(benchmark::kMillisecond);
