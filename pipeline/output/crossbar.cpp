#include "pipeline/output/crossbar.hpp"

#include <bit>

namespace pipeline {

namespace {
constexpr std::uint32_t bytes_of_depth = 4;
} // namespace

Crossbar::Crossbar(sim::Context context, const CrossbarParams& params, const PassContext& pass,
                   std::uint32_t partitions)
    : Component(std::move(context)),
      params_(params),
      pass_(&pass),
      lanes_(partitions, {FixedQueue<QuadTask>(params.queue)}) {
    port_names_.reserve(partitions);
    for (std::uint32_t rop = 0; rop < partitions; ++rop)
        partitions_out.emplace_back(*this, port_names_.emplace_back("partition" + std::to_string(rop) + "_out"));
}

std::uint32_t Crossbar::bytes_per_fragment() const {
    switch (pass_->end) {
    case FragmentEnd::kbuffer_store:
        return pass_->program->bytes_per_pixel();
    case FragmentEnd::kbuffer_blend:
    case FragmentEnd::kbuffer_list:
        return pass_->program->floats_per_entry() * 4;
    case FragmentEnd::depth_colour:
        break;
    }
    return bytes_of_depth + pass_->colour_bytes();
}

bool Crossbar::broadcast(const QuadTask& command) {
    for (const Lane& lane : lanes_)
        if (lane.queue.full()) return false;
    for (Lane& lane : lanes_) lane.queue.push(command);
    waiting_ += static_cast<std::uint32_t>(lanes_.size());
    return true;
}

bool Crossbar::take_inputs() {
    bool progress = false;
    while (const QuadTask* head = quads_in.peek()) {
        if (head->kind != QuadKind::quad) {
            if (!broadcast(*head)) break;
            quads_in.pop();
        } else {
            const Quad& quad = pass_->stream->quads[head->quad];
            Lane& lane = lanes_[pass_->layout.partition_of(quad.x, quad.y)];
            if (lane.queue.full()) break;
            lane.queue.push(quads_in.receive());
            ++waiting_;
        }
        progress = true;
    }
    return progress;
}

bool Crossbar::serve(std::size_t group) {
    Lane& lane = lanes_[group];
    bool progress = false;
    while (!lane.queue.empty()) {
        if (lane.link_free > cycle()) {
            wake_at(lane.link_free);
            break;
        }
        if (!partitions_out[group].ready()) break;
        const QuadTask task = lane.queue.front();
        lane.queue.pop();
        --waiting_;
        partitions_out[group].send(task);
        progress = true;
        if (task.kind != QuadKind::quad) continue;
        const auto pixels = static_cast<std::uint32_t>(std::popcount(task.pixels()));
        const auto samples = static_cast<std::uint32_t>(std::popcount(task.mask));
        const std::uint32_t bytes = pixels * (bytes_per_fragment() - bytes_of_depth) + samples * bytes_of_depth;
        lane.link_free = cycle() + (bytes + params_.bytes_per_clk - 1) / params_.bytes_per_clk;
        ++stats_.quads;
        stats_.bytes += bytes;
    }
    return progress;
}

sim::Activity Crossbar::tick() {
    bool progress = take_inputs();
    for (std::size_t group = 0; waiting_ != 0 && group < lanes_.size(); ++group) progress |= serve(group);
    if (progress) return sim::Activity::busy;
    return waiting_ != 0 ? sim::Activity::blocked : sim::Activity::starved;
}

} // namespace pipeline
