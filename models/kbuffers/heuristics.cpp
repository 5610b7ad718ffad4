// D4: what an application can do about hazards on hardware that does not protect it: sort the triangles by the depth of
// their centroids, so that overlapping ones lie far apart in the stream; draw them in small batches with a flush behind
// each, so that only triangles of one batch can collide; or both.
//
// The flush is forced by a full-screen quad whose writes are all masked, drawn at a rate of its own. Sorted triangles
// share few vertices with their neighbours, which the vertex caches notice. Source: specification 004, sections 3.2
// (A8, A9) and 7.5; Bavoil 2007, sections 4.3.2 and 6.4.
#include "models/kbuffers/configured_design.hpp"

namespace models {

namespace {

using namespace pipeline;

/// Of the hardware underneath, as in `existing`.
struct UnprotectedParams {
    Visibility visibility = Visibility::writeback;
    TextureCoherence tex_coherence = TextureCoherence::invalidate_on_draw;

    static constexpr auto fields() {
        using P = UnprotectedParams;
        return std::tuple{sim::field<&P::visibility>("When a store becomes visible to a texture read"),
                          sim::field<&P::tex_coherence>("What drops stale k-buffer lines from the texture caches")};
    }
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
        return std::tuple{
            sim::field<&P::batch>("Triangles of a batch").unit("triangles").range(1, 1 << 20),
            sim::field<&P::drain>("A flush waits until all quads in flight have stored"),
            sim::field<&P::writeback>("A flush makes all stores observable"),
            sim::field<&P::invalidate>("A flush drops the k-buffer lines of the texture caches"),
            sim::field<&P::flush_quad_px_per_clk>("Rate of the masked full-screen quad; 0 = it costs nothing")
                .unit("pixels per cycle")
                .range(0, 4096)};
    }
};
static_assert(sim::fully_described<BatchParams>);

struct SortedParams {
    UnprotectedParams hardware;
    double sort_ns_per_tri = 0;

    static constexpr auto fields() {
        using P = SortedParams;
        return std::tuple{sim::field<&P::hardware>("Hardware underneath"),
                          sim::field<&P::sort_ns_per_tri>("Sorting on the computer, before the frame")
                              .unit("ns per triangle")
                              .range(0, 1e6)};
    }
};
static_assert(sim::fully_described<SortedParams>);

struct BatchedParams {
    UnprotectedParams hardware;
    BatchParams batches;

    static constexpr auto fields() {
        using P = BatchedParams;
        return std::tuple{sim::field<&P::hardware>("Hardware underneath"), sim::field<&P::batches>("Batches")};
    }
};
static_assert(sim::fully_described<BatchedParams>);

struct SortedBatchedParams {
    UnprotectedParams hardware;
    BatchParams batches;
    double sort_ns_per_tri = 0;

    static constexpr auto fields() {
        using P = SortedBatchedParams;
        return std::tuple{sim::field<&P::hardware>("Hardware underneath"), sim::field<&P::batches>("Batches"),
                          sim::field<&P::sort_ns_per_tri>("Sorting on the computer, before the frame")
                              .unit("ns per triangle")
                              .range(0, 1e6)};
    }
};
static_assert(sim::fully_described<SortedBatchedParams>);

KBufferPlan unprotected(const UnprotectedParams& params) {
    KBufferPlan plan;
    plan.site = UpdateSite::fragment_shader;
    plan.shader.visibility = params.visibility;
    plan.shader.coherence = params.tex_coherence;
    return plan;
}

KBufferPlan in_batches(const UnprotectedParams& hardware, const BatchParams& params) {
    KBufferPlan plan = unprotected(hardware);
    plan.shader.flush = {.every_draw = true,
                         .drain = params.drain,
                         .writeback = params.writeback,
                         .invalidate = params.invalidate,
                         .quad_pixels_per_clk = params.flush_quad_px_per_clk};
    return plan;
}

class Sorted final : public ConfiguredDesign<Sorted, SortedParams> {
  public:
    static constexpr std::string_view name = "sorted";
    static constexpr std::string_view text = "D4a: triangles sorted by centroid on the computer, unprotected hardware";

    using ConfiguredDesign::ConfiguredDesign;

    SubmissionPlan submission() const override {
        return {.sort_by_centroid = true, .sort_ns_per_triangle = params_.sort_ns_per_tri};
    }
    KBufferPlan plan(const ModifyProgram&, const View&) const override { return unprotected(params_.hardware); }
};

class Batched final : public ConfiguredDesign<Batched, BatchedParams> {
  public:
    static constexpr std::string_view name = "batched";
    static constexpr std::string_view text = "D4b: small batches with a flush behind each, unprotected hardware";

    using ConfiguredDesign::ConfiguredDesign;

    SubmissionPlan submission() const override {
        return {.batch_triangles = params_.batches.batch, .flush_draws = true};
    }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        return in_batches(params_.hardware, params_.batches);
    }
};

class SortedBatched final : public ConfiguredDesign<SortedBatched, SortedBatchedParams> {
  public:
    static constexpr std::string_view name = "sorted-batched";
    static constexpr std::string_view text = "D4c: sorted by centroid, in small batches with a flush behind each";

    using ConfiguredDesign::ConfiguredDesign;

    SubmissionPlan submission() const override { return {true, params_.batches.batch, true, params_.sort_ns_per_tri}; }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        return in_batches(params_.hardware, params_.batches);
    }
};

} // namespace

DesignInfo sorted_design() { return Sorted::info(); }
DesignInfo batched_design() { return Batched::info(); }
DesignInfo sorted_batched_design() { return SortedBatched::info(); }

} // namespace models
