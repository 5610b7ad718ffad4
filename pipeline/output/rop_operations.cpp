// What a ROP partition does to the pixels of a quad; each operation returns the cycles it takes.
#include "pipeline/output/rop.hpp"

#include "pipeline/functional/colour_format.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace pipeline {

std::uint32_t Rop::cycles_for(std::uint32_t bytes) const {
    const std::uint32_t per_cycle = rops() * params_.bytes_per_clk;
    return std::max(1U, (bytes + per_cycle - 1) / per_cycle);
}

std::uint32_t Rop::run_depth_colour(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    std::uint32_t passed = 0;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        const std::size_t at = static_cast<std::size_t>(quad.y + pixel / 2) * pass_->layout.width + quad.x + pixel % 2;
        const DepthCode code = depth_code(pass_->depth_format, pass_->stream->depths[queued.task.quad][pixel]);
        if (pass_->depth.test && !depth_less(code, surfaces_.fixed->depth[at])) {
            ++stats_.depth_failed;
            continue;
        }
        ++stats_.depth_passed;
        ++passed;
        if (pass_->depth.write) surfaces_.fixed->depth[at] = code;
        surfaces_.fixed->winner[at] = queued.task.quad;
        if (pass_->colour_write && !surfaces_.fixed->colour.empty()) write_colour(queued.task.quad, pixel, at);
    }
    if (passed != 0 && pass_->depth.write) depth_tiles_.mark_dirty(queued.entry[0]);
    if (passed != 0 && pass_->colour_write) colour_tiles_.mark_dirty(queued.entry[1]);
    const auto fragments = static_cast<std::uint32_t>(std::popcount(queued.task.mask));
    const std::uint32_t blended = pass_->blend == BlendMode::replace ? 1 : 2; // reads the colour, too
    return cycles_for((pass_->depth.test ? fragments * pass_->depth_bytes : 0) +
                      (pass_->depth.write ? passed * pass_->depth_bytes : 0) +
                      (pass_->colour_write ? passed * blended * pass_->colour_bytes : 0));
}

void Rop::write_colour(QuadId quad, std::uint32_t pixel, std::size_t at) {
    glm::vec4 source = pass_->stream->colours[quad][pixel];
    if (pass_->blend != BlendMode::replace) source.a *= pass_->frame->opacity;
    glm::vec4& stored = surfaces_.fixed->colour[at];
    stored = write_through(pass_->frame->colour_format, pass_->blend, source, stored);
}

std::uint32_t Rop::run_store(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    const std::uint32_t block = pass_->layout.block_of(quad.x, quad.y);
    const std::uint32_t tile = SurfaceLayout::tile_of_block(block);
    const std::uint32_t targets = pass_->program->targets();
    const bool rop_view = plan_->shader.visibility == Visibility::rop_cache;
    const std::uint32_t slot = queued.task.slot;
    bool hazardous = false;
    std::uint32_t fragments = 0;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        PixelVersion oldest = surfaces_.payloads->version(slot, pixel, 0);
        std::uint32_t newest = oldest.stores;
        for (std::uint32_t target = 1; target < targets; ++target) {
            const PixelVersion read = surfaces_.payloads->version(slot, pixel, target);
            newest = std::max(newest, read.stores);
            if (read.stores < oldest.stores) oldest = read;
        }
        hazardous |=
            ledger_.book(block, pixel, queued.task.quad,
                         {queued.task.order[pixel], oldest.stores, newest, (*surfaces_.payloads)[slot].last_read});
        ledger_.enter(block, pixel, queued.task.quad, queued.task.retired, cycle(),
                      rop_view ? cycle() + 1 : StoreHistory::never);
        const float* values = surfaces_.payloads->values(slot, pixel);
        std::copy(values, values + std::size_t{4} * targets, surfaces_.kbuffer->latest(block, pixel));
        PixelVersion& version = surfaces_.kbuffer->latest_version(block, pixel);
        version = {version.stores + 1, oldest.chain + 1};
        ++stats_.stores;
        ++fragments;
    }
    kbuffer_tiles_.mark_dirty(queued.entry[2]);
    if (plan_->shader.write_through) {
        request(tile_address(Use::kbuffer, tile) + std::uint64_t{block % 4} * (tile_bytes(Use::kbuffer) / 4),
                tile_bytes(Use::kbuffer) / 4, 0, MemoryClient::tile_write, true, pass_->draw_of(queued.task.quad));
        kbuffer_tiles_.mark_clean(queued.entry[2]);
        publish(tile);
    }
    if (rop_view && !invalidations_out.empty()) invalidations_.push(block);
    finish(queued, hazardous);
    return cycles_for(fragments * pass_->program->bytes_per_pixel());
}

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

std::uint32_t Rop::run_blend(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    const std::uint32_t block = pass_->layout.block_of(quad.x, quad.y);
    const auto fragments = static_cast<std::uint32_t>(std::popcount(queued.task.mask));
    const std::uint32_t cycles = blender_->cycles_per_quad(fragments);
    const sim::Cycle written = blender_->enter(block, queued.task.mask, cycle(), cycles);
    const bool delayed = blender_->site().interlock == BlendInterlock::none;
    const ModifyProgram& program = *pass_->program;
    const std::size_t floats = program.floats_per_pixel();
    bool hazardous = false;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        std::array<float, largest_entry> entry;
        program.make_entry(pass_->stream->fragment(queued.task.quad, pixel), entry.data());
        float* stored = surfaces_.kbuffer->latest(block, pixel);
        PixelVersion& version = surfaces_.kbuffer->latest_version(block, pixel);
        const std::uint32_t order = queued.task.order[pixel];
        hazardous |= ledger_.book(block, pixel, queued.task.quad, {order, version.stores, version.stores, cycle()});
        ledger_.enter(block, pixel, queued.task.quad, queued.task.retired, cycle(), delayed ? written : cycle() + 1);
        ++stats_.program_runs;
        if (!delayed) {
            if (program.insert(stored, entry.data())) ++stats_.insertions;
            version = {order + 1, version.chain + 1};
            continue;
        }
        pending_blends_.push_back({block, pixel, {order + 1, version.chain + 1}, written});
        const std::size_t value = pending_values_.size();
        pending_values_.insert(pending_values_.end(), stored, stored + floats);
        if (program.insert(pending_values_.data() + value, entry.data())) ++stats_.insertions;
    }
    if (delayed) wake_at(written);
    stats_.program_cycles += cycles;
    kbuffer_tiles_.mark_dirty(queued.entry[2]);
    finish(queued, hazardous);
    return cycles;
}

void Rop::finish(const Queued& queued, bool hazardous) {
    draw_outputs_[pass_->draw_of(queued.task.quad)].hazards += hazardous ? 1 : 0;
    if (commits_out.connected())
        commits_out.send({queued.task.slot, queued.task.quad, queued.task.mask, QuadKind::quad});
}

} // namespace pipeline
