#include "pipeline/geometry/clip_cull.hpp"

namespace pipeline {

ClipCull::ClipCull(sim::Context context, const Params& params, const GeometryPass& pass)
    : Component(std::move(context)), params_(params), pass_(&pass) {}

void ClipCull::book(const Primitive& primitive, Stats& stats) const {
    ++stats.primitives;
    switch (primitive.fate) {
    case PrimitiveFate::drawn:
        ++stats.drawn;
        break;
    case PrimitiveFate::culled_facing:
        ++stats.culled_facing;
        break;
    case PrimitiveFate::culled_outside:
        ++stats.culled_outside;
        break;
    case PrimitiveFate::culled_degenerate:
        ++stats.culled_degenerate;
        break;
    }
    if (primitive.clipped) ++stats.clipped;
    stats.triangles += primitive.triangles;
}

void ClipCull::take(const AssembledPrimitive& message) {
    const Primitive& primitive = pass_->stream->primitives[message.primitive];
    const std::uint32_t draw = pass_->range(message.range).draw;
    if (draw >= draw_stats_.size()) draw_stats_.resize(draw + 1);
    book(primitive, stats_);
    book(primitive, draw_stats_[draw]);
    next_ = primitive.first_triangle;
    end_ = primitive.first_triangle + primitive.triangles;
    clipped_ = primitive.clipped;
    ready_ = cycle() + (clipped_ ? params_.clip_cycles : 0);
}

sim::Activity ClipCull::tick() {
    bool progress = false;
    for (;;) {
        if (next_ == end_) {
            const AssembledPrimitive* primitive = primitives_in.peek();
            if (primitive == nullptr) return progress ? sim::Activity::busy : sim::Activity::starved;
            take(*primitive);
            primitives_in.pop();
            progress = true;
            continue;
        }
        if (ready_ > cycle()) return sim::Activity::busy; // at work on the next part
        if (!triangles_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        triangles_out.send({next_++});
        if (clipped_) ready_ = cycle() + 1 + params_.clip_cycles;
        progress = true;
    }
}

} // namespace pipeline
