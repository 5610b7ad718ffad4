#include "pipeline/raster/early_depth_test.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace pipeline {

namespace {

/// Leaves `surviving` in the task; returns how many fragments it takes out.
std::uint64_t reject(QuadTask& task, std::uint32_t surviving) {
    return static_cast<std::uint64_t>(std::popcount(std::exchange(task.mask, surviving)) - std::popcount(surviving));
}

} // namespace

EarlyDepthTest::EarlyDepthTest(sim::Context context, const EarlyDepthParams& params, const PassContext& pass,
                               std::uint32_t partitions)
    : Component(std::move(context)), params_(params), pass_(&pass) {
    port_names_.reserve(partitions);
    for (std::uint32_t rop = 0; rop < partitions; ++rop)
        bounds_in.emplace_back(*this, port_names_.emplace_back("bounds" + std::to_string(rop) + "_in"));
    begin_pass();
}

void EarlyDepthTest::begin_pass() {
    if (!bounds_in.empty())
        last_entry_.assign(std::size_t{4} * pass_->layout.blocks(), std::numeric_limits<float>::infinity());
}

bool EarlyDepthTest::take_bounds() {
    bool progress = false;
    for (sim::In<LastEntryBound>& port : bounds_in)
        while (port.peek() != nullptr) {
            const LastEntryBound bound = port.receive();
            const std::size_t first =
                bound.whole_tile ? std::size_t{16} * bound.block : std::size_t{4} * bound.block + bound.pixel;
            const std::size_t pixels = bound.whole_tile ? 16 : 1;
            for (std::size_t at = first; at < first + pixels; ++at)
                last_entry_[at] = std::min(last_entry_[at], bound.depth);
            ++stats_.bounds;
            progress = true;
        }
    return progress;
}

std::uint32_t EarlyDepthTest::before_last_entry(const QuadTask& task) const {
    if (last_entry_.empty() || pass_->end != FragmentEnd::kbuffer_blend) return task.mask;
    return kept_samples(task, [this](QuadId id, std::uint32_t pixel) {
        const Quad& quad = pass_->stream->quads[id];
        const std::size_t first = std::size_t{4} * pass_->layout.block_of(quad.x, quad.y);
        return pass_->stream->depths[id][pixel] < last_entry_[first + pixel];
    });
}

std::uint32_t EarlyDepthTest::before_surface(const QuadTask& task) const {
    if (pass_->read_only_depth == no_surface) return task.mask;
    const SurfaceStore& surfaces = *pass_->surfaces;
    const SurfaceFormat format = surfaces.info(pass_->read_only_depth).format;
    return kept_samples(task, [&](QuadId id, std::uint32_t pixel) {
        const DepthState& test = pass_->read_only_states.of(*pass_->stream, id).depth;
        if (!test.test) return true;
        const DepthCode code = depth_code(format, pass_->stream->depths[id][pixel]);
        const Quad& quad = pass_->stream->quads[id];
        const std::byte* stored = surfaces.read(pass_->read_only_depth, {quad.x + pixel % 2, quad.y + pixel / 2, 0});
        return passes(test.compare, code, unpack_depth_stencil(format, stored).depth);
    });
}

sim::Activity EarlyDepthTest::tick() {
    bool progress = take_bounds();
    for (std::uint32_t n = 0; n < params_.quads_per_clk; ++n) {
        const QuadTask* input = quads_in.peek();
        if (input == nullptr) break;
        if (!quads_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        QuadTask task = quads_in.receive();
        ++stats_.quads;
        stats_.fragments += static_cast<std::uint64_t>(std::popcount(task.mask));
        stats_.fragments_rejected += reject(task, before_surface(task));
        stats_.fragments_beyond += reject(task, before_last_entry(task));
        if (task.mask != 0)
            quads_out.send(task);
        else
            ++stats_.quads_rejected;
        progress = true;
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
