// The units of a ROP group that modify a pixel's entries in place, and the lists of fragments; each operation
// returns the cycles it takes.
#include "pipeline/output/rop.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace pipeline {

void Rop::apply_pending_blends() {
    const std::size_t floats = surfaces_.kbuffer->floats_per_pixel();
    std::size_t done = 0;
    while (done < pending_blends_.size() && pending_blends_[done].written <= cycle()) {
        const PendingBlend& blend = pending_blends_[done];
        const float* from = pending_values_.data() + done * floats;
        std::copy(from, from + floats, surfaces_.kbuffer->latest(blend.block, blend.pixel));
        surfaces_.kbuffer->latest_version(blend.block, blend.pixel) = blend.version;
        ++done;
    }
    if (done == 0) return;
    pending_blends_.erase(pending_blends_.begin(), pending_blends_.begin() + static_cast<std::ptrdiff_t>(done));
    pending_values_.erase(pending_values_.begin(),
                          pending_values_.begin() + static_cast<std::ptrdiff_t>(done * floats));
}

// Cycles one ROP works on a fragment. Peeling compares with all entries at once and writes those that move; atomic
// minima visit one entry after the other until one was empty.
std::uint32_t Rop::unit_work(const float* pixel, const float* entry) const {
    const ModifyProgram& program = *pass_->program;
    if (plan_->blender.unit == BlendUnit::program) return blender_->cycles_per_fragment();
    const std::uint32_t k = program.k(), floats = program.floats_per_entry(), depth = program.depth_slot();
    std::uint32_t slot = 0, filled = 0;
    for (std::uint32_t i = 0; i < k; ++i) {
        slot += pixel[i * floats + depth] <= entry[depth] ? 1U : 0U;
        filled += pixel[i * floats + depth] < cleared_depth_ ? 1U : 0U;
    }
    if (plan_->blender.unit == BlendUnit::atomic_min) return slot == k ? k : std::min(filled + 1, k);
    const std::uint32_t bytes = (k - slot) * floats * 4;
    return 1 + (bytes + plan_->blender.port_bytes - 1) / plan_->blender.port_bytes;
}

std::uint32_t Rop::run_blend(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    const std::uint32_t block = pass_->layout.block_of(quad.x, quad.y);
    const bool delayed = blender_->site().interlock == BlendInterlock::none;
    const ModifyProgram& program = *pass_->program;
    const std::size_t floats = program.floats_per_pixel();
    const auto fragments = static_cast<std::uint32_t>(std::popcount(queued.task.mask));
    const sim::Cycle delayed_until = cycle() + std::max(plan_->blender.latency, blender_->cycles_per_quad(fragments));
    bool hazardous = false;
    std::uint32_t work = 0;
    std::uint32_t changed_pixels = 0; // mask
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        std::array<float, largest_entry> entry;
        program.make_entry(pass_->stream->fragment(queued.task.quad, pixel), entry.data());
        float* stored = surfaces_.kbuffer->latest(block, pixel);
        PixelVersion& version = surfaces_.kbuffer->latest_version(block, pixel);
        // Samples of a group are numbered here, as their groups come.
        const std::uint32_t number =
            pass_->multisampled ? surfaces_.history->store(block, pixel).number : queued.task.order[pixel];
        const std::uint32_t order = plan_->order_free ? version.stores : number;
        // Without an interlock the next read may come before the result is written, to the array that all reads see.
        const sim::Cycle written_at = delayed ? delayed_until : cycle() + 1;
        hazardous |= ledger_.book(block, pixel, queued.task.quad,
                                  {order, version.stores, version.stores, cycle(), cycle()}, written_at);
        ledger_.enter(block, pixel, queued.task.quad, queued.task.retired, written_at, written_at);
        ++stats_.program_runs;
        work += unit_work(stored, entry.data());
        if (!delayed) {
            const bool changed = program.insert(stored, entry.data());
            if (changed) {
                ++stats_.insertions;
                changed_pixels |= 1U << pixel;
            }
            version = {order + 1, version.chain + 1};
            if (changed && bounds_out.connected()) note_bound(block, pixel);
            continue;
        }
        pending_blends_.push_back({block, pixel, {order + 1, version.chain + 1}, delayed_until});
        const std::size_t value = pending_values_.size();
        pending_values_.insert(pending_values_.end(), stored, stored + floats);
        if (!program.insert(pending_values_.data() + value, entry.data())) continue;
        ++stats_.insertions;
        changed_pixels |= 1U << pixel;
    }
    const std::uint32_t cycles = blender_->cycles_of(work, fragments);
    const sim::Cycle written = blender_->enter(block, queued.task.pixels(), cycle(), cycles);
    if (plan_->blender.unit == BlendUnit::atomic_min) stats_.atomics += work;
    if (delayed) wake_at(written);
    stats_.program_cycles += cycles;
    kbuffer_tiles_.mark_dirty(queued.entry[2], kbuffer_tiles_.shape().in_line(block, changed_pixels));
    draw_outputs_[pass_->draw_of(queued.task.quad)].hazards += hazardous ? 1 : 0;
    finish(queued);
    return cycles;
}

float Rop::last_depth(std::uint32_t block, std::uint32_t pixel) {
    const ModifyProgram& program = *pass_->program;
    return surfaces_.kbuffer->latest(block,
                                     pixel)[(program.k() - 1) * program.floats_per_entry() + program.depth_slot()];
}

// A bound only falls, so one that finds no room may be dropped: it costs rejections, not correctness.
void Rop::note_bound(std::uint32_t block, std::uint32_t pixel) {
    float depth = last_depth(block, pixel);
    if (depth >= cleared_depth_ || bounds_.full()) return;
    if (plan_->blender.early_reject == EarlyReject::pixel) {
        bounds_.push({block, static_cast<std::uint8_t>(pixel), false, depth});
        return;
    }
    const std::uint32_t tile = SurfaceLayout::tile_of_block(block);
    for (std::uint32_t other = tile * 4; other < tile * 4 + 4; ++other)
        for (std::uint32_t corner = 0; corner < 4; ++corner)
            if (pass_->layout.inside(pass_->layout.block_x(other) + corner % 2,
                                     pass_->layout.block_y(other) + corner / 2))
                depth = std::max(depth, last_depth(other, corner));
    if (depth >= std::min(tile_bounds_[tile], cleared_depth_)) return;
    tile_bounds_[tile] = depth;
    bounds_.push({tile, 0, true, depth});
}

bool Rop::send_bounds() {
    bool progress = false;
    for (; !bounds_.empty() && bounds_out.ready(); progress = true) {
        bounds_out.send(bounds_.front());
        bounds_.pop();
    }
    return progress;
}

// Adds the fragments to their pixels' lists: the head of the list is exchanged in the cache, the fragment itself goes
// to memory. The counter that gives out memory is one for all groups: each gets its share of what it serves.
std::uint32_t Rop::run_append(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    const std::uint32_t block = pass_->layout.block_of(quad.x, quad.y);
    const ListsSite& lists = plan_->lists;
    const std::uint64_t room = lists.pool == 0 ? ~std::uint64_t{0} : lists.pool / pass_->layout.partitions;
    const auto fragments = static_cast<std::uint32_t>(std::popcount(queued.task.mask));
    std::uint32_t kept = 0, kept_pixels = 0;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        const std::uint32_t order = queued.task.order[pixel];
        if (lists.per_pixel != 0 && (order < pass_->first_kept || order >= pass_->first_kept + lists.per_pixel)) {
            ++stats_.passed_over;
            continue;
        }
        if (stats_.kept >= room) {
            surfaces_.lists->lose(block, pixel);
            ++stats_.not_kept;
            continue;
        }
        surfaces_.lists->keep(block, pixel, {queued.task.quad, static_cast<std::uint32_t>(stats_.kept.value)});
        ++stats_.kept;
        ++kept;
        kept_pixels |= 1U << pixel;
    }
    kbuffer_tiles_.mark_dirty(queued.entry[2], kbuffer_tiles_.shape().in_line(block, kept_pixels));
    write_nodes(queued.task, kept);
    finish(queued);
    std::uint32_t cycles = cycles_for(2 * fragments * lists.head_bytes);
    if (lists.counter_per_clk != 0) {
        const std::uint32_t atomics = lists.counter == ListCounter::quad ? 1 : fragments;
        stats_.counter_atomics += atomics;
        cycles =
            std::max(cycles, (atomics * pass_->layout.partitions + lists.counter_per_clk - 1) / lists.counter_per_clk);
    }
    return cycles;
}

// The last `count` nodes that were kept, of one quad: where the counter gave them memory.
void Rop::write_nodes(const QuadTask& task, std::uint32_t count) {
    const Quad& quad = pass_->stream->quads[task.quad];
    const std::uint32_t bytes = plan_->lists.fragment_bytes;
    std::uint64_t byte = (stats_.kept - count) * bytes;
    for (const std::uint64_t end = stats_.kept * bytes; byte < end;) {
        const std::uint64_t part = std::min(end - byte, FragmentLists::chunk - byte % FragmentLists::chunk);
        request(FragmentLists::address(pass_->layout.partition_of(quad.x, quad.y), pass_->layout.partitions, byte),
                static_cast<std::uint32_t>(part), 0, MemoryClient::tile_write, true, pass_->draw_of(task.quad));
        byte += part;
    }
}

} // namespace pipeline
