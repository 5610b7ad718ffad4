// A programmable blender whose interlock counts the pixels inside by a hash. Two pixels can share a counter, which
// costs a stall now and then.
//
// Source: specification 004, sections 7.3 and 8.
#include "models/kbuffers/blender_interlock.hpp"

#include <bit>

namespace models {

namespace {

using namespace pipeline;

struct HashedParams {
    std::uint32_t counters = 256;
    std::uint32_t lanes = 4;
    std::uint32_t port_bytes = 32;
    std::uint32_t latency = 16;

    static constexpr auto fields() {
        using P = HashedParams;
        return std::tuple_cat(std::tuple{sim::field<&P::counters>("Counters of a partition, by hash of the pixel (B)")
                                             .unit("counters")
                                             .range(1, 1 << 24)},
                              blender_fields<P>());
    }
};
static_assert(sim::fully_described<HashedParams>);

class Hashed final : public ConfiguredDesign<Hashed, HashedParams> {
  public:
    static constexpr std::string_view name = "hashed";
    static constexpr std::string_view text = "programmable blender with counters by hash of the pixel";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override { return blender_refuses(program); }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan = blender_with(InterlockTest::hashed, params_);
        plan.blender.test_entries = params_.counters;
        return plan;
    }
    AddedHardware area(const ModifyProgram& program, const View&, const GpuShape& shape) const override {
        return {{{"blender_pipeline", pipeline_bits(program, params_.latency, shape)},
                 {"counters", std::uint64_t{params_.counters} * std::bit_width(params_.latency) * shape.rop_groups}},
                0,
                std::uint64_t{params_.lanes} * shape.rops};
    }
};

} // namespace

DesignInfo hashed_design() { return Hashed::info(); }

} // namespace models
