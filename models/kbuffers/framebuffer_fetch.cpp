// Framebuffer fetch: the k-buffer lies in on-chip tile memory that the shader reads and writes, ordered per pixel;
// memory is touched when a finished tile is stored, and a tile that was cleared is not loaded.
//
// The whole surface counts as on chip. Not modelled: binning of the triangles, which a tiled GPU needs to visit its
// tiles one after the other. Source: specification 004, section 8 (framebuffer fetch, pixel local storage, image
// blocks).
#include "models/kbuffers/lock_table.hpp"

#include <fmt/format.h>

namespace models {

namespace {

using namespace pipeline;

struct FramebufferFetchParams {
    std::uint32_t bytes_per_pixel = 128;
    std::uint32_t read_latency = 8;
    std::uint32_t lock_latency = 2;
    std::uint32_t grants_per_clk = 6;

    static constexpr auto fields() {
        using P = FramebufferFetchParams;
        return std::tuple_cat(
            std::tuple{sim::field<&P::bytes_per_pixel>(
                           "Tile memory of a pixel, or of each of its samples; programs that need more are refused")
                           .unit("bytes")
                           .range(16, 1024),
                       sim::field<&P::read_latency>("From a read's arrival at the tile memory to its value")
                           .unit("cycles")
                           .range(1, 1000)},
            lock_table_fields<P>());
    }
};
static_assert(sim::fully_described<FramebufferFetchParams>);

class FramebufferFetch final : public ConfiguredDesign<FramebufferFetch, FramebufferFetchParams> {
  public:
    static constexpr std::string_view name = "framebuffer-fetch";
    static constexpr std::string_view text = "shader reads and writes on-chip tile memory, ordered per pixel";

    using ConfiguredDesign::ConfiguredDesign;

    std::string refuses(const ModifyProgram& program) const override {
        if (program.bytes_per_pixel() <= params_.bytes_per_pixel) return {};
        return fmt::format("it needs {} bytes per pixel, and tile memory has {} (framebuffer-fetch.bytes_per_pixel)",
                           program.bytes_per_pixel(), params_.bytes_per_pixel);
    }
    KBufferPlan plan(const ModifyProgram&, const View&) const override {
        KBufferPlan plan = in_critical_section(CriticalSection::ordered, LockArea::pixel, params_);
        plan.shader.atomic_reads = true;
        plan.shader.tile_memory = true;
        plan.shader.read_latency = params_.read_latency;
        return plan;
    }
    // Of a tiled GPU: memory of one tile of 32x32 pixels, and a place in the order unit for each quad in flight.
    nlohmann::ordered_json area(const ModifyProgram&, const View& view, std::uint32_t quads_in_flight) const override {
        return {{"added_state_bits", std::uint64_t{1024} * view.samples * params_.bytes_per_pixel * 8 +
                                         std::uint64_t{quads_in_flight} * 42},
                {"added_comparators", quads_in_flight},
                {"added_alu_lanes", 0},
                {"per", "GPU with one tile of 32x32 pixels"}};
    }
};

} // namespace

DesignInfo framebuffer_fetch_design() { return FramebufferFetch::info(); }

} // namespace models
