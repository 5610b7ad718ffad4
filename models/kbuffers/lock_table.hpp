// What designs share whose shader modifies its pixel in a critical section that a lock table guards. Stores go straight
// to memory's side, so a section takes a read and a store, not the way through the reorder buffer.
//
// Source: specification 004, section 8.
#pragma once

#include "models/kbuffers/configured_design.hpp"

namespace models {

/// Of parameters with lock_latency and grants_per_clk.
template <class Params>
constexpr auto lock_table_fields() {
    return std::tuple{
        sim::field<&Params::lock_latency>("Cycles from a pipe to the lock table, and back")
            .unit("cycles")
            .range(1, 1000),
        sim::field<&Params::grants_per_clk>("Critical sections entered per cycle").unit("quads").range(1, 64)};
}

template <class Params>
pipeline::KBufferPlan in_critical_section(pipeline::CriticalSection section, pipeline::LockArea area,
                                          const Params& params) {
    pipeline::KBufferPlan plan;
    plan.site = pipeline::UpdateSite::fragment_shader;
    plan.shader.visibility = pipeline::Visibility::rop_cache;
    plan.shader.coherence = pipeline::TextureCoherence::none;
    plan.shader.bypass_l1 = true;
    plan.shader.critical_section = section;
    plan.shader.lock_area = area;
    plan.shader.lock_latency = params.lock_latency;
    plan.shader.grants_per_clk = params.grants_per_clk;
    plan.retirement = pipeline::Retirement::out_of_order;
    return plan;
}

} // namespace models
