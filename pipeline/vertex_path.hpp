// The vertex path alone: from draw calls to set-up triangles, without fragments, in two fidelities of one model.
//
// `run_vertex_path` is the event-driven geometry front with memory behind it and a drain instead of the rasterizer.
// `estimate_vertex_path` counts shader runs and lines on the same models without time, on samples of large draws, and
// takes the largest demand of every draw: within 15% of the detailed run (a test), but up to 2.3 times too fast where
// memory is read in random order, whose collisions it does not follow. Nothing is culled: what is measured is the feed
// (specification 004, W1), and the triangles of a closed mesh that face away are set up before they are dropped.
// Source: specification 004, sections 2.2, 5 (frame-time skeleton), 9.11.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/gpu_params.hpp"
#include "sim/json_value.hpp"

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace pipeline {

/// Time that each resource of the vertex path is needed, as if it were alone, in core cycles.
struct VertexPathDemand {
    double cpu = 0, conversion = 0, host_feed = 0, bus = 0;
    double draw_input = 0, index_input = 0, vertex_input = 0, attribute_input = 0, line_input = 0, large_draws = 0;
    double index_fetch = 0, vertex_reuse = 0, line_lookup = 0, vertex_shader = 0, primitive_assembly = 0;
    double triangle_setup = 0, memory = 0;

    /// The input port moves all this one after the other.
    double input_port() const {
        return bus + draw_input + index_input + vertex_input + attribute_input + line_input + large_draws;
    }

    static constexpr auto fields() {
        using P = VertexPathDemand;
        constexpr auto of = [](auto field) { return field.unit("cycles"); };
        return std::tuple{of(sim::field<&P::cpu>("draw calls on the CPU")),
                          of(sim::field<&P::conversion>("conversion of vertex formats by the driver")),
                          of(sim::field<&P::host_feed>("vertices from the application")),
                          of(sim::field<&P::bus>("input port: bytes that cross the bus")),
                          of(sim::field<&P::draw_input>("input port: beginnings of draws")),
                          of(sim::field<&P::index_input>("input port: indices")),
                          of(sim::field<&P::vertex_input>("input port: vertices")),
                          of(sim::field<&P::attribute_input>("input port: attributes")),
                          of(sim::field<&P::line_input>("input port: lines that miss the pre-transform cache")),
                          of(sim::field<&P::large_draws>("input port: what a large index range adds")),
                          of(sim::field<&P::index_fetch>("index fetch unit")),
                          of(sim::field<&P::vertex_reuse>("post-transform cache")),
                          of(sim::field<&P::line_lookup>("lookups in the pre-transform cache")),
                          of(sim::field<&P::vertex_shader>("vertex shaders")),
                          of(sim::field<&P::primitive_assembly>("primitive assembly")),
                          of(sim::field<&P::triangle_setup>("triangle setup")),
                          of(sim::field<&P::memory>("memory bandwidth"))};
    }
};
static_assert(sim::fully_described<VertexPathDemand>);

struct VertexPathDraw {
    GeometryDrawStats counts;
    DrawTerms terms;
    VertexPathDemand demand;
};

struct VertexPathResult {
    std::uint64_t cycles = 0;
    double milliseconds = 0;
    GeometryDrawStats counts; ///< of all draws
    VertexPathDemand demand;  ///< of all draws
    std::vector<VertexPathDraw> draws;
    double share_sampled = 1; ///< of the primitives that the counts were taken from; 1: all of them
    sim::JsonValue stages;    ///< detailed runs only: stage -> params, counters, activity
    double host_seconds = 0;  ///< what the run itself took

    double frames_per_second() const { return milliseconds > 0 ? 1000 / milliseconds : 0; }
    /// Name of the largest demand; the input port counts as one.
    std::string limit() const;
};

struct VertexPathOptions {
    std::uint64_t seed = 1;
    sim::Mode mode = sim::Mode::normal;
    const std::atomic<bool>* stop = nullptr;     ///< becomes true to end the run (throws sim::Interrupted)
    std::uint64_t estimate_primitives = 400'000; ///< most primitives that an estimate looks at
};

/// Throws sim::InputError when the frame has more primitives than 32-bit numbers can count.
VertexPathResult run_vertex_path(const GpuParams& gpu, const Frame& frame, const VertexPathOptions& options = {});
VertexPathResult estimate_vertex_path(const GpuParams& gpu, const Frame& frame, const VertexPathOptions& options = {});

/// What a draw with these counts needs of each resource. Pure; the one place where counts become cycles.
VertexPathDemand vertex_path_demand(const GpuParams& gpu, const Frame& frame, std::uint32_t draw,
                                    const DrawTerms& terms, const GeometryDrawStats& counts);

} // namespace pipeline
