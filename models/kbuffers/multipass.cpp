// D5: traditional depth peeling. One geometry pass per layer with a fixed-function depth test; the shader rejects what
// is not behind the layer before, read from a depth texture that the pass does not write. Programs that keep the
// nearest fragment of each of several ranges of depth take one pass per range, with near and far planes of its own.
//
// The exact rule tells equal depths apart by submission order, so the layers are those of the reference; the eps rule
// is the one of 2006 hardware and loses surfaces closer than eps (specification 004, section 6.1 item 5). Source:
// specification 004, sections 3.3 (A10) and 7.6.
#include "models/kbuffers/configured_design.hpp"
#include "pipeline/format_choice.hpp"

namespace models {

namespace {

using namespace pipeline;

struct MultipassParams {
    PeelRule rule = PeelRule::exact;
    double eps = 1e-4;
    DepthChoice depth_format = DepthChoice::d32f;

    static constexpr auto fields() {
        using P = MultipassParams;
        return std::tuple{sim::field<&P::rule>("How a pass tells the layers already captured"),
                          sim::field<&P::eps>("Added to the captured depth by the eps rule; window depth").range(0, 1),
                          sim::field<&P::depth_format>("Format of the depth buffer of each layer")};
    }
};
static_assert(sim::fully_described<MultipassParams>);

class Multipass final : public ConfiguredDesign<Multipass, MultipassParams> {
  public:
    static constexpr std::string_view name = "multipass";
    static constexpr std::string_view text = "D5: depth peeling, one geometry pass per layer";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override {
        return program.peeling() != Peeling::none ? ""
                                                  : "its entries are not the nearest fragments, of all or of a range";
    }
    KBufferPlan plan(const ModifyProgram& program, const View&) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::passes;
        plan.passes = {params_.rule, params_.eps, format_of(params_.depth_format)};
        if (program.peeling() == Peeling::ranges) plan.passes.capture = PassCapture::range;
        return plan;
    }
};

} // namespace

DesignInfo multipass_design() { return Multipass::info(); }

} // namespace models
