#include "pipeline/geometry/vertex_fetch.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace pipeline {

VertexFetch::VertexFetch(sim::Context context, const Params& params, const GeometryPass& pass, const Needs& needs,
                         const HostParams& host)
    : Component(std::move(context)),
      params_(params),
      host_(host),
      pass_(&pass),
      needs_(needs),
      cache_(params.cache, "geometry.vertex_fetch.cache"),
      fill_of_(cache_.slots(), 0),
      here_(std::bit_ceil(params.lines_in_flight)),
      waiting_(params.vertices_in_flight) {}

VertexFetch::Stats VertexFetch::stats() const {
    Stats stats = stats_;
    stats.cache = cache_.stats();
    stats.port_cycles = {port_parts_ / InputCost::parts_of_a_cycle};
    return stats;
}

void VertexFetch::begin_range(std::uint32_t range) {
    const Resources& resources = *pass_->resources;
    const Material& material = resources.materials[pass_->draw(range).material];
    lines_ = VertexLines(resources, pass_->geometry(range), material, needs_, params_.cache.line,
                         pass_->range(range).instance);
    const InputLayout layout = input_layout(needs_, pass_->geometry(range), material);
    const double core_mhz = 1e6 / static_cast<double>(clock().period);
    cost_ = input_cost(input_cost_parts(params_.port, host_, pass_->term(range), layout, params_.cache.line, core_mhz));
    const std::uint32_t draw = pass_->range(range).draw;
    const bool next_instance = !pass_->range(range).is_part() && draw == draw_ && pass_->number == pass_number_;
    draw_cost_ = next_instance ? 0 : cost_.draw;
    pass_number_ = pass_->number;
    range_ = range;
    draw_ = draw;
    if (draw_ >= draw_bytes_.size()) draw_bytes_.resize(draw_ + 1);
}

void VertexFetch::begin_vertex(const VertexRequest& request) {
    if (request.range != range_ || pass_->number != pass_number_) begin_range(request.range);
    present_ = {request.sequence, 0, pass_->range(request.range).vertex_instructions};
    lines_.begin(request.vertex);
    if (request.sequence == 0) lines_.end();
    port_cost_ = request.index_bytes * cost_.index_byte + (request.sequence == 0 ? 0 : cost_.vertex);
    port_cost_ += std::exchange(draw_cost_, 0);
    holding_ = true;
}

bool VertexFetch::look_up_line(std::uint64_t line) {
    if (const std::uint32_t slot = cache_.find(line); slot != Cache::no_slot) {
        cache_.touch(slot);
        if (fill_of_[slot] > filled_) {
            ++stats_.merged;
            present_.last_fill = std::max(present_.last_fill, fill_of_[slot]);
        }
        return true;
    }
    if (fills_ - filled_ >= params_.lines_in_flight || !requests_out.ready()) return false;
    port_cost_ += cost_.line;
    fill_of_[cache_.access(line).slot] = ++fills_;
    present_.last_fill = fills_;
    requests_out.send({.address = line * cache_.line_bytes(),
                       .bytes = cache_.line_bytes(),
                       .tag = static_cast<std::uint32_t>(fills_),
                       .draw = draw_,
                       .client = MemoryClient::vertex,
                       .write = false});
    stats_.bytes += cache_.line_bytes();
    stats_.lines_in_flight.note(fills_ - filled_);
    draw_bytes_[draw_] += cache_.line_bytes();
    return true;
}

// A vertex passes when the port has moved all that came before it.
bool VertexFetch::pass_port() {
    if (port_cost_ == 0) return true;
    const std::uint64_t now_parts = cycle() * InputCost::parts_of_a_cycle;
    if (port_free_ >= now_parts + InputCost::parts_of_a_cycle) {
        wake_at(port_free_ / InputCost::parts_of_a_cycle);
        return false;
    }
    port_free_ = std::max(port_free_, now_parts) + port_cost_;
    port_parts_ += port_cost_;
    return true;
}

bool VertexFetch::look_up() {
    bool progress = false;
    for (std::uint32_t lines = 0;;) {
        if (!holding_) {
            const VertexRequest* request = waiting_.full() ? nullptr : vertices_in.peek();
            if (request == nullptr) return progress;
            begin_vertex(*request);
            vertices_in.pop();
            progress = true;
        }
        for (; lines_.more(); lines_.next(), ++lines) {
            if (lines == params_.lines_per_clk) return true;
            if (!look_up_line(lines_.line())) return progress;
            progress = true;
        }
        if (!pass_port()) return progress;
        if (present_.sequence != 0) waiting_.push(present_);
        stats_.vertices_in_flight.note(waiting_.size());
        holding_ = false;
        progress = true;
    }
}

bool VertexFetch::take_fills() {
    bool progress = false;
    while (const MemoryResponse* response = responses_in.peek()) {
        here_[response->tag & (here_.size() - 1)] = true;
        responses_in.pop();
        progress = true;
    }
    while (filled_ < fills_ && here_[(filled_ + 1) & (here_.size() - 1)]) {
        ++filled_;
        here_[filled_ & (here_.size() - 1)] = false;
    }
    return progress;
}

bool VertexFetch::deliver() {
    bool progress = false;
    while (deliverable() && vertices_out.ready()) {
        vertices_out.send({waiting_.front().sequence, waiting_.front().instructions});
        waiting_.pop();
        ++stats_.vertices;
        progress = true;
    }
    return progress;
}

sim::Activity VertexFetch::tick() {
    bool progress = take_fills();
    progress |= deliver();
    progress |= look_up();
    if (progress) return sim::Activity::busy;
    if (deliverable()) return sim::Activity::blocked;
    return holding_ || !waiting_.empty() ? sim::Activity::memory : sim::Activity::starved;
}

} // namespace pipeline
