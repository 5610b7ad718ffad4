// Fragment shader interlock: the shader marks the part that reads, modifies and stores its pixel, and the GPU lets one
// quad at a time into it, in the order of the primitives or in any. All code before that part overlaps freely.
//
// Source: specification 004, section 8 (pixel synchronisation 2013, fragment_shader_interlock).
#include "models/kbuffers/lock_table.hpp"

namespace models {

namespace {

using namespace pipeline;

struct InterlockParams {
    bool ordered = true;
    LockArea area = LockArea::pixel;
    std::uint32_t lock_latency = 4;
    std::uint32_t grants_per_clk = 6;

    static constexpr auto fields() {
        using P = InterlockParams;
        return std::tuple_cat(
            std::tuple{
                sim::field<&P::ordered>("Quads enter in the order of their primitives; otherwise one at a time in any"),
                sim::field<&P::area>("What one critical section locks")},
            lock_table_fields<P>());
    }
};
static_assert(sim::fully_described<InterlockParams>);

class Interlock final : public ConfiguredDesign<Interlock, InterlockParams> {
  public:
    static constexpr std::string_view name = "interlock";
    static constexpr std::string_view text = "critical section in the fragment shader, ordered or not";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override {
        return !params_.ordered && program.order_need() == OrderNeed::primitive_order
                   ? "it needs the order of the primitives, and interlock.ordered is false"
                   : "";
    }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan = in_critical_section(params_.ordered ? CriticalSection::ordered : CriticalSection::unordered,
                                               params_.area, params_);
        plan.order_free = !params_.ordered;
        return plan;
    }
    // A place, a mask and a thread number for each quad in flight, which a release is compared with.
    AddedHardware area(const ModifyProgram&, const View&, const GpuShape& shape) const override {
        return {{{"locks", std::uint64_t{shape.quads_in_flight} * (26 + 4 + 12)}}, shape.quads_in_flight, 0};
    }
};

} // namespace

DesignInfo interlock_design() { return Interlock::info(); }

} // namespace models
