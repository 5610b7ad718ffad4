// Speed of the geometry front alone: triangles per second of host time, its memory included, into a sink behind setup.
#include "pipeline/geometry/geometry_front.hpp"
#include "pipeline/memory/memory_system.hpp"
#include "tests/support/geometry_scene.hpp"

#include <benchmark/benchmark.h>

namespace {

class TriangleDrain final : public sim::Component {
  public:
    sim::In<pipeline::TriangleTask> in{*this, "in"};
    explicit TriangleDrain(sim::Context context) : Component(std::move(context)) {}
    std::uint64_t taken() const { return taken_; }

  private:
    sim::Activity tick() override {
        if (in.peek() == nullptr) return sim::Activity::starved;
        in.pop();
        ++taken_;
        return sim::Activity::busy;
    }
    std::uint64_t taken_ = 0;
};

void run_front(benchmark::State& state, const tests::IndexedMesh& mesh) {
    const tests::GeometryScene scene = tests::make_scene(mesh);
    const auto triangles = static_cast<double>(scene.stream.primitives.size());
    double ticks = 0;
    double cycles = 0;
    for (auto _ : state) {
        sim::Simulation simulation;
        const sim::Clock& clock = simulation.add_clock("core", 650);
        pipeline::MemorySystem memory(simulation, clock, {});
        pipeline::GeometryFront front(simulation, clock, {}, scene.frame, scene.frame.needs);
        TriangleDrain drain(simulation.context("drain", clock));
        front.attach(memory);
        sim::connect(front.triangles_out(), drain.in, {1, 1, 8});
        front.start(scene.stream, scene.frame.draws);
        simulation.run();
        if (drain.taken() != scene.stream.triangles.size()) state.SkipWithError("triangles were lost");
        ticks = static_cast<double>(simulation.ticks());
        cycles = static_cast<double>(clock.cycle_before(simulation.now()));
    }
    state.counters["triangles_per_second"] =
        benchmark::Counter(triangles, benchmark::Counter::kIsIterationInvariantRate);
    state.counters["ticks_per_triangle"] = ticks / triangles;
    state.counters["cycles_per_triangle"] = cycles / triangles;
}

void geometry_front_grid(benchmark::State& state) { run_front(state, tests::grid_mesh(1000, 500)); }
void geometry_front_random(benchmark::State& state) {
    run_front(state, tests::shuffled(tests::grid_mesh(1000, 500), 1));
}

BENCHMARK(geometry_front_grid)->Unit(benchmark::kMillisecond);
BENCHMARK(geometry_front_random)->Unit(benchmark::kMillisecond);

} // namespace
