// Three ways in which a programmable blender can find out that a quad's pixel is still inside it: an associative memory
// of the quads inside, which knows exactly; counters by a hash of the pixel, where two pixels can share one; a ticket
// per 4x4 tile. Whoever is mistaken for a conflict waits, and no pixel is ever wrong.
//
// Source: specification 004, section 8 and 7.3; the three are known from simulators and hardware descriptions of ROPs
// (exact: ATTILA; hashed: Vortex; tile: Emerald) and have not been compared before.
#include "models/kbuffers/configured_design.hpp"

#include <bit>

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
        return std::tuple{
            sim::field<&P::entries>("Quads that the associative memory of a partition holds")
                .unit("quads")
                .range(1, 4096),
            sim::field<&P::lanes>("Scalar operations per cycle of one ROP's blender").unit("operations").range(1, 1024),
            sim::field<&P::port_bytes>("Bytes per cycle between one ROP's blender and the tile cache")
                .unit("bytes")
                .range(1, 4096),
            sim::field<&P::latency>("From read to write (L_b)").unit("cycles").range(1, 1000)};
    }
};
static_assert(sim::fully_described<CamParams>);

struct HashedParams {
    std::uint32_t counters = 256;
    std::uint32_t lanes = 4;
    std::uint32_t port_bytes = 32;
    std::uint32_t latency = 16;

    static constexpr auto fields() {
        using P = HashedParams;
        return std::tuple{
            sim::field<&P::counters>("Counters of a partition, by hash of the pixel (B)")
                .unit("counters")
                .range(1, 1 << 24),
            sim::field<&P::lanes>("Scalar operations per cycle of one ROP's blender").unit("operations").range(1, 1024),
            sim::field<&P::port_bytes>("Bytes per cycle between one ROP's blender and the tile cache")
                .unit("bytes")
                .range(1, 4096),
            sim::field<&P::latency>("From read to write (L_b)").unit("cycles").range(1, 1000)};
    }
};
static_assert(sim::fully_described<HashedParams>);

struct TileTicketParams {
    std::uint32_t lanes = 4;
    std::uint32_t port_bytes = 32;
    std::uint32_t latency = 16;

    static constexpr auto fields() {
        using P = TileTicketParams;
        return std::tuple{
            sim::field<&P::lanes>("Scalar operations per cycle of one ROP's blender").unit("operations").range(1, 1024),
            sim::field<&P::port_bytes>("Bytes per cycle between one ROP's blender and the tile cache")
                .unit("bytes")
                .range(1, 4096),
            sim::field<&P::latency>("From read to write (L_b)").unit("cycles").range(1, 1000)};
    }
};
static_assert(sim::fully_described<TileTicketParams>);

template <class Params>
KBufferPlan blender_with(InterlockTest test, const Params& params) {
    KBufferPlan plan;
    plan.site = UpdateSite::blender;
    plan.blender = {BlendInterlock::stall, params.lanes, params.port_bytes, params.latency, test};
    return plan;
}

std::string blender_refuses(const ModifyProgram& program) {
    return program.needs_texture() ? "it fetches a table, which a blender cannot" : "";
}

nlohmann::ordered_json blender_area(const ModifyProgram& program, std::uint32_t latency, std::uint64_t interlock_bits,
                                    std::uint64_t comparators, std::uint32_t lanes) {
    return {{"added_state_bits", std::uint64_t{latency} * program.bytes_per_pixel() * 8 + interlock_bits},
            {"interlock_bits", interlock_bits},
            {"added_comparators", comparators},
            {"added_alu_lanes", lanes},
            {"per", "ROP"}};
}

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
    nlohmann::ordered_json area(const ModifyProgram& program, const View&, std::uint32_t) const override {
        return blender_area(program, params_.latency, std::uint64_t{params_.entries} * (24 + 4), params_.entries,
                            params_.lanes);
    }
};

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
    nlohmann::ordered_json area(const ModifyProgram& program, const View&, std::uint32_t) const override {
        const std::uint64_t bits = std::uint64_t{params_.counters} * std::bit_width(params_.latency);
        return blender_area(program, params_.latency, bits, 0, params_.lanes);
    }
};

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
    nlohmann::ordered_json area(const ModifyProgram& program, const View&, std::uint32_t) const override {
        return blender_area(program, params_.latency, params_.latency, 0, params_.lanes);
    }
};

} // namespace

DesignInfo cam_design() { return Cam::info(); }
DesignInfo hashed_design() { return Hashed::info(); }
DesignInfo tile_ticket_design() { return TileTicket::info(); }

} // namespace models
