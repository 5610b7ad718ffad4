// What designs share whose hardware does not protect the pixel: D0 in its variants, and D4, what an application can do
// about it, which draws in batches with a flush behind each.
//
// The flush is forced by a full-screen quad whose writes are all masked, drawn at a rate of its own. Source:
// specification 004, sections 3.2 (A8, A9) and 7.5; Bavoil 2007, sections 4.3.2 and 6.4.
#pragma once

#include "models/kbuffers/configured_design.hpp"

namespace models {

/// Of parameters with visibility and tex_coherence.
template <class Params>
constexpr auto visibility_fields() {
    return std::tuple{sim::field<&Params::visibility>("When a store becomes visible to a texture read"),
                      sim::field<&Params::tex_coherence>("What drops stale k-buffer lines from the texture caches")};
}

/// Of parameters with drain, writeback and invalidate.
template <class Params>
constexpr auto flush_fields() {
    return std::tuple{sim::field<&Params::drain>("A flush waits until all quads in flight have stored"),
                      sim::field<&Params::writeback>("A flush makes all stores observable"),
                      sim::field<&Params::invalidate>("A flush drops the k-buffer lines of the texture caches")};
}

/// Of the hardware underneath, as in `existing`.
struct UnprotectedParams {
    pipeline::Visibility visibility = pipeline::Visibility::writeback;
    pipeline::TextureCoherence tex_coherence = pipeline::TextureCoherence::invalidate_on_draw;

    static constexpr auto fields() { return visibility_fields<UnprotectedParams>(); }
};
static_assert(sim::fully_described<UnprotectedParams>);

struct BatchParams {
    std::uint32_t batch = 32;
    bool drain = true;
    bool writeback = true;
    bool invalidate = true;
    std::uint32_t flush_quad_px_per_clk = 32;

    static constexpr auto fields() {
        using P = BatchParams;
        return std::tuple_cat(
            std::tuple{sim::field<&P::batch>("Triangles of a batch").unit("triangles").range(1, 1 << 20)},
            flush_fields<P>(),
            std::tuple{
                sim::field<&P::flush_quad_px_per_clk>("Rate of the masked full-screen quad; 0 = it costs nothing")
                    .unit("pixels per cycle")
                    .range(0, 4096)});
    }
};
static_assert(sim::fully_described<BatchParams>);

/// `params` has visibility and tex_coherence.
template <class Params>
pipeline::KBufferPlan unprotected(const Params& params) {
    pipeline::KBufferPlan plan;
    plan.site = pipeline::UpdateSite::fragment_shader;
    plan.shader.visibility = params.visibility;
    plan.shader.coherence = params.tex_coherence;
    return plan;
}

inline pipeline::KBufferPlan in_batches(const UnprotectedParams& hardware, const BatchParams& params) {
    pipeline::KBufferPlan plan = unprotected(hardware);
    plan.shader.flush = {.every_draw = true,
                         .drain = params.drain,
                         .writeback = params.writeback,
                         .invalidate = params.invalidate,
                         .quad_pixels_per_clk = params.flush_quad_px_per_clk};
    return plan;
}

} // namespace models
