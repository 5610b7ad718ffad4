#include "pipeline/machine.hpp"

#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/screen_stream.hpp"
#include "pipeline/functional/shade_pass.hpp"
#include "pipeline/functional/shader.hpp"
#include "pipeline/functional/surface_values.hpp"
#include "pipeline/machine_units.hpp"
#include "pipeline/on_chip_area.hpp"
#include "sim/described_json.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

namespace pipeline {

namespace {

/// Behind the last line of a material's texture.
constexpr std::uint64_t first_surface_address = std::uint64_t{1} << 38U;

// Fixed function always works per sample.
bool multisampled(const FragmentStream& stream, const Pass& pass, const KBufferPlan& plan) {
    return stream.samples > 1 && (!pass.runs_program() || plan.works_per_sample());
}

} // namespace

Machine::Machine(const GpuParams& gpu, const Frame& frame, std::span<const FragmentStream> streams,
                 const KBufferDesign& design, const MachineOptions& options)
    : gpu_(gpu), frame_(&frame), streams_(streams), design_(&design), options_(options) {
    const auto draw_passes =
        std::count_if(frame.passes.begin(), frame.passes.end(), [](const Pass& pass) { return pass.rasterizes(); });
    CHECK(static_cast<std::size_t>(draw_passes) == streams.size());
    frame.check_targets();
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
    units.surfaces = SurfaceStore(frame_->surfaces, first_surface_address, gpu_.rop.fp16_overflow);
    units.cleared.resize(frame_->surfaces.size());
    diverged_.resize(frame_->surfaces.size());
    PassContext& pass = units.pass;
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
    const std::uint32_t groups = gpu_.rop.groups();
    // A quad keeps its slot from dispatch to commit: through the reorder buffer, the crossbar and the ROP's queue.
    if (shader_site)
        units.payloads.emplace(gpu_.reorder_quads() +
                                   groups * (gpu_.crossbar.queue + gpu_.crossbar.latency + gpu_.rop.queue),
                               pass.program->floats_per_pixel());
    QuadPayloads* payloads = units.payloads ? &*units.payloads : nullptr;

    auto context = [&units](std::string name) { return units.simulation.context(std::move(name), units.core); };
    units.rasterizer.emplace(context("rasterizer"), gpu_.raster, pass);
    if (frame_->needs.early_depth || rejects_early() || options_.build_everything)
        units.early_depth.emplace(context("early_depth_test"), gpu_.early_depth, pass, rejects_early() ? groups : 0);
    if (locks()) {
        units.locks.emplace(context("lock_table"), plan_.shader, pass, gpu_.fragment.pipes, groups,
                            gpu_.fragment.pipes * gpu_.fragment.quads_in_flight);
        if (plan_.shader.lock_area != LockArea::pixel) plan_.scheduling.tickets = plan_.shader.lock_area;
    }
    units.scheduler.emplace(context("fragment_scheduler"), gpu_.scheduler, gpu_.fragment.pipes, groups, pass,
                            plan_.scheduling, plan_.shader.flush, payloads, options_.quads_done);
    for (std::uint32_t pipe = 0; pipe < gpu_.fragment.pipes; ++pipe)
        units.pipes.emplace_back(context(fmt::format("fragment_pipe{}", pipe)), static_cast<std::uint16_t>(pipe),
                                 gpu_.fragment, gpu_.texture, pass, groups, shader_site ? &plan_.shader : nullptr,
                                 payloads);
    units.reorder_buffer.emplace(context("reorder_buffer"), gpu_.reorder_buffer, gpu_.fragment.pipes,
                                 gpu_.reorder_quads(), plan_.retirement);
    units.crossbar.emplace(context("crossbar"), gpu_.crossbar, pass, groups);
    const RopSurfaces surfaces{&units.fixed, units.kbuffer ? &*units.kbuffer : nullptr, &*units.history,
                               payloads,     units.lists ? &*units.lists : nullptr,     &units.kbuffer_clear};
    for (std::uint32_t rop = 0; rop < groups; ++rop)
        units.rops.emplace_back(
            context(fmt::format("rop{}", rop)), gpu_.rop, pass, plan_, surfaces,
            RopShape{gpu_.fragment.pipes, frame_->draws.size(), uses_depth() || options_.build_everything,
                     uses_colour() || options_.build_everything, gpu_.memory.partitions, gpu_.memory.interleave, rop});
    for (Rop& rop : units.rops)
        if (options_.keep_accesses) rop.keep_accesses();
}

bool Machine::pass_reads_textures() const {
    const bool reads = std::any_of(frame_->passes.begin(), frame_->passes.end(),
                                   [](const Pass& pass) { return pass.rasterizes() && pass.reads_surfaces(); });
    return reads || frame_->needs.textures || peels() || keeps_lists();
}

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

bool Machine::uses_depth() const { return pipeline::uses_depth(*frame_, plan_); }

bool Machine::uses_colour() const { return pipeline::uses_colour(*frame_, plan_); }

std::uint64_t Machine::total_quads(const Frame& frame, std::span<const FragmentStream> streams,
                                   const KBufferDesign& design) {
    const KBufferPlan plan =
        frame.program != nullptr ? design.plan(*frame.program, frame.view_of_kbuffer()) : KBufferPlan{};
    const std::uint32_t passes = frame.program != nullptr ? geometry_passes(plan, *frame.program) : 1;
    std::uint64_t quads = 0;
    std::size_t next = 0;
    for (const Pass& pass : frame.passes) {
        if (!pass.rasterizes()) continue;
        const FragmentStream& stream = streams[next++];
        quads += (pass.runs_program() ? passes : 1) *
                 (multisampled(stream, pass, plan) ? stream.groups : std::uint64_t{stream.quads.size()});
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
    // A shader that reads and writes the k-buffer keeps all render targets in registers, and runs the program behind
    // the read: its scalar operations four wide, for the four fragments of the quad side by side.
    if (units_->pass.end == FragmentEnd::kbuffer_store) {
        registers += frame_->program->targets();
        for (ShaderCost& cost : costs) cost.behind_read = (frame_->program->cost().operations + 3) / 4;
    }
    if (units_->pass.screen != nullptr) registers = units_->pass.screen->registers;
    if (units_->pass.runs_shader()) registers = std::max(registers, units_->pass.pass->shader->shape().registers);
    // Where fragments get their memory from a counter, the shader waits for it: to the point of coherence and back.
    units_->pass.atomic_latency = units_->pass.end == FragmentEnd::kbuffer_list && plan_.lists.counter_per_clk != 0
                                      ? 2 * static_cast<std::uint32_t>(gpu_.crossbar.latency) +
                                            gpu_.rop.read_request_latency + gpu_.rop.read_return_latency
                                      : 0;
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

void Machine::stream_surface(SurfaceStream stream) {
    const auto groups = static_cast<std::uint64_t>(units_->rops.size());
    stream.read_bytes /= groups;
    stream.write_bytes /= groups;
    for (Rop& rop : units_->rops) rop.stream(stream);
}

bool Machine::switches_targets(const Pass& pass) {
    std::vector<SurfaceId> targets = pass.targets;
    targets.insert(targets.end(), {pass.depth, pass.kbuffer});
    return std::exchange(targets_, targets) != targets;
}

void Machine::run_draw(const FragmentStream& stream, const Needs& needs, bool switches) {
    Units& units = *units_;
    units.pass.stream = &stream;
    for (Rop& rop : units.rops) rop.begin_pass();
    units.scheduler->begin_pass();
    if (units.locks) units.locks->begin_pass();
    if (units.early_depth) units.early_depth->begin_pass();
    set_costs(needs);
    DrawSnapshot before = counters_of_draws(stream);
    units.front.read(needs);
    units.front.start(stream, frame_->draws, switches);
    units.simulation.run(options_.stop);
    for (Rop& rop : units.rops) rop.write_back_all();
    units.simulation.run(options_.stop);
    book_draws(std::move(before));
}

void Machine::bind(const Pass& pass, const FragmentStream& stream) {
    PassContext& context = units_->pass;
    units_->fixed = {};
    units_->fixed.surfaces = &units_->surfaces;
    units_->fixed.depth = pass.depth;
    units_->fixed.targets = pass.targets;
    if (pass.depth != no_surface) units_->fixed.depth_clear = {&units_->cleared[pass.depth]};
    for (const SurfaceId target : pass.targets)
        if (target != no_surface) units_->fixed.colour_clear.push_back(&units_->cleared[target]);
    context.pass = &pass;
    context.layout = layout_of(stream.width, stream.height, stream.samples);
    context.multisampled = multisampled(stream, pass, plan_);
    context.states = context.read_only_states = DrawStates(pass, frame_->draws.size());
    context.targets.clear();
    context.colours.clear();
    const SurfaceStore& surfaces = units_->surfaces;
    for (const SurfaceId target : pass.targets) {
        const bool written = target != no_surface;
        context.targets.push_back(written ? std::optional(frame_->surfaces[target].format) : std::nullopt);
        if (written) context.colours.push_back({surfaces.address(target, {}), bytes_of(*context.targets.back())});
    }
    context.depth_format = pass.depth == no_surface ? SurfaceFormat::d24 : frame_->surfaces[pass.depth].format;
    context.depth = {pass.depth == no_surface ? 0 : surfaces.address(pass.depth, {}), bytes_of(context.depth_format)};
    if (pass.runs_program()) context.kbuffer_address = kbuffer_address(pass.kbuffer);
    context.behind = nullptr;
    context.surfaces = &surfaces;
    context.read_only_depth = pass.runs_program() && pass.tests_depth() ? pass.depth : no_surface;
}

// Texture caches hold nothing of what a pass has rewritten.
void Machine::drop_written(std::span<const SurfaceId> written) {
    const SurfaceStore& surfaces = units_->surfaces;
    for (const SurfaceId surface : written)
        if (surface != no_surface) drop_texture_lines(surfaces.address(surface, {}), surfaces.end_of(surface));
}

void Machine::drop_texture_lines(std::uint64_t begin, std::uint64_t end) {
    for (FragmentPipeline& pipe : units_->pipes) pipe.drop_surface(begin, end);
}

void Machine::draw(const Pass& pass, const FragmentStream& unshaded) {
    FragmentStream shaded;
    const bool late = shades_late(pass, unshaded);
    if (late) {
        shaded = unshaded;
        make_outputs(pass.shader->shape(), shaded);
    }
    const FragmentStream& stream = late ? shaded : shade_pass(pass, unshaded, units_->surfaces, shaded);
    bind(pass, stream);
    units_->pass.late = late ? &shaded : nullptr;
    if (pass.cold) {
        units_->front.drop_cached();
        drop_texture_lines(0, ~std::uint64_t{0});
    }
    PassContext& context = units_->pass;
    if (!pass.runs_program()) {
        context.end = FragmentEnd::depth_colour;
        begin(pass.name);
        resolve_cleared(pass.reads);
        run_draw(stream, frame_->needs_of(pass), switches_targets(pass));
        end();
        return;
    }
    CHECK_MSG(!pass.writes_depth() && !pass.tests_stencil(), "a k-buffer pass neither writes depth nor tests stencil");
    if (plan_.site == UpdateSite::passes || plan_.site == UpdateSite::lists) {
        plan_.site == UpdateSite::passes ? draw_layers(pass, stream) : draw_lists(pass, stream);
        store_entries(units_->surfaces, pass.kbuffer, layers_);
        targets_.clear(); // it has used others
        return;
    }
    context.end = plan_.site == UpdateSite::blender ? FragmentEnd::kbuffer_blend : FragmentEnd::kbuffer_store;
    begin(pass.name);
    resolve_cleared(pass.reads);
    if (context.end == FragmentEnd::kbuffer_store && !plan_.shader.tile_memory)
        resolve_cleared(units_->kbuffer_clear, {context.kbuffer_address, kbuffer_bytes()});
    run_draw(stream, frame_->needs_of(pass), switches_targets(pass));
    end();
    store_entries(units_->surfaces, pass.kbuffer, units_->kbuffer->image());
}

void Machine::screen(const ScreenPass& pass, std::uint32_t triangle, std::uint64_t written_address) {
    PassContext& context = units_->pass;
    const FragmentStream stream = screen_stream(pass.width, pass.height, triangle);
    units_->fixed = {}; // its values are those of run_lists()
    context.layout = layout_of(pass.width, pass.height);
    context.end = FragmentEnd::depth_colour;
    context.states = DrawStates();
    context.read_only_depth = no_surface;
    context.pass = nullptr;
    context.targets = {SurfaceFormat::rgba8}; // whatever its format, a store without blending
    context.colours = {{written_address, pass.written_bytes}};
    context.multisampled = false;
    context.screen = &pass;
    begin(pass.name);
    run_draw(stream, {});
    end();
    targets_.clear();
    context.screen = nullptr;
}

void Machine::run_and_judge(std::size_t number, const FragmentStream& stream, const ReferenceImage& reference) {
    const Pass& pass = frame_->passes[number];
    SurfaceStore before = units_->surfaces; // pages are shared until the pass writes to them
    draw(pass, stream);
    drop_written(written_surfaces(pass));
    judge(number, stream, before, reference);
}

RunResult Machine::run(const ReferenceImage& reference) {
    CHECK_MSG(reference.fp16_overflow == gpu_.rop.fp16_overflow,
              "the reference stores 16-bit floats otherwise than this GPU");
    RunResult result;
    std::size_t next = 0;
    for (std::size_t number = 0; number < frame_->passes.size(); ++number) {
        const Pass& pass = frame_->passes[number];
        switch (pass.kind) {
        case PassKind::clear:
            clear(pass);
            note_clear(number, reference);
            break;
        case PassKind::draw:
        case PassKind::screen:
            run_and_judge(number, streams_[next++], reference);
            break;
        case PassKind::compose:
            compose_and_judge(number, reference);
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
    result.judgements = std::move(judgements_);
    result.host_ticks = units_->simulation.ticks();
    return result;
}

} // namespace pipeline
