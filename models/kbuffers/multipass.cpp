// D5: traditional depth peeling. One geometry pass per layer with a fixed-function depth test; the shader rejects what
// is not behind the layer before, read from a depth texture that the pass does not write.
//
// The exact rule tells equal depths apart by submission order, so the layers are those of the reference; the eps rule
// is the one of 2006 hardware and loses surfaces closer than eps (specification 004, section 6.1 item 5). Source:
// specification 004, sections 3.3 (A10) and 7.6.
#include "models/kbuffers/library.hpp"
#include "sim/described_json.hpp"

namespace models {

namespace {

using namespace pipeline;

struct MultipassParams {
    PeelRule rule = PeelRule::exact;
    double eps = 1e-4;
    DepthFormat depth_format = DepthFormat::d32f;

    static constexpr auto fields() {
        using P = MultipassParams;
        return std::tuple{sim::field<&P::rule>("How a pass tells the layers already captured"),
                          sim::field<&P::eps>("Added to the captured depth by the eps rule; window depth").range(0, 1),
                          sim::field<&P::depth_format>("Format of the depth buffer of each layer")};
    }
};
static_assert(sim::fully_described<MultipassParams>);

class Multipass final : public KBufferDesign {
  public:
    static constexpr std::string_view name = "multipass";
    static constexpr std::string_view text = "D5: depth peeling, one geometry pass per layer";

    explicit Multipass(const MultipassParams& params) : params_(params) {}

    std::string_view id() const override { return name; }
    std::string_view summary() const override { return text; }
    std::string refuses(const ModifyProgram& program) const override {
        return program.peeling() == Peeling::nearest ? "" : "peeling gives the nearest layers and nothing else";
    }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::passes;
        plan.passes = {params_.rule, params_.eps, params_.depth_format};
        return plan;
    }
    nlohmann::ordered_json parameters() const override { return sim::to_json(params_); }
    nlohmann::ordered_json area(const ModifyProgram&, const View&, std::uint32_t) const override {
        return {{"added_state_bits", 0}, {"added_comparators", 0}, {"added_alu_lanes", 0}};
    }

  private:
    MultipassParams params_;
};

} // namespace

DesignInfo multipass_design() {
    return {Multipass::name, Multipass::text,
            [](sim::Config& config) -> std::unique_ptr<KBufferDesign> {
                MultipassParams params;
                config.read(Multipass::name, params);
                return std::make_unique<Multipass>(params);
            },
            [] { return sim::describe<MultipassParams>(Multipass::name); }};
}

} // namespace models
