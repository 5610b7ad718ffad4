// D2: a programmable blender in the ROP. Fragments leave the reorder buffer in primitive order, and the blender reads,
// modifies and writes the pixel in the ROP's tile cache.
//
// Source: specification 004, section 7.3; Bavoil 2007, section 4.3.1.
#include "models/kbuffers/blender_interlock.hpp"

namespace models {

namespace {

using namespace pipeline;

struct BlenderParams {
    BlendInterlock interlock = BlendInterlock::stall;
    std::uint32_t lanes = 4;
    std::uint32_t port_bytes = 32;
    std::uint32_t latency = 16;

    static constexpr auto fields() {
        using P = BlenderParams;
        return std::tuple_cat(
            std::tuple{sim::field<&P::interlock>("What happens to a quad whose pixel is inside the blender")},
            blender_fields<P>());
    }
};
static_assert(sim::fully_described<BlenderParams>);

class Blender final : public ConfiguredDesign<Blender, BlenderParams> {
  public:
    static constexpr std::string_view name = "blender";
    static constexpr std::string_view text =
        "D2: programmable blender in the ROP, behind the reorder buffer, with interlock";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override { return blender_refuses(program); }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::blender;
        plan.blender = {params_.interlock, params_.lanes, params_.port_bytes, params_.latency};
        return plan;
    }
    // Per ROP: the values inside the pipeline (entries and fragment), and one address comparator per stage.
    AddedHardware area(const ModifyProgram& program, const View&, const GpuShape& shape) const override {
        const bool compares = params_.interlock != BlendInterlock::none;
        return {{{"blender_pipeline", pipeline_bits(program, params_.latency, shape)}},
                compares ? std::uint64_t{params_.latency} * shape.rops : 0,
                std::uint64_t{params_.lanes} * shape.rops};
    }
};

} // namespace

DesignInfo blender_design() { return Blender::info(); }

} // namespace models
