// D4b: triangles drawn in small batches with a flush behind each, so that only those of one batch can collide.
//
// Source: specification 004, sections 3.2 (A9) and 7.5; Bavoil 2007, section 4.3.2.
#include "models/kbuffers/unprotected.hpp"

namespace models {

namespace {

using namespace pipeline;

struct BatchedParams {
    UnprotectedParams hardware;
    BatchParams batches;

    static constexpr auto fields() {
        using P = BatchedParams;
        return std::tuple{sim::field<&P::hardware>("Hardware underneath"), sim::field<&P::batches>("Batches")};
    }
};
static_assert(sim::fully_described<BatchedParams>);

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

} // namespace

DesignInfo batched_design() { return Batched::info(); }

} // namespace models
