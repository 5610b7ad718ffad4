// The loads and stores of a full-screen pass that go past the L1 and depend on each other.
#include "pipeline/fragment/fragment_pipeline.hpp"

namespace pipeline {

namespace {

constexpr std::uint32_t bytes_per_fetch = 64; ///< that the texture unit moves in the time of an RGBA32F fetch

} // namespace

// Sends out step after step until one has to be waited for; false when none is left.
bool FragmentPipeline::take_steps(std::uint16_t index) {
    Thread& thread = threads_[index];
    if (thread.steps == 0) return false;
    const Quad& quad = pass_->stream->quads[thread.task.quad];
    while (thread.step < thread.steps) {
        segments_.clear();
        pass_->screen->shader->step(quad.x, quad.y, thread.step++, segments_);
        std::uint32_t bytes = 0;
        for (const MemorySegment& segment : segments_) {
            bytes += segment.bytes;
            thread.loads += segment.write ? 0U : 1U;
            ++(segment.write ? stats_.uncached_stores : stats_.uncached_loads);
            uncached_.push_back({segment.address, segment.bytes, index | uncached_tag, pass_->draw_of(thread.task.quad),
                                 MemoryClient::texture, segment.write});
        }
        const std::uint32_t fetches = (bytes + bytes_per_fetch - 1) / bytes_per_fetch;
        use_texture_unit(std::uint64_t{fetches} * texture_.cycles_per_rgba32f);
        if (thread.loads != 0) return true;
    }
    return false;
}

void FragmentPipeline::load_arrived(std::uint16_t index) {
    if (--threads_[index].loads == 0 && !take_steps(index)) shaded(index);
}

} // namespace pipeline
