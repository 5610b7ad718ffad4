// Dual depth peeling: MAX blending of (-depth, depth) captures the nearest and the farthest remaining fragment in one
// geometry pass, so k layers take k/2 + 1 passes instead of k.
//
// Pixels with more fragments than both ends reach lose those in the middle. Source: specification 004, section 8
// (2008).
#include "models/kbuffers/configured_design.hpp"

namespace models {

namespace {

using namespace pipeline;

struct DualPeelParams {
    std::uint32_t passes = 0;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&DualPeelParams::passes>("Geometry passes; 0 = k/2 + 1").unit("passes").range(0, 64)};
    }
};
static_assert(sim::fully_described<DualPeelParams>);

class DualPeel final : public ConfiguredDesign<DualPeel, DualPeelParams> {
  public:
    static constexpr std::string_view name = "dual-peel";
    static constexpr std::string_view text = "depth peeling from both ends, two layers per geometry pass";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override {
        return program.peeling() == Peeling::nearest ? "" : "peeling gives layers sorted by depth and nothing else";
    }
    KBufferPlan plan(const ModifyProgram& program, const View&) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::passes;
        plan.passes.capture = PassCapture::nearest_farthest;
        plan.passes.passes = params_.passes != 0 ? params_.passes : program.k() / 2 + 1;
        return plan;
    }
};

} // namespace

DesignInfo dual_peel_design() { return DualPeel::info(); }

} // namespace models
