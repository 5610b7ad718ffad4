// Rasterizer-ordered view: the surface is declared so that its accesses happen in the order of the primitives. The
// shader marks nothing, so the hardware tracks whole 2x2 blocks, from a quad's first access until its store.
//
// Source: specification 004, section 8 (Direct3D 11.3 and 12).
#include "models/kbuffers/lock_table.hpp"

namespace models {

namespace {

using namespace pipeline;

struct RovParams {
    std::uint32_t lock_latency = 4;
    std::uint32_t grants_per_clk = 6;

    static constexpr auto fields() { return lock_table_fields<RovParams>(); }
};
static_assert(sim::fully_described<RovParams>);

class Rov final : public ConfiguredDesign<Rov, RovParams> {
  public:
    static constexpr std::string_view name = "rov";
    static constexpr std::string_view text = "rasterizer-ordered view: accesses ordered by 2x2 block";

    using ConfiguredDesign::ConfiguredDesign;

    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        return in_critical_section(CriticalSection::ordered, LockArea::quad, params_);
    }
    // A block number and a ticket for each quad in flight.
    AddedHardware area(const ModifyProgram&, const View&, const GpuShape& shape) const override {
        return {{{"locks", std::uint64_t{shape.quads_in_flight} * (24 + 12)}}, shape.quads_in_flight, 0};
    }
};

} // namespace

DesignInfo rov_design() { return Rov::info(); }

} // namespace models
