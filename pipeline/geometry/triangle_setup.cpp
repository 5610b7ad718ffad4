#include "pipeline/geometry/triangle_setup.hpp"

namespace pipeline {

TriangleSetup::TriangleSetup(sim::Context context, const Params& params)
    : Component(std::move(context)), params_(params) {}

sim::Activity TriangleSetup::tick() {
    bool progress = false;
    if (holding_) {
        if (done_ > cycle()) return sim::Activity::busy;
        if (!triangles_out.ready()) return sim::Activity::blocked;
        triangles_out.send(present_);
        holding_ = false;
        progress = true;
    }
    if (const TriangleTask* task = triangles_in.peek()) {
        present_ = *task;
        triangles_in.pop();
        done_ = cycle() + params_.cycles_per_triangle;
        holding_ = true;
        ++stats_.triangles;
        progress = true;
    }
    return progress ? sim::Activity::busy : sim::Activity::starved;
}

} // namespace pipeline
