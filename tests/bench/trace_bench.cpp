// Draw traces: bytes of uncompressed content written and read per second on one core.
#include "tests/support/program_run.hpp"
#include "traces/camera.hpp"
#include "traces/rtrace/chunk_reader.hpp"
#include "traces/trace.hpp"

#include <benchmark/benchmark.h>

namespace {

class Million {
  public:
    Million() {
        trace_ = traces::capture(
            {.scene = "gen:blob?triangles=1000000", .settings = {}, .writer = "bench", .name = {}, .licence = {}});
        for (const pipeline::Buffer& buffer : trace_.scene.resources->buffers) bytes_ += buffer.bytes.size();
        write();
    }
    void write() const { traces::write_trace(trace_, file()); }
    std::filesystem::path file() const { return folder_.path() / "x.rtrace"; }
    void count(benchmark::State& state) const {
        state.SetBytesProcessed(static_cast<std::int64_t>(bytes_ * state.iterations()));
    }

  private:
    ropsim_test::TemporaryFolder folder_;
    traces::Trace trace_;
    std::uint64_t bytes_ = 0;
};

const Million& million() {
    static const Million one;
    return one;
}

void write_trace(benchmark::State& state) {
    for (auto _ : state) million().write();
    million().count(state);
}
BENCHMARK(write_trace)->Unit(benchmark::kMillisecond);

/// Decompressed, and held against their hashes.
void read_chunks(benchmark::State& state) {
    for (auto _ : state) {
        traces::rtrace::ChunkReader file(million().file());
        while (file.next()) benchmark::DoNotOptimize(file.content().data());
    }
    million().count(state);
}
BENCHMARK(read_chunks)->Unit(benchmark::kMillisecond);

/// With everything that is checked and derived: indices, colours, bounds.
void read_trace(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(traces::read_trace(million().file()).scene.radius);
    million().count(state);
}
BENCHMARK(read_trace)->Unit(benchmark::kMillisecond);

} // namespace
