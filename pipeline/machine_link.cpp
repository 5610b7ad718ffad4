// How the units of a machine are wired: latency, width and room of every link.
#include "pipeline/machine_units.hpp"

#include <algorithm>

namespace pipeline {

void Machine::link() {
    Units& units = *units_;
    const std::uint32_t width = gpu_.raster.quads_per_clk;
    const bool guarded = plan_.scheduling.guard != nullptr;
    const sim::Cycle lookup = 1 + (guarded ? plan_.scheduling.lookup_latency : 0);
    const std::uint32_t accepted = guarded ? plan_.scheduling.lookups : gpu_.fragment.pipes;
    textures_linked_ = pass_reads_textures() || options_.build_everything;
    units.front.attach(units.memory);
    sim::connect(units.front.triangles_out(), units.rasterizer->triangles_in, {1, gpu_.raster.tiles_per_clk, 16});
    // Inputs are as wide as the wider side, so that the unit, not the wire, sets the rate.
    const sim::ChannelConfig to_scheduler{lookup, std::max(width, accepted),
                                          static_cast<std::uint32_t>(8 * (lookup + 1) * width)};
    if (units.early_depth) {
        sim::connect(units.rasterizer->quads_out, units.early_depth->quads_in, {1, width, 4 * width});
        sim::ChannelConfig delayed = to_scheduler;
        delayed.latency += gpu_.early_depth.latency;
        delayed.capacity = static_cast<std::uint32_t>(delayed.width * (delayed.latency + 8));
        sim::connect(units.early_depth->quads_out, units.scheduler->quads_in, delayed);
    } else {
        sim::connect(units.rasterizer->quads_out, units.scheduler->quads_in, to_scheduler);
    }
    const std::uint32_t pipes = gpu_.fragment.pipes;
    const std::uint32_t order_width = std::max(pipes, gpu_.reorder_buffer.retire_per_clk);
    const bool in_order = plan_.retirement == Retirement::in_order;
    sim::connect(units.scheduler->order_out, units.reorder_buffer->order_in,
                 {1, order_width, in_order ? gpu_.reorder_quads() : 4 * order_width});
    const sim::Cycle cross = gpu_.crossbar.latency;
    // Two tiles wait in front of a pipe, so that the others get theirs meanwhile.
    const std::uint32_t tile = gpu_.scheduler.tile;
    const sim::ChannelConfig to_pipe =
        tile == 0 ? sim::ChannelConfig{1, 1, 4} : sim::ChannelConfig{1, width, std::max(tile * tile / 2, 4 * width)};
    for (std::uint32_t pipe = 0; pipe < pipes; ++pipe) {
        FragmentPipeline& unit = units.pipes[pipe];
        sim::connect(units.scheduler->pipes_out[pipe], unit.quads_in, to_pipe);
        sim::connect(unit.done_out, units.reorder_buffer->completions_in[pipe], {1, 1, 4});
        if (textures_linked_) units.memory.attach(unit.textures_out, unit.textures_in);
        if (units.locks) {
            const sim::Cycle way = plan_.shader.lock_latency;
            sim::connect(unit.locks_out, units.locks->requests_in[pipe], {way, 1, static_cast<std::uint32_t>(way + 4)});
            sim::connect(units.locks->grants_out[pipe], unit.locks_in,
                         {way, plan_.shader.grants_per_clk,
                          static_cast<std::uint32_t>(plan_.shader.grants_per_clk * (way + 4))});
        }
        for (std::size_t rop = 0; rop < unit.reads_out.size(); ++rop) {
            sim::connect(unit.reads_out[rop], units.rops[rop].reads_in[pipe],
                         {cross, 1, static_cast<std::uint32_t>(cross + 4)});
            sim::connect(units.rops[rop].reads_out[pipe], unit.reads_in[rop],
                         {cross, 4, static_cast<std::uint32_t>(4 * (cross + 2))});
            if (!unit.invalidations_in.empty())
                sim::connect(units.rops[rop].invalidations_out[pipe], unit.invalidations_in[rop], {1, 16, 64});
        }
    }
    const std::uint32_t retire = gpu_.reorder_buffer.retire_per_clk;
    sim::connect(units.reorder_buffer->quads_out, units.crossbar->quads_in, {1, retire, 4 * retire});
    for (std::uint32_t rop = 0; rop < units.rops.size(); ++rop) {
        Rop& unit = units.rops[rop];
        sim::connect(units.crossbar->partitions_out[rop], unit.quads_in,
                     {cross, 1, static_cast<std::uint32_t>(cross) + 1}); // what is on the way
        units.memory.attach_rop(rop, unit.memory_out, unit.memory_in);
        if (!units.scheduler->commits_in.empty())
            sim::connect(unit.commits_out, units.scheduler->commits_in[rop], {1, 2, 16});
        if (units.locks) sim::connect(unit.releases_out, units.locks->releases_in[rop], {1, 2, 16});
        if (rejects_early())
            sim::connect(unit.bounds_out, units.early_depth->bounds_in[rop],
                         {cross, 1, static_cast<std::uint32_t>(cross + 4)});
    }
}

} // namespace pipeline
