// Framebuffer fetch: the k-buffer lies in on-chip tile memory that the shader reads and writes, ordered per pixel;
// memory is touched when a finished tile is stored, and a tile that was cleared is not loaded.
//
// The whole surface is on chip, in time and in area. Not modelled: binning of the triangles, with which a tiled GPU
// makes do with the memory of one tile. Source: specification 004, section 8 (framebuffer fetch, pixel local storage,
// image blocks).
#include "models/kbuffers/lock_table.hpp"

#include <fmt/format.h>

namespace models {

namespace {

using namespace pipeline;

struct FramebufferFetchParams {
    std::uint32_t bytes_per_pixel = 128;
    std::uint32_t read_request_latency = 4;
    std::uint32_t read_return_latency = 4;
    std::uint32_t lock_latency = 2;
    std::uint32_t grants_per_clk = 6;

    static constexpr auto fields() {
        using P = FramebufferFetchParams;
        return std::tuple_cat(
            std::tuple{sim::field<&P::bytes_per_pixel>(
                           "Tile memory of a pixel, or of each of its samples; programs that need more are refused")
                           .unit("bytes")
                           .range(16, 1024),
                       sim::field<&P::read_request_latency>("From a read's arrival to the access of the tile memory")
                           .unit("cycles")
                           .range(0, 1000),
                       sim::field<&P::read_return_latency>("From that access to the value in the shader")
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
        plan.shader.read_request_latency = params_.read_request_latency;
        plan.shader.read_return_latency = params_.read_return_latency;
        return plan;
    }
    // What is held, and a place in the order unit for each quad in flight.
    AddedHardware area(const ModifyProgram&, const View& view, const GpuShape& shape) const override {
        return {{{"tile_memory", view.samples_drawn() * params_.bytes_per_pixel * 8},
                 {"locks", std::uint64_t{shape.quads_in_flight} * 42}},
                shape.quads_in_flight,
                0};
    }
};

} // namespace

DesignInfo framebuffer_fetch_design() { return FramebufferFetch::info(); }

} // namespace models
