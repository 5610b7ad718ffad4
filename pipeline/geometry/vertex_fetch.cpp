#include "pipeline/geometry/vertex_fetch.hpp"

#include <algorithm>
#include <bit>

namespace pipeline {

bool reads_attribute(const Needs& needs, const Material& material, Semantic semantic) {
    switch (semantic) {
    case Semantic::position:
        return true;
    case Semantic::normal:
        return needs.normals;
    case Semantic::colour:
        return needs.vertex_colours;
    case Semantic::texcoord0:
        return needs.texcoords && material.texcoord == 0;
    case Semantic::texcoord1:
        return needs.texcoords && material.texcoord == 1;
    }
    return false;
}

VertexFetch::VertexFetch(sim::Context context, const Params& params, const GeometryPass& pass, const Needs& needs)
    : Component(std::move(context)),
      params_(params),
      pass_(&pass),
      needs_(needs),
      cache_(params.cache, "geometry.vertex_fetch.cache"),
      fill_of_(cache_.slots(), 0),
      here_(std::bit_ceil(params.lines_in_flight)),
      waiting_(params.vertices_in_flight) {}

VertexFetch::Stats VertexFetch::stats() const {
    Stats stats = stats_;
    stats.cache = cache_.stats();
    return stats;
}

void VertexFetch::begin_range(std::uint32_t range) {
    const Resources& resources = *pass_->resources;
    const Material& material = resources.materials[pass_->draw(range).material];
    streams_.clear();
    for (const VertexAttribute& attribute : pass_->geometry(range).attributes)
        if (reads_attribute(needs_, material, attribute.semantic))
            streams_.push_back({resources.buffers[attribute.buffer].address + attribute.offset, attribute.stride,
                                bytes_of(attribute.type) * attribute.components});
    // Attributes that lie side by side share lines; in order of address a shared one is the last line looked up.
    std::sort(streams_.begin(), streams_.end(), [](const Stream& a, const Stream& b) { return a.address < b.address; });
    pass_number_ = pass_->number;
    range_ = range;
    draw_ = pass_->range(range).draw;
    if (draw_ >= draw_bytes_.size()) draw_bytes_.resize(draw_ + 1);
}

void VertexFetch::begin_vertex(const VertexRequest& request) {
    if (request.range != range_ || pass_->number != pass_number_) begin_range(request.range);
    present_ = {request.sequence, 0};
    vertex_ = request.vertex;
    stream_ = 0;
    line_ = 0;
    end_line_ = 0;
    holding_ = true;
}

// Leaves in line_ the next line of the present vertex; false when there is none.
bool VertexFetch::next_line() {
    while (line_ == end_line_) {
        if (stream_ == streams_.size()) return false;
        const Stream& stream = streams_[stream_];
        const std::uint64_t first = stream.address + std::uint64_t{vertex_} * stream.stride;
        const std::uint64_t end = cache_.line_of(first + stream.bytes - 1) + 1;
        line_ = cache_.line_of(first);
        if (stream_ > 0 && line_ + 1 == end_line_) ++line_; // looked up for the attribute before
        end_line_ = end;
        ++stream_;
    }
    return true;
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
        for (; next_line(); ++line_, ++lines) {
            if (lines == params_.lines_per_clk) return true;
            if (!look_up_line(line_)) return progress;
            progress = true;
        }
        waiting_.push(present_);
        stats_.vertices_in_flight.note(waiting_.size());
        holding_ = false;
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
        vertices_out.send({waiting_.front().sequence});
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
