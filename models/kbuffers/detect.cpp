// Hazards detected and counted, not prevented: a version number is stored with each pixel, read with it, and compared
// when the shader's result is stored. What an application does about it (draw again, hold back) is not modelled.
//
// Numbers that wrap around overlook a hazard now and then; the counters say how often. Source: specification 004,
// section 8; after Zhang, "Memory-hazard-aware k-buffer algorithm" (TVCG 2014), who puts error-detecting codes into the
// entries.
#include "models/kbuffers/unprotected.hpp"

namespace models {

namespace {

using namespace pipeline;

struct DetectParams {
    std::uint32_t version_bits = 8;
    Visibility visibility = Visibility::writeback;
    TextureCoherence tex_coherence = TextureCoherence::invalidate_on_draw;

    static constexpr auto fields() {
        using P = DetectParams;
        return std::tuple_cat(
            std::tuple{sim::field<&P::version_bits>("Bits of the version number of a pixel").unit("bits").range(1, 31)},
            visibility_fields<P>());
    }
};
static_assert(sim::fully_described<DetectParams>);

class Detect final : public ConfiguredDesign<Detect, DetectParams> {
  public:
    static constexpr std::string_view name = "detect";
    static constexpr std::string_view text = "existing hardware that detects and counts hazards, and lets them happen";

    using ConfiguredDesign::ConfiguredDesign;

    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan = unprotected(params_);
        plan.shader.version_bits = params_.version_bits;
        return plan;
    }
    // A number per sample of the surface, one with each quad's pixels in flight, one comparator per ROP.
    AddedHardware area(const ModifyProgram&, const View& view, const GpuShape& shape) const override {
        const std::uint64_t numbers = view.samples_drawn() + std::uint64_t{4} * shape.quads_in_flight;
        return {{{"version_bits", numbers * params_.version_bits}}, shape.rops, 0};
    }
};

} // namespace

DesignInfo detect_design() { return Detect::info(); }

} // namespace models
