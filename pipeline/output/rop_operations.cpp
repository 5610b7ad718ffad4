// What a ROP group does to the pixels of a quad; each operation returns the cycles it takes.
#include "pipeline/output/rop.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace pipeline {

std::uint32_t Rop::cycles_for(std::uint32_t bytes) const {
    const std::uint32_t per_cycle = rops * params_.bytes_per_clk;
    return std::max(1U, (bytes + per_cycle - 1) / per_cycle);
}

std::uint32_t Rop::run_depth_colour(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    const std::uint32_t block = pass_->layout.block_of(quad.x, quad.y);
    const RasterState& state = pass_->states.of(*pass_->stream, queued.task.quad);
    const SurfaceUse& use = use_of_quad(queued.task.quad);
    std::uint32_t kept = 0, written = 0; // masks: that passed, whose depth or stencil was stored
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        const SurfacePlace place{quad.x + pixel % 2, quad.y + pixel / 2, 0};
        const DepthCode code = depth_code(pass_->depth_format, pass_->stream->depths[queued.task.quad][pixel]);
        if (pass_->farthest) capture_farthest(queued.task.quad, pass_->place(quad, pixel), code);
        if (use.depth) {
            const FragmentTest test = test_pixel(state, queued.task.quad, place, code);
            written |= (test.written ? 1U : 0U) << pixel;
            if (!test.passed()) continue;
        }
        ++stats_.depth_passed;
        kept |= 1U << pixel;
        if (!surfaces_.fixed->winner.empty()) surfaces_.fixed->winner[pass_->place(quad, pixel)] = queued.task.quad;
        if (use.colour) store_colours(state, queued.task.quad, pixel, place);
    }
    const std::uint32_t changed = pass_->farthest ? queued.task.mask : written;
    if (use.depth) depth_tiles_.mark_dirty(queued.entry[0], depth_tiles_.shape().in_line(block, changed));
    if (use.colour) colour_tiles_.mark_dirty(queued.entry[1], colour_tiles_.shape().in_line(block, kept));
    const auto count = [](std::uint32_t pixels) { return static_cast<std::uint32_t>(std::popcount(pixels)); };
    const std::uint32_t read = use.reads_depth ? count(queued.task.mask) : 0;
    return cycles_for((read + count(written)) * pass_->depth.pixel_bytes +
                      (use.colour ? count(kept) * (use.keeps_colour ? 2 : 1) * pass_->colour_bytes() : 0));
}

FragmentTest Rop::test_pixel(const RasterState& state, QuadId quad, SurfacePlace place, DepthCode incoming) {
    const FixedSurfaces& fixed = *surfaces_.fixed;
    const SurfaceFormat format = pass_->depth_format;
    const DepthStencil before = unpack_depth_stencil(format, fixed.surfaces->read(fixed.depth, place));
    DepthStencil texel = before;
    const bool front = state.stencil.test && shows_front(state, *pass_->stream, quad);
    const FragmentTest test = test_fragment(state, front, incoming, has_depth(format) ? &texel.depth : nullptr,
                                            has_stencil(format) ? &texel.stencil : nullptr);
    if (texel != before) pack_depth_stencil(format, texel, fixed.surfaces->written(fixed.depth, place));
    if (test.stencil_failed) ++stats_.stencil_failed;
    if (test.depth_failed) ++stats_.depth_failed;
    return test;
}

// MAX blending of depths keeps the farthest; of equal ones the last, as it lies behind the others.
void Rop::capture_farthest(QuadId quad, std::size_t at, DepthCode code) {
    if (surfaces_.fixed->far_winner[at] != ~QuadId{0} && code < surfaces_.fixed->far_depth[at]) return;
    surfaces_.fixed->far_depth[at] = code;
    surfaces_.fixed->far_winner[at] = quad;
}

void Rop::store_colours(const RasterState& state, QuadId quad, std::uint32_t pixel, SurfacePlace place) {
    const FixedSurfaces& fixed = *surfaces_.fixed;
    for (std::size_t target = 0; target < fixed.targets.size(); ++target) {
        if (!pass_->targets[target] || state.write_mask[target] == 0) continue;
        const SurfaceFormat format = *pass_->targets[target];
        const glm::vec4 source = pass_->stream->output(target, quad, pixel);
        std::byte* texel = fixed.surfaces->written(fixed.targets[target], place);
        const glm::vec4 stored = unpack_texel(format, texel);
        const glm::vec4 colour = write_colour(format, state.blend[target], state.write_mask[target], source, stored,
                                              params_.fp16_overflow, &stats_.fp16_overflows.value);
        pack_colour(format, colour, texel, params_.fp16_overflow);
    }
}

// Books the store of one pixel; `oldest` becomes the version of the oldest render target it was computed from.
bool Rop::hazardous_store(const Queued& queued, std::uint32_t block, std::uint32_t pixel, PixelVersion& oldest) {
    const std::uint32_t slot = queued.task.slot;
    oldest = surfaces_.payloads->version(slot, pixel, 0);
    std::uint32_t newest = oldest.stores;
    for (std::uint32_t target = 1; target < pass_->program->targets(); ++target) {
        const PixelVersion read = surfaces_.payloads->version(slot, pixel, target);
        newest = std::max(newest, read.stores);
        if (read.stores < oldest.stores) oldest = read;
    }
    const std::uint32_t stored = surfaces_.kbuffer->latest_version(block, pixel).stores;
    // Where no order is asked for, a predecessor is whoever has stored before.
    const std::uint32_t order = plan_->order_free ? stored : queued.task.order[pixel];
    const QuadPayload& payload = (*surfaces_.payloads)[slot];
    const bool hazard =
        ledger_.book(block, pixel, queued.task.quad,
                     {order, oldest.stores, newest, payload.first_read, payload.last_fill}, cycle() + 1);
    if (plan_->shader.version_bits != 0) {
        const std::uint32_t mask = (1U << plan_->shader.version_bits) - 1;
        const bool differs = ((stored ^ oldest.stores) & mask) != 0 || ((stored ^ newest) & mask) != 0;
        if (differs) ++stats_.hazards_detected;
        if (hazard && !differs) ++stats_.hazards_overlooked;
    }
    return hazard;
}

std::uint32_t Rop::run_store(const Queued& queued) {
    const Quad& quad = pass_->stream->quads[queued.task.quad];
    const std::uint32_t block = pass_->layout.block_of(quad.x, quad.y);
    const std::uint32_t targets = pass_->program->targets();
    const bool rop_view = plan_->shader.visibility == Visibility::rop_cache;
    bool hazardous = false;
    std::uint32_t fragments = 0;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((queued.task.mask >> pixel & 1) == 0) continue;
        PixelVersion oldest;
        hazardous |= hazardous_store(queued, block, pixel, oldest);
        ledger_.enter(block, pixel, queued.task.quad, queued.task.retired, cycle() + 1,
                      rop_view ? cycle() + 1 : StoreHistory::never);
        const float* values = surfaces_.payloads->values(queued.task.slot, pixel);
        std::copy(values, values + std::size_t{4} * targets, surfaces_.kbuffer->latest(block, pixel));
        PixelVersion& version = surfaces_.kbuffer->latest_version(block, pixel);
        version = {version.stores + 1, oldest.chain + 1};
        ++stats_.stores;
        ++fragments;
    }
    const std::uint16_t stored = kbuffer_tiles_.shape().in_line(block, queued.task.mask);
    kbuffer_tiles_.mark_dirty(queued.entry[2], stored);
    if (rop_view && !invalidations_out.empty()) invalidations_.push(block);
    draw_outputs_[pass_->draw_of(queued.task.quad)].hazards += hazardous ? 1 : 0;
    if (plan_->shader.write_through) { // stored for its successors when memory has it
        const std::uint32_t line = kbuffer_tiles_.line(queued.entry[2]);
        const std::uint16_t pixels = with_cleared(Use::kbuffer, line, stored);
        const std::uint32_t store = send_to_memory(block, pixels, commit_of(queued));
        stores_[store].parts =
            write_pixels(Use::kbuffer, line, pixels, tag_store | store, pass_->draw_of(queued.task.quad));
        kbuffer_tiles_.mark_clean(queued.entry[2], stored);
    } else {
        finish(queued);
    }
    return cycles_for(fragments * pass_->program->bytes_per_pixel());
}

Commit Rop::commit_of(const Queued& queued) {
    return {queued.task.slot, queued.task.quad, queued.task.pixels(), QuadKind::quad};
}

void Rop::finish(const Queued& queued) {
    if (commits_out.connected()) commits_out.send(commit_of(queued));
    if (releases_out.connected()) releases_out.send(commit_of(queued));
}

} // namespace pipeline
