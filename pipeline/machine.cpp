#include "pipeline/machine.hpp"

#include "pipeline/functional/colour_format.hpp"
#include "pipeline/functional/composite.hpp"
#include "pipeline/functional/screen_stream.hpp"
#include "pipeline/functional/shader.hpp"
#include "pipeline/machine_units.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace pipeline {

namespace {

// Fixed function always works per sample.
bool multisampled(const Frame& frame, const Pass& pass, const KBufferPlan& plan) {
    return frame.view.samples > 1 && (!pass.kbuffer || plan.works_per_sample());
}

} // namespace

Machine::Machine(const GpuParams& gpu, const Frame& frame, std::span<const FragmentStream> streams,
                 const KBufferDesign& design, const MachineOptions& options)
    : gpu_(gpu), frame_(&frame), streams_(streams), design_(&design), options_(options) {
    const auto draw_passes = std::count_if(frame.passes.begin(), frame.passes.end(),
                                           [](const Pass& pass) { return pass.kind == PassKind::draw; });
    CHECK(static_cast<std::size_t>(draw_passes) == streams.size());
    if (frame.program != nullptr) {
        if (const std::string reason = design.refuses(*frame.program); !reason.empty())
            throw sim::InputError(
                fmt::format("design {}: cannot run program {}: {}", design.id(), frame.program->id(), reason));
        plan_ = design.plan(*frame.program, frame.view_of_kbuffer());
    } else {
        plan_.site = UpdateSite::passes;
    }
    if (frame.view.samples > 1 && plan_.works_per_sample() && plan_.scheduling.guard != nullptr)
        throw sim::InputError(fmt::format(
            "design {}: cannot draw {} samples per pixel: its guard sees sample quads, and it works on groups",
            design.id(), frame.view.samples));
    build();
    link();
}

Machine::~Machine() = default;

void Machine::build() {
    units_ = std::make_unique<Units>(gpu_, *frame_, options_);
    Units& units = *units_;
    units.simulation.set_observer(options_.observer);
    PassContext& pass = units.pass;
    pass.frame = frame_;
    pass.program = frame_->program.get();
    pass.layout = layout_of(frame_->view_of_kbuffer());
    pass.peel = plan_.passes;
    pass.textures = frame_->needs.textures;
    if (!streams_.empty()) pass.stream = &streams_[0];

    const bool shader_site = frame_->needs.kbuffer && plan_.site == UpdateSite::fragment_shader;
    const bool in_place = shader_site || (frame_->needs.kbuffer && plan_.site == UpdateSite::blender);
    if (in_place)
        units.kbuffer.emplace(pass.layout, *pass.program,
                              shader_site && plan_.shader.visibility != Visibility::rop_cache);
    if (keeps_lists()) units.lists.emplace(pass.layout);
    units.history.emplace(units.kbuffer ? pass.layout : SurfaceLayout{0, 0, 1});
    const auto partitions = gpu_.memory.partitions;
    // A quad keeps its slot from dispatch to commit: through the reorder buffer, the crossbar and the ROP's queue.
    if (shader_site)
        units.payloads.emplace(gpu_.reorder_quads() + partitions * (gpu_.crossbar.queue + gpu_.rop.queue),
                               pass.program->floats_per_pixel());
    QuadPayloads* payloads = units.payloads ? &*units.payloads : nullptr;

    auto context = [&units](std::string name) { return units.simulation.context(std::move(name), units.core); };
    units.rasterizer.emplace(context("rasterizer"), gpu_.raster, pass);
    if (frame_->needs.early_depth || rejects_early() || options_.build_everything)
        units.early_depth.emplace(context("early_depth_test"), gpu_.early_depth, pass,
                                  rejects_early() ? partitions : 0);
    if (locks()) {
        units.locks.emplace(context("lock_table"), plan_.shader, pass, gpu_.fragment.pipes, partitions,
                            gpu_.fragment.pipes * gpu_.fragment.quads_in_flight);
        if (plan_.shader.lock_area != LockArea::pixel) plan_.scheduling.tickets = plan_.shader.lock_area;
    }
    units.scheduler.emplace(context("fragment_scheduler"), gpu_.fragment.pipes, partitions, pass, plan_.scheduling,
                            plan_.shader.flush, payloads, options_.quads_done);
    for (std::uint32_t pipe = 0; pipe < gpu_.fragment.pipes; ++pipe)
        units.pipes.emplace_back(context(fmt::format("fragment_pipe{}", pipe)), static_cast<std::uint16_t>(pipe),
                                 gpu_.fragment, gpu_.texture, pass, partitions, shader_site ? &plan_.shader : nullptr,
                                 payloads);
    units.reorder_buffer.emplace(context("reorder_buffer"), gpu_.reorder_buffer, gpu_.fragment.pipes,
                                 gpu_.reorder_quads(), plan_.retirement);
    units.crossbar.emplace(context("crossbar"), gpu_.crossbar, pass, partitions);
    const RopSurfaces surfaces{&units.fixed, units.kbuffer ? &*units.kbuffer : nullptr, &*units.history, payloads,
                               units.lists ? &*units.lists : nullptr};
    for (std::uint32_t rop = 0; rop < partitions; ++rop)
        units.rops.emplace_back(context(fmt::format("rop{}", rop)), gpu_.rop, pass, plan_, surfaces,
                                RopShape{gpu_.fragment.pipes, most_tiles(), frame_->draws.size(),
                                         uses_depth() || options_.build_everything,
                                         uses_colour() || options_.build_everything, kbuffer_tiles()});
}

// Full-screen passes draw onto the picture or onto surfaces that are no larger than the k-buffer's.
std::uint32_t Machine::most_tiles() const {
    return std::max(layout_of(frame_->view).tiles(), layout_of(frame_->view_of_kbuffer()).tiles());
}

// Tile memory holds every tile of the partition; partitions own tiles in turn, row by row.
std::uint32_t Machine::kbuffer_tiles() const {
    if (!units_->kbuffer && !units_->lists) return 0;
    if (!frame_->needs.kbuffer || !plan_.shader.tile_memory) return gpu_.rop.cache_tiles;
    const SurfaceLayout& layout = units_->pass.layout;
    return (layout.tiles_x() / layout.partitions + 1) * layout.tiles_y();
}

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
    for (std::uint32_t pipe = 0; pipe < pipes; ++pipe) {
        FragmentPipeline& unit = units.pipes[pipe];
        sim::connect(units.scheduler->pipes_out[pipe], unit.quads_in, {1, 1, 4});
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
    for (std::uint32_t rop = 0; rop < gpu_.memory.partitions; ++rop) {
        Rop& unit = units.rops[rop];
        sim::connect(units.crossbar->partitions_out[rop], unit.quads_in,
                     {cross, 1, gpu_.crossbar.queue + static_cast<std::uint32_t>(cross)});
        units.memory.attach_rop(rop, unit.memory_out, unit.memory_in);
        if (!units.scheduler->commits_in.empty())
            sim::connect(unit.commits_out, units.scheduler->commits_in[rop], {1, 2, 16});
        if (units.locks) sim::connect(unit.releases_out, units.locks->releases_in[rop], {1, 2, 16});
        if (rejects_early())
            sim::connect(unit.bounds_out, units.early_depth->bounds_in[rop],
                         {cross, 1, static_cast<std::uint32_t>(cross + 4)});
    }
}

bool Machine::pass_reads_textures() const { return frame_->needs.textures || peels() || frame_->screen_draw; }

bool Machine::peels() const { return frame_->needs.kbuffer && plan_.site == UpdateSite::passes; }

bool Machine::keeps_lists() const { return frame_->needs.kbuffer && plan_.site == UpdateSite::lists; }

bool Machine::locks() const {
    return frame_->needs.kbuffer && plan_.site == UpdateSite::fragment_shader &&
           plan_.shader.critical_section != CriticalSection::none;
}

bool Machine::rejects_early() const {
    return frame_->needs.kbuffer && plan_.site == UpdateSite::blender &&
           plan_.blender.early_reject != EarlyReject::none;
}

bool Machine::uses_depth() const { return frame_->needs.depth || peels(); }

bool Machine::uses_colour() const {
    return frame_->needs.colour_surface || (peels() && frame_->program->needs_colour());
}

std::uint64_t Machine::total_quads(const Frame& frame, std::span<const FragmentStream> streams,
                                   const KBufferDesign& design) {
    const KBufferPlan plan =
        frame.program != nullptr ? design.plan(*frame.program, frame.view_of_kbuffer()) : KBufferPlan{};
    const std::uint32_t passes = frame.program != nullptr ? geometry_passes(plan, *frame.program) : 1;
    std::uint64_t quads = 0;
    std::size_t next = 0;
    for (const Pass& pass : frame.passes) {
        if (pass.kind != PassKind::draw) continue;
        const FragmentStream& stream = streams[next++];
        quads += (pass.kbuffer ? passes : 1) *
                 (multisampled(frame, pass, plan) ? stream.groups : std::uint64_t{stream.quads.size()});
    }
    return quads;
}

// The shader's cost depends on what the pass asks of it: depth-only entries need no colour.
void Machine::set_costs(const Needs& needs) {
    std::vector<ShaderCost>& costs = units_->pass.shader_costs;
    costs.resize(frame_->draws.size());
    std::uint32_t registers = 1;
    for (std::size_t draw = 0; draw < costs.size(); ++draw) {
        const Draw& call = frame_->draws[draw];
        costs[draw] = shader_cost(frame_->resources->materials[call.material],
                                  frame_->resources->geometries[call.geometry], needs);
        registers = std::max(registers, costs[draw].registers);
    }
    // A shader that reads and writes the k-buffer keeps all render targets in registers.
    if (units_->pass.end == FragmentEnd::kbuffer_store) registers += frame_->program->targets();
    if (units_->pass.screen != nullptr) registers = units_->pass.screen->registers;
    for (FragmentPipeline& pipe : units_->pipes) pipe.begin_pass(registers);
}

void Machine::begin(const std::string& name) {
    passes_.push_back({name, units_->cycle(), 0, {}});
    units_->stats_at_pass_start = units_->stats();
}

void Machine::end() {
    PassResult& pass = passes_.back();
    pass.cycles = units_->cycle() - pass.first_cycle;
    pass.counters = sim::to_json(sim::difference(units_->stats(), units_->stats_at_pass_start));
}

void Machine::stream_surface(std::uint64_t read_bytes, std::uint64_t write_bytes) {
    const auto partitions = static_cast<std::uint64_t>(units_->rops.size());
    for (Rop& rop : units_->rops) rop.stream(read_bytes / partitions, write_bytes / partitions);
    units_->simulation.run(options_.stop);
}

void Machine::run_draw(const FragmentStream& stream, const Needs& needs) {
    Units& units = *units_;
    units.pass.stream = &stream;
    for (Rop& rop : units.rops) rop.begin_pass();
    units.scheduler->begin_pass();
    if (units.locks) units.locks->begin_pass();
    if (units.early_depth) units.early_depth->begin_pass();
    set_costs(needs);
    units.front.read(needs);
    units.front.start(stream, frame_->draws);
    units.simulation.run(options_.stop);
    for (Rop& rop : units.rops) rop.write_back_all();
    units.simulation.run(options_.stop);
}

void Machine::clear(const Pass& pass) {
    begin(pass.name);
    const std::size_t places = frame_->view.places();
    const std::uint64_t pixels = frame_->view.samples_drawn(),
                        kbuffer_pixels = frame_->view_of_kbuffer().samples_drawn();
    std::uint64_t bytes = 0;
    for (const std::string& surface : pass.writes) {
        if (surface == "depth") {
            units_->fixed.depth.assign(places, farthest_depth(frame_->depth_format));
            bytes += pixels * depth_bytes(frame_->depth_format);
        }
        if (surface == "colour") {
            units_->fixed.colour.assign(places, through_format(frame_->colour_format, frame_->background));
            bytes += pixels * colour_bytes(frame_->colour_format);
        }
        // Peeling clears its layers one by one instead, lists their heads.
        if (surface == "kbuffer" && units_->lists) bytes += kbuffer_pixels * plan_.lists.head_bytes;
        if (surface == "kbuffer" && units_->kbuffer && !plan_.shader.tile_memory)
            bytes += kbuffer_pixels * frame_->program->bytes_per_pixel();
    }
    if (!gpu_.rop.fast_clear && bytes != 0) stream_surface(0, bytes);
    end();
}

void Machine::draw(const Pass& pass, const FragmentStream& stream) {
    PassContext& context = units_->pass;
    FixedSurfaces& fixed = units_->fixed;
    const std::size_t places = frame_->view.places();
    context.layout = layout_of(frame_->view_of(pass));
    context.multisampled = multisampled(*frame_, pass, plan_);
    fixed.winner.resize(places, ~QuadId{0});
    if (pass.depth.test || pass.depth.write) fixed.depth.resize(places, farthest_depth(frame_->depth_format));
    if (pass.colour) fixed.colour.resize(places, through_format(frame_->colour_format, frame_->background));
    context.depth = pass.depth;
    context.blend = pass.blend;
    context.colour_write = pass.colour;
    context.colour_bytes = colour_bytes(frame_->colour_format) * pass.colour_targets;
    context.depth_format = frame_->depth_format;
    context.read_only_format = frame_->depth_format;
    context.depth_bytes = depth_bytes(frame_->depth_format);
    context.behind = nullptr;
    if (!pass.kbuffer) {
        context.end = FragmentEnd::depth_colour;
        context.read_only_depth = nullptr;
        begin(pass.name);
        run_draw(stream, frame_->needs_of(pass));
        end();
        return;
    }
    CHECK_MSG(!pass.depth.write, "a k-buffer pass does not write the depth surface");
    if (plan_.site == UpdateSite::passes) return draw_layers(pass, stream);
    if (plan_.site == UpdateSite::lists) return draw_lists(pass, stream);
    context.read_only_depth = pass.depth.test ? &fixed.depth : nullptr;
    context.end = plan_.site == UpdateSite::blender ? FragmentEnd::kbuffer_blend : FragmentEnd::kbuffer_store;
    begin(pass.name);
    run_draw(stream, frame_->needs_of(pass));
    end();
}

// What computes the picture, where the workload says how.
void Machine::resolve() {
    if (!frame_->screen_draw || !frame_->resolve) return;
    const std::vector<float> kbuffer = kbuffer_image(), colour = colour_surface(), depth = depth_surface();
    const auto passes = with_drained(*frame_, {kbuffer, colour, depth}, [this](const FinishedSurfaces& surfaces) {
        return frame_->resolve->screen_passes(*frame_, surfaces);
    });
    for (const ScreenPass& pass : passes) screen(pass);
}

void Machine::screen(const ScreenPass& pass) {
    PassContext& context = units_->pass;
    const FragmentStream stream = screen_stream(pass.width, pass.height, *frame_->screen_draw);
    CHECK(layout_of(pass.width, pass.height).tiles() <= most_tiles());
    units_->drawn = std::exchange(units_->fixed, {});
    units_->fixed.winner.assign(std::size_t{pass.width} * pass.height, ~QuadId{0});
    context.layout = layout_of(pass.width, pass.height);
    context.end = FragmentEnd::depth_colour;
    context.depth = {};
    context.read_only_depth = nullptr;
    context.blend = BlendMode::replace;
    context.colour_write = true; // its values are the workload's
    context.colour_bytes = pass.written_bytes;
    context.multisampled = false;
    context.screen = &pass;
    begin(pass.name);
    run_draw(stream, {});
    end();
    context.screen = nullptr;
    units_->fixed = std::move(units_->drawn);
}

RunResult Machine::run(const ReferenceImage& reference) {
    RunResult result;
    std::size_t next = 0;
    for (const Pass& pass : frame_->passes) {
        switch (pass.kind) {
        case PassKind::clear:
            clear(pass);
            break;
        case PassKind::draw:
            draw(pass, streams_[next++]);
            break;
        case PassKind::resolve:
            resolve();
            break;
        }
    }
    units_->pass.layout = layout_of(frame_->view_of_kbuffer());
    result.design = design_->id();
    result.core_mhz = gpu_.clock.core_mhz;
    result.cycles = units_->cycle();
    list_units(result);
    collect_pixels(result, reference);
    collect_hazards(result);
    collect_counters(result);
    result.passes = std::move(passes_);
    result.host_ticks = units_->simulation.ticks();
    return result;
}

} // namespace pipeline
