// D4a: triangles sorted on the computer by the depth of their centroids, so that overlapping ones lie far apart in the
// stream. They share few vertices with their neighbours then, which the vertex caches notice.
//
// Source: specification 004, sections 3.2 (A8) and 7.5; Bavoil 2007, section 4.3.2.
#include "models/kbuffers/unprotected.hpp"

namespace models {

namespace {

using namespace pipeline;

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

} // namespace

DesignInfo sorted_design() { return Sorted::info(); }

} // namespace models
