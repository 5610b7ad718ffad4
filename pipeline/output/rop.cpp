#include "pipeline/output/rop.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace pipeline {

Rop::Rop(sim::Context context, const RopParams& params, const PassContext& pass, const KBufferPlan& plan,
         const RopSurfaces& surfaces, const RopShape& shape)
    : Component(std::move(context)),
      params_(params),
      pass_(&pass),
      plan_(&plan),
      surfaces_(surfaces),
      shape_(shape),
      ledger_(pass.layout, *surfaces.history),
      draw_outputs_(shape.draws),
      queue_(params.queue),
      requests_(4 * request_room),
      coming_(shape.memory_partitions),
      tile_reads_(1024),
      tile_answers_(1024),
      answers_(4096),
      invalidations_(4096),
      bounds_(64),
      jobs_(1024) {
    if (plan.shader.visibility == Visibility::never_until_flush) is_unpublished_.resize(pass.layout.blocks());
    if (plan.site == UpdateSite::blender && pass.program != nullptr)
        blender_ = std::make_unique<ProgrammableBlender>(plan.blender, *pass.program, rops);
    if (pass.program != nullptr) cleared_depth_ = pass.program->cleared_depth();
    if (plan.blender.early_reject == EarlyReject::tile)
        tile_bounds_.assign(pass.layout.tiles(), std::numeric_limits<float>::infinity());
    for (std::uint32_t job = static_cast<std::uint32_t>(jobs_.size()); job > 0; --job) free_jobs_.push_back(job - 1);
    port_names_.reserve(std::size_t{3} * shape.pipes + std::size_t{2} * shape.memory_partitions);
    for (std::uint32_t i = 0; i < shape.memory_partitions; ++i) {
        memory_out.emplace_back(*this, port_names_.emplace_back("memory" + std::to_string(i) + "_out"));
        memory_in.emplace_back(*this, port_names_.emplace_back("memory" + std::to_string(i) + "_in"), memory_held_, i);
    }
    for (std::uint32_t pipe = 0; surfaces.payloads != nullptr && pipe < shape.pipes; ++pipe) {
        reads_in.emplace_back(*this, port_names_.emplace_back("reads" + std::to_string(pipe) + "_in"), reads_held_,
                              pipe);
        reads_out.emplace_back(*this, port_names_.emplace_back("reads" + std::to_string(pipe) + "_out"));
        if (plan.shader.coherence == TextureCoherence::invalidate_on_write)
            invalidations_out.emplace_back(*this,
                                           port_names_.emplace_back("invalidations" + std::to_string(pipe) + "_out"));
    }
}

std::uint32_t RopParams::groups() const {
    constexpr std::uint32_t group = 4;
    if (units % group != 0)
        throw sim::InputError(
            fmt::format("rop.units: expected a multiple of {}, as ROPs come in groups of four, got {}; "
                        "the nearest is {}",
                        group, units, (units + group / 2) / group * group));
    return units / group;
}

RopStats Rop::stats() const {
    RopStats stats = stats_;
    stats.depth_tiles = depth_tiles_.stats;
    stats.colour_tiles = colour_tiles_.stats;
    stats.kbuffer_tiles = kbuffer_tiles_.stats;
    return stats;
}

void Rop::begin_pass() {
    const bool kbuffer = pass_->end != FragmentEnd::depth_colour;
    uses_.clear();
    for (const RasterState& state : pass_->states.all()) {
        uses_.push_back(use_of(state, pass_->depth_format, pass_->targets));
        uses_.back().keeps_depth |= pass_->farthest;
    }
    const std::array<bool, 3> used{shape_.depth && !kbuffer, shape_.colour && !kbuffer, kbuffer};
    for (const Use use : {Use::depth, Use::colour, Use::kbuffer}) {
        const auto at = static_cast<std::size_t>(use);
        memory_[at] = memory_of(use);
        cache(use).begin(used[at] ? lines_that_fit(use) : 0, used[at] ? sector_shape(use) : SectorShape{});
        parts_coming_[at].assign(cache(use).size(), 0);
    }
    std::fill(tile_bounds_.begin(), tile_bounds_.end(), std::numeric_limits<float>::infinity());
}

TileCache& Rop::cache(Use use) {
    return use == Use::depth ? depth_tiles_ : use == Use::colour ? colour_tiles_ : kbuffer_tiles_;
}

// The sample quad that comes next of a task of which some may be in the queue already.
QuadTask Rop::next_part(const QuadTask& task) const {
    if (!pass_->multisampled) return task;
    const auto living = static_cast<std::uint32_t>(std::countr_zero(task.mask >> 4 * parts_taken_)) / 4;
    QuadTask part = task;
    part.quad += parts_taken_ + living;
    part.mask = task.mask >> 4 * (parts_taken_ + living) & 15U;
    return part;
}

// The task leaves the input with its last living part.
void Rop::part_taken(const QuadTask& part) {
    const QuadTask& task = *quads_in.peek();
    parts_taken_ = part.quad - task.quad + 1;
    if (std::uint64_t{task.mask} >> 4 * parts_taken_ != 0 && pass_->multisampled) return;
    parts_taken_ = 0;
    quads_in.pop();
}

// Moves one quad into the queue: its sectors are looked up, and fetched if need be, before its turn comes.
bool Rop::admit() {
    const QuadTask* input = quads_in.peek();
    if (input == nullptr || queue_.full() || !has_room()) return false;
    if (input->kind != QuadKind::quad) {
        queue_.push({quads_in.receive(), {}});
        return true;
    }
    Queued queued;
    queued.task = next_part(*input);
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    const std::uint32_t block = pass_->layout.block_of(quad.x, quad.y);
    const bool kbuffer = pass_->end != FragmentEnd::depth_colour;
    draw_ = pass_->draw_of(input->quad);
    const SurfaceUse use_of_surfaces = kbuffer ? SurfaceUse{} : use_of_quad(queued.task.quad);
    const std::array<bool, 3> wanted{use_of_surfaces.depth, use_of_surfaces.colour, kbuffer};
    const std::array<bool, 3> keeps{use_of_surfaces.keeps_depth, use_of_surfaces.keeps_colour,
                                    pass_->end != FragmentEnd::kbuffer_store};
    // All or none, so that a quad that has to wait holds nothing and counts nothing.
    for (const Use use : {Use::depth, Use::colour, Use::kbuffer})
        if (wanted[static_cast<std::size_t>(use)] && cache(use).victim() == no_entry &&
            cache(use).find(cache(use).shape().line_of(block)) == no_entry)
            return false;
    for (const Use use : {Use::depth, Use::colour, Use::kbuffer})
        if (const auto at = static_cast<std::size_t>(use); wanted[at])
            queued.entry[at] = secure_line(use, block, keeps[at]);
    part_taken(queued.task);
    queue_.push(queued);
    stats_.queue_max.note(queue_.size());
    return true;
}

// Executes the oldest quad when its sectors are there, the unit is free and no interlock holds it.
bool Rop::execute(sim::Activity& waiting) {
    if (queue_.empty()) return false;
    waiting = sim::Activity::memory;
    if (unit_free_ > cycle()) {
        wake_at(unit_free_);
        return false;
    }
    const Queued queued = queue_.front();
    if (commits_out.connected() && !commits_out.ready()) {
        waiting = sim::Activity::blocked;
        return false;
    }
    if (queued.task.kind == QuadKind::writeback) {
        queue_.pop();
        write_back_all();
        acknowledge_ = true;
        return true;
    }
    for (const Use use : {Use::depth, Use::colour, Use::kbuffer}) {
        const std::uint32_t entry = queued.entry[static_cast<std::size_t>(use)];
        if (entry != no_entry && cache(use).pending(entry)) return false;
    }
    if (!has_room()) return false;
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    if (pass_->end == FragmentEnd::kbuffer_blend) {
        const sim::Cycle at =
            blender_->may_enter(pass_->layout.block_of(quad.x, quad.y), queued.task.pixels(), cycle());
        if (at > cycle()) {
            if (!std::exchange(interlocked_, true)) ++stats_.interlock_stalls;
            waiting = sim::Activity::hazard;
            wake_at(at);
            return false;
        }
    }
    interlocked_ = false;
    queue_.pop();
    std::uint32_t cycles = 1;
    const std::uint64_t failed_before = stats_.depth_failed.value + stats_.stencil_failed.value;
    switch (pass_->end) {
    case FragmentEnd::depth_colour:
        cycles = run_depth_colour(queued);
        break;
    case FragmentEnd::kbuffer_store:
        cycles = run_store(queued);
        break;
    case FragmentEnd::kbuffer_blend:
        cycles = run_blend(queued);
        break;
    case FragmentEnd::kbuffer_list:
        cycles = run_append(queued);
        break;
    }
    unit_free_ = cycle() + cycles;
    for (const Use use : {Use::depth, Use::colour, Use::kbuffer})
        if (const std::uint32_t entry = queued.entry[static_cast<std::size_t>(use)]; entry != no_entry)
            cache(use).unpin(entry);
    const auto fragments = static_cast<std::uint64_t>(std::popcount(queued.task.mask));
    ++stats_.quads;
    stats_.fragments += fragments;
    DrawOutput& output = draw_outputs_[pass_->draw_of(queued.task.quad)];
    ++output.quads;
    output.fragments += fragments;
    output.passed += fragments - (stats_.depth_failed.value + stats_.stencil_failed.value - failed_before);
    output.first_cycle = std::min(output.first_cycle, cycle());
    output.last_cycle = std::max(output.last_cycle, cycle());
    return true;
}

sim::Activity Rop::tick() {
    if (!pending_blends_.empty()) apply_pending_blends();
    bool progress = take_memory();
    sim::Activity waiting = sim::Activity::starved;
    if (!commits_.empty()) progress |= send_commits();
    progress |= serve_tile_reads();
    if (!reads_held_.empty()) progress |= accept_reads();
    if (writing_back_) progress |= write_back_next();
    if (!writing_back_) {
        progress |= execute(waiting);
        progress |= admit();
    }
    if (!streams_.empty()) progress |= stream_next();
    progress |= send_requests();
    progress |= send_answers();
    if (!invalidations_.empty()) progress |= send_invalidations();
    if (!bounds_.empty()) progress |= send_bounds();
    if (progress) return sim::Activity::busy;
    if (waiting != sim::Activity::starved) return waiting;
    const bool holds = !requests_.empty() || !answers_.empty() || !tile_reads_.empty() || !tile_answers_.empty() ||
                       !invalidations_.empty() || !commits_.empty() || free_stores_.size() != stores_.size() ||
                       writing_back_ || !streams_.empty() || stream_outstanding_ != 0 ||
                       free_jobs_.size() != jobs_.size() || !pending_blends_.empty();
    return holds ? sim::Activity::memory : sim::Activity::starved;
}

} // namespace pipeline
