// A programmable blender that takes one quad of a 4x4 tile at a time.
//
// Source: specification 004, sections 7.3 and 8.
#include "models/kbuffers/blender_interlock.hpp"

namespace models {

namespace {

using namespace pipeline;

struct TileTicketParams {
    std::uint32_t lanes = 4;
    std::uint32_t port_bytes = 32;
    std::uint32_t latency = 16;

    static constexpr auto fields() { return blender_fields<TileTicketParams>(); }
};
static_assert(sim::fully_described<TileTicketParams>);

class TileTicket final : public ConfiguredDesign<TileTicket, TileTicketParams> {
  public:
    static constexpr std::string_view name = "tile-ticket";
    static constexpr std::string_view text = "programmable blender that takes one quad of a 4x4 tile at a time";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override { return blender_refuses(program); }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        return blender_with(InterlockTest::tile, params_);
    }
    // A busy bit for each tile of the tile cache is all it needs.
    AddedHardware area(const ModifyProgram& program, const View&, const GpuShape& shape) const override {
        return {{{"blender_pipeline", pipeline_bits(program, params_.latency, shape)},
                 {"tickets", std::uint64_t{params_.latency} * shape.rop_groups}},
                0,
                std::uint64_t{params_.lanes} * shape.rops};
    }
};

} // namespace

DesignInfo tile_ticket_design() { return TileTicket::info(); }

} // namespace models
