// A programmable blender whose interlock compares a quad with every one inside (associative memory).
//
// Source: specification 004, sections 7.3 and 8.
#include "models/kbuffers/blender_interlock.hpp"

namespace models {

namespace {

using namespace pipeline;

struct CamParams {
    std::uint32_t entries = 32;
    std::uint32_t lanes = 4;
    std::uint32_t port_bytes = 32;
    std::uint32_t latency = 16;

    static constexpr auto fields() {
        using P = CamParams;
        return std::tuple_cat(
            std::tuple{sim::field<&P::entries>("Quads that the associative memory of a partition holds")
                           .unit("quads")
                           .range(1, 4096)},
            blender_fields<P>());
    }
};
static_assert(sim::fully_described<CamParams>);

class Cam final : public ConfiguredDesign<Cam, CamParams> {
  public:
    static constexpr std::string_view name = "cam";
    static constexpr std::string_view text = "programmable blender that compares with every quad inside";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override { return blender_refuses(program); }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan = blender_with(InterlockTest::exact, params_);
        plan.blender.test_entries = params_.entries;
        return plan;
    }
    // Block number and mask of each entry.
    AddedHardware area(const ModifyProgram& program, const View&, const GpuShape& shape) const override {
        return {{{"blender_pipeline", pipeline_bits(program, params_.latency, shape)},
                 {"associative_memory", std::uint64_t{params_.entries} * (24 + 4) * shape.rop_groups}},
                std::uint64_t{params_.entries} * shape.rop_groups,
                std::uint64_t{params_.lanes} * shape.rops};
    }
};

} // namespace

DesignInfo cam_design() { return Cam::info(); }

} // namespace models
