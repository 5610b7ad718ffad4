#include "pipeline/raster/early_depth_test.hpp"

#include <bit>

namespace pipeline {

std::uint8_t EarlyDepthTest::surviving(const QuadTask& task) const {
    if (pass_->read_only_depth == nullptr) return task.mask;
    const Quad& quad = pass_->stream->quads[task.quad];
    std::uint8_t mask = 0;
    for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        if ((task.mask >> pixel & 1) == 0) continue;
        const std::size_t at = static_cast<std::size_t>(quad.y + pixel / 2) * pass_->layout.width + quad.x + pixel % 2;
        const float depth = pass_->stream->depths[task.quad][pixel];
        if (depth_less(depth_code(pass_->read_only_format, depth), (*pass_->read_only_depth)[at]))
            mask = static_cast<std::uint8_t>(mask | 1U << pixel);
    }
    return mask;
}

sim::Activity EarlyDepthTest::tick() {
    bool progress = false;
    for (std::uint32_t n = 0; n < params_.quads_per_clk; ++n) {
        const QuadTask* input = quads_in.peek();
        if (input == nullptr) break;
        if (!quads_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        QuadTask task = quads_in.receive();
        const auto before = static_cast<std::uint64_t>(std::popcount(task.mask));
        task.mask = surviving(task);
        const auto after = static_cast<std::uint64_t>(std::popcount(task.mask));
        ++stats_.quads;
        stats_.fragments += before;
        stats_.fragments_rejected += before - after;
        if (task.mask != 0)
            quads_out.send(task);
        else
            ++stats_.quads_rejected;
        progress = true;
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
