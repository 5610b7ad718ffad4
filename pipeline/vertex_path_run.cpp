// The detailed run of the vertex path.
#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/geometry/geometry_front.hpp"
#include "pipeline/memory/memory_system.hpp"
#include "pipeline/vertex_path.hpp"
#include "sim/described.hpp"

#include <chrono>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace pipeline {

namespace {

/// Takes the triangles that the rasterizer would take.
class TriangleDrain final : public sim::Component {
  public:
    sim::In<TriangleTask> triangles_in{*this, "triangles_in"};

    explicit TriangleDrain(sim::Context context) : Component(std::move(context)) {}

  private:
    sim::Activity tick() override {
        bool progress = false;
        for (; triangles_in.peek() != nullptr; triangles_in.pop()) progress = true;
        return progress ? sim::Activity::busy : sim::Activity::starved;
    }
};

/// The primitives of a pass, each of which becomes one triangle, but for those that name a vertex twice.
FragmentStream uncut_stream(const Frame& frame, const Pass& pass) {
    FragmentStream stream;
    std::uint64_t primitives = 0;
    for (const std::uint32_t number : pass.draws) {
        const Draw& draw = frame.draws[number];
        const std::uint32_t each = frame.resources->geometries[draw.geometry].primitive_count();
        for (std::uint32_t instance = 0; instance < draw.instances.size(); ++instance) {
            stream.draws.own().push_back({number, instance, static_cast<std::uint32_t>(primitives), each, 0, 0});
            primitives += each;
            if (primitives > std::numeric_limits<std::uint32_t>::max())
                throw sim::InputError(fmt::format("pass {}: expected at most 2^32 - 1 primitives", pass.name));
        }
    }
    stream.primitives.own().resize(primitives);
    std::uint32_t triangles = 0;
    for (const DrawRange& range : stream.draws) {
        const Geometry& geometry = frame.resources->geometries[frame.draws[range.draw].geometry];
        const PrimitiveReader read(*frame.resources, geometry);
        for (std::uint32_t i = 0; i < range.primitives; ++i) {
            const bool degenerate = is_degenerate(geometry.topology, read(i));
            stream.primitives.own()[range.first_primitive + i] = {
                triangles, static_cast<std::uint8_t>(degenerate ? 0 : 1),
                degenerate ? PrimitiveFate::culled_degenerate : PrimitiveFate::drawn};
            triangles += degenerate ? 0U : 1U;
        }
    }
    return stream;
}

struct Rig {
    Rig(const GpuParams& gpu, const Frame& frame, const VertexPathOptions& options)
        : simulation(options.seed, options.mode),
          core(simulation.add_clock("core", gpu.clock.core_mhz)),
          memory(simulation, core, gpu.memory),
          front(simulation, core, gpu.geometry, frame, frame.needs, gpu.host),
          drain(simulation.context("triangle_drain", core)) {
        front.attach(memory);
        sim::connect(front.triangles_out(), drain.triangles_in, {1, 1, 16});
    }

    sim::Simulation simulation;
    const sim::Clock& core;
    MemorySystem memory;
    GeometryFront front;
    TriangleDrain drain;
};

} // namespace

VertexPathResult run_vertex_path(const GpuParams& gpu, const Frame& frame, const VertexPathOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    Rig rig(gpu, frame, options);
    for (const Pass& pass : frame.passes) {
        if (pass.kind != PassKind::draw) continue;
        const FragmentStream stream = uncut_stream(frame, pass);
        rig.front.start(stream, frame.draws);
        rig.simulation.run(options.stop);
    }
    VertexPathResult result;
    result.cycles = rig.core.cycle_at(rig.simulation.now());
    result.milliseconds = static_cast<double>(result.cycles) / (gpu.clock.core_mhz * 1e3);
    for (std::uint32_t i = 0; i < frame.draws.size(); ++i) {
        VertexPathDraw draw{rig.front.draw_stats(i), rig.front.terms()[i], {}};
        draw.demand = vertex_path_demand(gpu, frame, i, draw.terms, draw.counts);
        sim::add(result.counts, draw.counts);
        sim::add(result.demand, draw.demand);
        result.draws.push_back(draw);
    }
    result.stages = rig.front.report();
    result.stages->update(rig.memory.report());
    result.host_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

} // namespace pipeline
