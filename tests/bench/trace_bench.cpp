// Draw traces: bytes of uncompressed content written and read per second on one core.
#include "sim/random.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/recordings.hpp"
#include "traces/camera.hpp"
#include "traces/rtrace/chunk_reader.hpp"
#include "traces/trace.hpp"

#include <algorithm>
#include <benchmark/benchmark.h>

namespace {

/// A trace, and the file that it is written to.
class TraceFile {
  public:
    explicit TraceFile(traces::Trace trace) : trace_(std::move(trace)) {
        write();
        traces::rtrace::ChunkReader file(path());
        while (const auto head = file.next()) bytes_ += head->content_bytes;
    }
    void write() const { traces::write_trace(trace_, path()); }
    traces::Trace read() const { return traces::read_trace(path()); }
    std::filesystem::path path() const { return folder_.path() / "x.rtrace"; }
    void count(benchmark::State& state) const {
        state.SetBytesProcessed(static_cast<std::int64_t>(bytes_) * state.iterations());
    }

  private:
    ropsim_test::TemporaryFolder folder_;
    traces::Trace trace_;
    std::uint64_t bytes_ = 0; ///< uncompressed
};

const TraceFile& million() {
    static const TraceFile one(traces::capture(
        {.scene = "gen:blob?triangles=1000000", .settings = {}, .writer = "bench", .name = {}, .licence = {}}));
    return one;
}

void write_trace(benchmark::State& state) {
    const TraceFile& one = million(); // made before time is taken
    for (auto _ : state) one.write();
    one.count(state);
}
BENCHMARK(write_trace)->Unit(benchmark::kMillisecond);

/// Decompressed, and held against their hashes.
void read_chunks(benchmark::State& state) {
    for (auto _ : state) {
        traces::rtrace::ChunkReader file(million().path());
        while (file.next()) benchmark::DoNotOptimize(file.content().data());
    }
    million().count(state);
}
BENCHMARK(read_chunks)->Unit(benchmark::kMillisecond);

/// With everything that is checked and derived: indices, colours, bounds.
void read_trace(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(million().read().scene.radius);
    million().count(state);
}
BENCHMARK(read_trace)->Unit(benchmark::kMillisecond);

traces::RecordedSurface texture(sim::Random& random) {
    traces::RecordedSurface surface;
    surface.width = surface.height = 128;
    std::vector<std::byte> texels(traces::level_bytes(surface, 0));
    for (std::size_t at = 0; at < texels.size(); at += 16)
        std::fill_n(texels.begin() + static_cast<std::ptrdiff_t>(at), 16, static_cast<std::byte>(random.below(256)));
    surface.levels[0] = std::move(texels);
    return surface;
}

/// 1,000 textures of 64 KiB in tiles of few colours, 10,000 draws, each with values of its own.
traces::Trace with_many_draws() {
    traces::Trace trace = support::recorded_trace(support::quad_recording());
    traces::Recording& recording = *trace.recording;
    sim::Random random(1, "textures");
    for (int i = 0; i < 1000; ++i) recording.surfaces.push_back(texture(random));
    const traces::RecordedCommand draw = recording.frames[0].commands.back();
    for (std::uint32_t i = 0; i < 10'000; ++i) {
        recording.values.push_back(recording.values[0]);
        recording.values.back()[0].words[12] = i;
        recording.frames[0].commands.push_back(draw);
        std::get<traces::RecordedDraw>(recording.frames[0].commands.back()).vertex_values = 2 + i;
    }
    return trace;
}

const TraceFile& many_draws() {
    static const TraceFile one(with_many_draws());
    return one;
}

void write_recorded_trace(benchmark::State& state) {
    const TraceFile& draws = many_draws(); // made before time is taken
    for (auto _ : state) draws.write();
    draws.count(state);
}
BENCHMARK(write_recorded_trace)->Unit(benchmark::kMillisecond);

void read_recorded_trace(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(many_draws().read().recording->frames.size());
    many_draws().count(state);
}
BENCHMARK(read_recorded_trace)->Unit(benchmark::kMillisecond);

} // namespace
