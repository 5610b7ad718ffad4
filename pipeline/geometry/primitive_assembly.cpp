#include "pipeline/geometry/primitive_assembly.hpp"

#include <algorithm>

namespace pipeline {

PrimitiveAssembly::PrimitiveAssembly(sim::Context context, const Params& params)
    : Component(std::move(context)), params_(params) {}

sim::Activity PrimitiveAssembly::tick() {
    bool progress = false;
    while (const VertexTask* vertex = vertices_in.peek()) {
        CHECK(vertex->sequence == received_ + 1);
        received_ = vertex->sequence;
        vertices_in.pop();
        ++stats_.vertices;
        progress = true;
    }
    while (const ReusedPrimitive* primitive = primitives_in.peek()) {
        const auto& sequences = primitive->sequences;
        const bool complete = std::max({sequences[0], sequences[1], sequences[2]}) <= received_;
        if (!complete) return progress ? sim::Activity::busy : sim::Activity::memory;
        if (!primitives_out.ready()) return progress ? sim::Activity::busy : sim::Activity::blocked;
        primitives_out.send({primitive->primitive, primitive->range});
        primitives_in.pop();
        ++stats_.primitives;
        progress = true;
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
