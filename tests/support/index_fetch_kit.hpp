// The index fetch unit between a source of draws, a memory and a sink of primitives.
#pragma once

#include "pipeline/geometry/index_fetch.hpp"
#include "tests/support/counting.hpp"
#include "tests/support/geometry_scene.hpp"
#include "tests/support/sim_kit.hpp"

#include <utility>
#include <vector>

namespace tests {

inline constexpr sim::Cycle memory_latency = 100;

inline pipeline::MemoryResponse answer(const pipeline::MemoryRequest& request) { return {request.tag}; }

inline pipeline::GeometryPass pass_of(const GeometryScene& scene) {
    return {1, &scene.stream, scene.frame.resources.get(), scene.frame.draws, scene.stream.draws};
}

inline std::vector<pipeline::DrawCommand> commands(const GeometryScene& scene) {
    std::vector<pipeline::DrawCommand> list;
    for (std::uint32_t i = 0; i < scene.stream.draws.size(); ++i) list.push_back({i});
    return list;
}

/// What came of fetching the primitives of all draws of a scene.
struct FetchRun {
    std::vector<pipeline::IndexedPrimitive> primitives;
    std::vector<sim::Cycle> cycles;
    std::vector<pipeline::MemoryRequest> requests;
    pipeline::IndexFetchStats stats;
};

inline FetchRun fetch(const GeometryScene& scene, const pipeline::IndexFetchParams& params,
                      SinkOptions sink_options = {}, sim::Mode mode = sim::Mode::normal, std::uint64_t shuffle = 1,
                      sim::Cycle latency = memory_latency) {
    const pipeline::GeometryPass pass = pass_of(scene);
    Rig rig(mode, 1, shuffle);
    pipeline::IndexFetch stage(rig.context("fetch"), params, pass);
    Responder<pipeline::MemoryRequest, pipeline::MemoryResponse> memory(rig.context("memory"), latency, answer);
    Source<pipeline::DrawCommand> source(rig.context("source"), commands(scene));
    Sink<pipeline::IndexedPrimitive> sink(rig.context("sink"), std::move(sink_options));
    sim::connect(source.out, stage.draws_in, {});
    sim::connect(stage.requests_out, memory.requests_in, {});
    sim::connect(memory.responses_out, stage.responses_in, {});
    sim::connect(stage.primitives_out, sink.in, {.width = params.primitives_per_clk});
    rig.simulation.run();
    return {sink.values(), sink.cycles(), memory.requests(), stage.stats()};
}

/// A draw with primitive restart; ~0 among the indices stands for the restart index of the type.
inline SceneDraw restarted(pipeline::Topology topology, pipeline::IndexType type, std::vector<std::uint32_t> indices) {
    for (std::uint32_t& index : indices)
        if (index == ~0U) index = pipeline::restart_index(type);
    return {.topology = topology,
            .index_type = type,
            .vertex_count = 200,
            .indices = std::move(indices),
            .primitive_restart = true};
}

} // namespace tests
