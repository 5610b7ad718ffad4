#include "pipeline/geometry/vertex_shader.hpp"

namespace pipeline {

VertexShader::VertexShader(sim::Context context, const Params& params)
    : Component(std::move(context)), params_(params), runs_(params.units) {}

sim::Activity VertexShader::tick() {
    bool progress = false;
    while (!runs_.empty() && runs_.front().done <= cycle() && vertices_out.ready()) {
        vertices_out.send({runs_.front().sequence});
        runs_.pop();
        progress = true;
    }
    while (!runs_.full()) {
        const VertexTask* task = vertices_in.peek();
        if (task == nullptr) break;
        const std::uint64_t cycles = params_.cycles_for(task->instructions);
        runs_.push({task->sequence, cycle() + cycles});
        vertices_in.pop();
        ++stats_.vertices;
        stats_.unit_cycles += cycles;
        progress = true;
    }
    if (progress) return sim::Activity::busy;
    if (runs_.empty()) return sim::Activity::starved;
    if (runs_.front().done <= cycle()) return sim::Activity::blocked;
    if (runs_.full()) return sim::Activity::busy;
    wake_at(runs_.front().done);
    return sim::Activity::memory;
}

} // namespace pipeline
