#include "pipeline/output/crossbar.hpp"

#include <bit>

namespace pipeline {

namespace {
constexpr std::uint32_t bytes_of_depth = 4;
} // namespace

Crossbar::Crossbar(sim::Context context, const CrossbarParams& params, const PassContext& pass,
                   std::uint32_t partitions)
    : Component(std::move(context)), params_(params), pass_(&pass), link_free_(partitions) {
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
    return bytes_of_depth + (pass_->colour_write ? pass_->colour_bytes : 0);
}

bool Crossbar::broadcast(const QuadTask& command) {
    for (sim::Out<QuadTask>& port : partitions_out)
        if (!port.ready()) return false;
    for (sim::Out<QuadTask>& port : partitions_out) port.send(command);
    return true;
}

sim::Activity Crossbar::tick() {
    bool progress = false;
    while (const QuadTask* head = quads_in.peek()) {
        if (head->kind != QuadKind::quad) {
            if (!broadcast(*head)) return progress ? sim::Activity::busy : sim::Activity::blocked;
            quads_in.pop();
            progress = true;
            continue;
        }
        const Quad& quad = pass_->stream->quads[head->quad];
        const std::uint32_t rop = pass_->layout.partition_of(quad.x, quad.y);
        if (link_free_[rop] > cycle()) {
            if (!progress) wake_at(link_free_[rop]);
            return progress ? sim::Activity::busy : sim::Activity::blocked;
        }
        if (!partitions_out[rop].ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        const auto pixels = static_cast<std::uint32_t>(std::popcount(head->pixels()));
        const auto samples = static_cast<std::uint32_t>(std::popcount(head->mask));
        const std::uint32_t bytes = pixels * (bytes_per_fragment() - bytes_of_depth) + samples * bytes_of_depth;
        link_free_[rop] = cycle() + (bytes + params_.bytes_per_clk - 1) / params_.bytes_per_clk;
        partitions_out[rop].send(quads_in.receive());
        ++stats_.quads;
        stats_.bytes += bytes;
        progress = true;
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
