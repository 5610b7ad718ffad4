// The units of a machine and the surfaces they work on; private to machine*.cpp.
#pragma once

#include "pipeline/fragment/fragment_pipeline.hpp"
#include "pipeline/fragment/fragment_scheduler.hpp"
#include "pipeline/fragment/lock_table.hpp"
#include "pipeline/machine.hpp"
#include "pipeline/memory/memory_system.hpp"
#include "pipeline/output/crossbar.hpp"
#include "pipeline/output/rop.hpp"
#include "sim/described.hpp"

#include <deque>
#include <optional>

namespace pipeline {

/// All counters of a machine; two copies subtracted give those of a pass.
struct MachineStats {
    GeometryStats geometry;
    RasterizerStats raster;
    EarlyDepthStats early_depth;
    FragmentSchedulerStats scheduler;
    FragmentPipelineStats fragment;
    LockTableStats locks;
    ReorderBufferStats reorder_buffer;
    CrossbarStats crossbar;
    RopStats rop;
    MemoryControllerStats memory;

    static constexpr auto fields() {
        using S = MachineStats;
        return std::tuple{sim::field<&S::geometry>("From draw call to triangle"),
                          sim::field<&S::raster>("Rasterizer"),
                          sim::field<&S::early_depth>("Early depth test"),
                          sim::field<&S::scheduler>("Fragment scheduler"),
                          sim::field<&S::fragment>("Fragment pipelines"),
                          sim::field<&S::locks>("Lock table"),
                          sim::field<&S::reorder_buffer>("Reorder buffer"),
                          sim::field<&S::crossbar>("Crossbar"),
                          sim::field<&S::rop>("ROP groups"),
                          sim::field<&S::memory>("Memory partitions")};
    }
};
static_assert(sim::fully_described<MachineStats>);

struct Machine::Units {
    Units(const GpuParams& gpu, const Frame& frame, const MachineOptions& options)
        : simulation(options.seed, options.mode),
          core(simulation.add_clock("core", gpu.clock.core_mhz)),
          memory(simulation, core, gpu.memory),
          front(simulation, core, gpu.geometry, frame, frame.needs, gpu.host) {}

    sim::Simulation simulation;
    const sim::Clock& core;
    PassContext pass;

    std::optional<KBufferMemory> kbuffer;
    std::optional<StoreHistory> history;
    std::optional<QuadPayloads> payloads;
    std::optional<FragmentLists> lists;
    ClearBits kbuffer_clear;        ///< of the k-buffer, or of the heads of lists
    SurfaceStore surfaces;          ///< of the frame
    std::vector<ClearBits> cleared; ///< of each of them
    FixedSurfaces fixed;

    MemorySystem memory;
    GeometryFront front;
    std::optional<Rasterizer> rasterizer;
    std::optional<EarlyDepthTest> early_depth;
    std::optional<FragmentScheduler> scheduler;
    std::optional<LockTable> locks;
    std::deque<FragmentPipeline> pipes;
    std::optional<ReorderBuffer> reorder_buffer;
    std::optional<Crossbar> crossbar;
    std::deque<Rop> rops;

    MachineStats stats_at_pass_start;
    sim::Cycle cycle_at_pass_start = 0;

    MachineStats stats() const;
    sim::Cycle cycle() const { return core.cycle_at(simulation.now()); }
};

} // namespace pipeline
