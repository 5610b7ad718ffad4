// D4c: sorted by the depth of their centroids and drawn in small batches with a flush behind each (SPwH of the
// measurements).
//
// Source: specification 004, sections 2.5, 3.2 (A8, A9) and 7.5; Bavoil 2007, sections 4.3.2 and 6.4.
#include "models/kbuffers/unprotected.hpp"

namespace models {

namespace {

using namespace pipeline;

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

DesignInfo sorted_batched_design() { return SortedBatched::info(); }

} // namespace models
