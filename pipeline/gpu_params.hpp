// A whole GPU as numbers: the parameters of every unit, by section of its file in models/gpus.
#pragma once

#include "pipeline/fragment/fragment_params.hpp"
#include "pipeline/fragment/fragment_scheduler_params.hpp"
#include "pipeline/fragment/reorder_buffer.hpp"
#include "pipeline/geometry/geometry_front.hpp"
#include "pipeline/memory/memory_params.hpp"
#include "pipeline/output/crossbar_params.hpp"
#include "pipeline/output/rop_params.hpp"
#include "pipeline/raster/early_depth_test.hpp"
#include "pipeline/raster/rasterizer.hpp"

namespace pipeline {

struct ClockParams {
    double core_mhz = 650;

    static constexpr auto fields() {
        return std::tuple{sim::field<&ClockParams::core_mhz>("Clock of every unit but memory, when that has its own")
                              .unit("MHz")
                              .range(1, 100000)};
    }
};
static_assert(sim::fully_described<ClockParams>);

struct GpuParams {
    ClockParams clock;
    HostParams host;
    GeometryParams geometry;
    RasterizerParams raster;
    EarlyDepthParams early_depth;
    FragmentSchedulerParams scheduler;
    FragmentParams fragment;
    TextureParams texture;
    ReorderBufferParams reorder_buffer;
    CrossbarParams crossbar;
    RopParams rop;
    MemoryParams memory;

    static constexpr auto fields() {
        using P = GpuParams;
        return std::tuple{sim::field<&P::clock>("Clocks"),
                          sim::field<&P::host>("Computer, driver and bus"),
                          sim::field<&P::geometry>("From draw call to triangle"),
                          sim::field<&P::raster>("Rasterizer"),
                          sim::field<&P::early_depth>("Early depth test"),
                          sim::field<&P::scheduler>("Fragment scheduler"),
                          sim::field<&P::fragment>("Fragment pipelines"),
                          sim::field<&P::texture>("Texture unit and L1 cache of a fragment pipeline"),
                          sim::field<&P::reorder_buffer>("Reorder buffer"),
                          sim::field<&P::crossbar>("Crossbar to the ROP groups"),
                          sim::field<&P::rop>("ROP groups"),
                          sim::field<&P::memory>("Memory")};
    }

    /// Places in the reorder buffer.
    std::uint32_t reorder_quads() const {
        return reorder_buffer.quads != 0 ? reorder_buffer.quads : fragment.pipes * fragment.quads_in_flight;
    }
};
static_assert(sim::fully_described<GpuParams>);

} // namespace pipeline
