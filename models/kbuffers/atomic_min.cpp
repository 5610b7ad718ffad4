// Chains of atomic minima: the shader takes the minimum with the first entry, goes on to the next with what that
// displaced, and so on. No order and no lock is needed, but an atomic for each entry on the way.
//
// An atomic holds one word, so entries are depths. The chain counts as work of the partition's atomic units; not
// modelled: the shader's way to them and back between two links, which many quads in flight hide. Source: specification
// 004, section 8 (bucket and multi-depth tests, 2009-2010).
#include "models/kbuffers/configured_design.hpp"

namespace models {

namespace {

using namespace pipeline;

struct AtomicMinParams {
    std::uint32_t atomics_per_clk = 1;

    static constexpr auto fields() {
        return std::tuple{sim::field<&AtomicMinParams::atomics_per_clk>("Atomic minima per cycle of one ROP")
                              .unit("operations")
                              .range(1, 64)};
    }
};
static_assert(sim::fully_described<AtomicMinParams>);

class AtomicMin final : public ConfiguredDesign<AtomicMin, AtomicMinParams> {
  public:
    static constexpr std::string_view name = "atomic-min";
    static constexpr std::string_view text = "a chain of atomic minima per fragment, one for each entry on the way";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override {
        if (program.peeling() != Peeling::nearest) return "minima keep the nearest fragments and nothing else";
        return program.floats_per_entry() == 1 ? "" : "an atomic minimum holds one word, so entries must be depths (z)";
    }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::blender;
        plan.blender.unit = BlendUnit::atomic_min;
        plan.blender.interlock = BlendInterlock::forward;
        plan.blender.atomics_per_clk = params_.atomics_per_clk;
        plan.retirement = Retirement::out_of_order;
        plan.order_free = true;
        return plan;
    }
};

} // namespace

DesignInfo atomic_min_design() { return AtomicMin::info(); }

} // namespace models
