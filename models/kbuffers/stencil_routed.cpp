// Stencil-routed samples: the stencil test sends one fragment after the other into the samples of a multisampled pixel,
// which a later pass sorts (2007). No hazards; what comes after the samples of all passes is lost.
//
// Source: specification 004, section 8.
#include "models/kbuffers/configured_design.hpp"

namespace models {

namespace {

using namespace pipeline;

struct StencilRoutedParams {
    std::uint32_t samples = 8;
    std::uint32_t passes = 1;

    static constexpr auto fields() {
        using P = StencilRoutedParams;
        return std::tuple{sim::field<&P::samples>("Samples of a pixel, one fragment each").unit("samples").range(1, 32),
                          sim::field<&P::passes>("Geometry passes, each for the next fragments of every pixel")
                              .unit("passes")
                              .range(1, 64)};
    }
};
static_assert(sim::fully_described<StencilRoutedParams>);

class StencilRouted final : public ConfiguredDesign<StencilRouted, StencilRoutedParams> {
  public:
    static constexpr std::string_view name = "stencil-routed";
    static constexpr std::string_view text = "stencil test routes fragments into the samples of a pixel, sorted later";

    using ConfiguredDesign::ConfiguredDesign;

    KBufferPlan plan(const ModifyProgram& program, const View&) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::lists;
        plan.lists.per_pixel = params_.samples;
        plan.lists.passes = params_.passes;
        plan.lists.head_bytes = params_.samples; // a byte of stencil for each sample, all counted down
        plan.lists.fragment_bytes = 4 * program.floats_per_entry();
        plan.lists.chained = false; // the samples of a pixel lie side by side
        // A fixed number of samples is sorted in registers: Myers, Bavoil, "Stencil routed A-Buffer", SIGGRAPH 2007.
        plan.lists.array_registers = (params_.samples * params_.passes * program.floats_per_entry() + 3) / 4;
        return plan;
    }
};

} // namespace

DesignInfo stencil_routed_design() { return StencilRouted::info(); }

} // namespace models
