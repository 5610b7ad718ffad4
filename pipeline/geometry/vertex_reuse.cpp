#include "pipeline/geometry/vertex_reuse.hpp"

#include <bit>

namespace pipeline {

namespace {
constexpr std::uint32_t index_bytes_at_once = 64; ///< forwarded without a vertex when so many have gathered
}

VertexReuse::VertexReuse(sim::Context context, const Params& params, const GeometryPass& pass,
                         bool forwards_index_bytes)
    : Component(std::move(context)),
      params_(params),
      pass_(&pass),
      forwards_index_bytes_(forwards_index_bytes),
      model_(params) {}

void VertexReuse::begin_range(std::uint32_t range) {
    const Geometry& geometry = pass_->geometry(range);
    const bool indexed = geometry.index_type != IndexType::none;
    model_.begin_draw(indexed ? geometry.vertex_count : std::max(geometry.vertex_count, geometry.index_count), indexed);
    corners_ = corners_of(geometry.topology);
    pass_number_ = pass_->number;
    range_ = range;
    draw_ = pass_->range(range).draw;
    if (draw_ >= draw_stats_.size()) draw_stats_.resize(draw_ + 1);
}

void VertexReuse::look_up(const IndexedPrimitive& primitive) {
    if (primitive.range != range_ || pass_->number != pass_number_) begin_range(primitive.range);
    present_ = primitive;
    if (forwards_index_bytes_) index_bytes_ += primitive.index_bytes;
    result_ = model_.primitive(primitive.vertices, corners_);
    unsent_ = result_.missed;
    holding_ = true;
    const auto misses = static_cast<std::uint64_t>(std::popcount(result_.missed));
    for (Stats* stats : {&stats_, &draw_stats_[draw_]}) {
        ++stats->primitives;
        stats->misses += misses;
        stats->hits += corners_ - misses;
    }
}

bool VertexReuse::send_vertices() {
    while (unsent_ != 0) {
        if (!vertices_out.ready()) return false;
        const auto corner = static_cast<std::size_t>(std::countr_zero(unsent_));
        vertices_out.send({result_.sequences[corner], range_, present_.vertices[corner], index_bytes_});
        index_bytes_ = 0;
        unsent_ = static_cast<std::uint8_t>(unsent_ & (unsent_ - 1));
    }
    return true;
}

bool VertexReuse::send_index_bytes() {
    if (index_bytes_ < index_bytes_at_once) return true;
    if (!vertices_out.ready()) return false;
    vertices_out.send({0, range_, 0, index_bytes_});
    index_bytes_ = 0;
    return true;
}

sim::Activity VertexReuse::tick() {
    bool progress = false;
    for (;;) {
        if (!holding_) {
            const IndexedPrimitive* primitive = primitives_in.peek();
            if (primitive == nullptr) return progress ? sim::Activity::busy : sim::Activity::starved;
            look_up(*primitive);
            primitives_in.pop();
            progress = true;
        }
        const std::uint8_t before = unsent_;
        const bool sent = send_vertices() && send_index_bytes();
        progress |= unsent_ != before;
        if (!sent || !primitives_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        primitives_out.send({present_.primitive, present_.range, result_.sequences});
        holding_ = false;
        progress = true;
    }
}

} // namespace pipeline
