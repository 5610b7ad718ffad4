// D3: a fixed-function raster operation that keeps the nearest fragments. It compares a fragment with the depths of all
// entries at once and shifts those behind it; what is beyond the last entry can be dropped before it is shaded.
//
// The last entry's depth only falls, so a bound that is out of date rejects too little and never wrongly. The result
// does not depend on order but among equal depths, so the reorder buffer can be left out. Source: specification 004,
// section 7.4; Bavoil 2007, section 6.5.
#include "models/kbuffers/configured_design.hpp"

namespace models {

namespace {

using namespace pipeline;

struct PeelRopParams {
    std::uint32_t latency = 5;
    std::uint32_t port_bytes = 32;
    EarlyReject early_reject = EarlyReject::tile;
    Retirement retirement = Retirement::in_order;

    static constexpr auto fields() {
        using P = PeelRopParams;
        return std::tuple{
            sim::field<&P::latency>("From read to write; the same pixel may follow in the next cycle")
                .unit("cycles")
                .range(1, 100),
            sim::field<&P::port_bytes>("Bytes per cycle between one ROP's unit and the tile cache")
                .unit("bytes")
                .range(1, 4096),
            sim::field<&P::early_reject>(
                "What a fragment is compared with before it is shaded: nothing, the farthest last "
                "entry of its 4x4 tile, or the last entry of its pixel"),
            sim::field<&P::retirement>("Order in which quads reach the ROPs; out of order, ties may fall differently")};
    }
};
static_assert(sim::fully_described<PeelRopParams>);

class PeelRop final : public ConfiguredDesign<PeelRop, PeelRopParams> {
  public:
    static constexpr std::string_view name = "peel-rop";
    static constexpr std::string_view text = "D3: fixed-function raster operation that keeps the nearest fragments";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override {
        return program.peeling() == Peeling::nearest ? "" : "the unit keeps the nearest fragments and nothing else";
    }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::blender;
        plan.blender.unit = BlendUnit::peel;
        plan.blender.interlock = BlendInterlock::forward;
        plan.blender.latency = params_.latency;
        plan.blender.port_bytes = params_.port_bytes;
        plan.blender.early_reject = params_.early_reject;
        plan.retirement = params_.retirement;
        plan.order_free = params_.retirement == Retirement::out_of_order;
        return plan;
    }
    // Entries and fragment inside; a depth comparator per entry; the bounds of all tiles or pixels.
    AddedHardware area(const ModifyProgram& program, const View& view, const GpuShape& shape) const override {
        const std::uint64_t pixels = view.samples_drawn();
        const std::uint64_t bounds = params_.early_reject == EarlyReject::none   ? 0
                                     : params_.early_reject == EarlyReject::tile ? pixels / 16
                                                                                 : pixels;
        return {{{"peeling_pipeline", std::uint64_t{params_.latency} * program.bytes_per_pixel() * 8 * shape.rops},
                 {"early_reject_bounds", bounds * 32}},
                std::uint64_t{program.k()} * shape.rops,
                0};
    }
};

} // namespace

DesignInfo peel_rop_design() { return PeelRop::info(); }

} // namespace models
