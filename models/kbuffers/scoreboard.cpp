// D1: fragment scheduling with a scoreboard. A table counts the quads in flight per screen area; a quad whose area is
// taken waits in a side buffer while later ones pass, and the rasterizer stalls when that overflows.
//
// Source: specification 004, section 7.2; Bavoil 2007, section 4.3.1.
#include "models/kbuffers/configured_design.hpp"
#include "sim/check.hpp"

#include <bit>

namespace models {

/// Area that one entry of the scoreboard stands for.
enum class Granularity : std::uint8_t { pixel, quad, tile4, tile8, tile16 };
/// When a quad stops blocking its area.
enum class ReleasePoint : std::uint8_t { rop_commit, visible };

} // namespace models

template <>
struct sim::EnumNames<models::Granularity> {
    static constexpr std::array<std::string_view, 5> names{"pixel", "quad", "tile4", "tile8", "tile16"};
};
template <>
struct sim::EnumNames<models::ReleasePoint> {
    static constexpr std::array<std::string_view, 2> names{"rop_commit", "visible"};
};

namespace models {

namespace {

using namespace pipeline;

struct ScoreboardParams {
    Granularity granularity = Granularity::quad;
    std::uint32_t entries = 0;
    std::uint32_t side_buffer = 32;
    std::uint32_t lookups = 4;
    std::uint32_t wakes = 1;
    std::uint32_t lookup_latency = 2;
    ReleasePoint release = ReleasePoint::visible;
    bool order_rule = true;
    DispatchPolicy policy = DispatchPolicy::any_pipe;
    Visibility visibility = Visibility::rop_cache;
    bool bypass_l1 = true;

    static constexpr auto fields() {
        using P = ScoreboardParams;
        return std::tuple{
            sim::field<&P::granularity>(
                "Area one entry stands for: a pixel of a quad, a quad, or a tile of 4, 8 or 16 pixels"),
            sim::field<&P::entries>(
                "Entries, by hash of the area; 0 = one for every area of the image, of every sample")
                .unit("entries")
                .range(0, 1 << 26),
            sim::field<&P::side_buffer>("Quads that can wait for their area (B)").unit("quads").range(0, 65536),
            sim::field<&P::lookups>("Quads tested per cycle").unit("quads").range(1, 64),
            sim::field<&P::wakes>("Waiting quads dispatched per cycle").unit("quads").range(1, 64),
            sim::field<&P::lookup_latency>("Cycles of a lookup").unit("cycles").range(1, 100),
            sim::field<&P::release>(
                "When a quad frees its area: its store is in the ROP's tile cache, or readers see it"),
            sim::field<&P::order_rule>("A quad also waits behind older waiting quads of its area"),
            sim::field<&P::policy>("Pipe of a quad: the next free one, or the one of its tile"),
            sim::field<&P::visibility>(
                "When a store becomes visible to a k-buffer read; anything but rop_cache makes stores write through"),
            sim::field<&P::bypass_l1>("k-buffer reads do not look into the texture caches")};
    }
};
static_assert(sim::fully_described<ScoreboardParams>);

std::uint32_t side_of(Granularity granularity) {
    constexpr std::array<std::uint32_t, 5> sides{2, 2, 4, 8, 16};
    return sides[static_cast<std::size_t>(granularity)];
}

std::uint32_t areas(Granularity granularity, const View& view) {
    const std::uint32_t side = side_of(granularity);
    return ((view.width + side - 1) / side) * ((view.rows() + side - 1) / side);
}

class ScoreboardTable final : public DispatchGuard {
  public:
    ScoreboardTable(const ScoreboardParams& params, const View& view)
        : side_(side_of(params.granularity)),
          columns_((view.width + side_ - 1) / side_),
          per_pixel_(params.granularity == Granularity::pixel),
          hashed_(params.entries != 0),
          entries_(hashed_ ? params.entries : areas(params.granularity, view)),
          in_flight_(std::size_t{4} * entries_) {}

    std::uint32_t keys() const override { return entries_; }
    std::uint32_t key(const Quad& quad) const override {
        const std::uint32_t area = quad.y / side_ * columns_ + quad.x / side_;
        // Fibonacci hashing: neighbouring areas spread over the table.
        return hashed_ ? static_cast<std::uint32_t>((area * std::uint64_t{0x9E3779B97F4A7C15} >> 32U) % entries_)
                       : area;
    }

    // Four counters per entry: one per pixel of the quad position, or only the first for coarser areas.
    bool blocks(const Quad& quad, std::uint8_t mask) const override {
        const std::size_t first = std::size_t{4} * key(quad);
        if (!per_pixel_) return in_flight_[first] != 0;
        for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
            if ((mask >> pixel & 1) != 0 && in_flight_[first + pixel] != 0) return true;
        return false;
    }
    void acquire(const Quad& quad, std::uint8_t mask) override { count(quad, mask, 1); }
    void release(const Quad& quad, std::uint8_t mask) override { count(quad, mask, -1); }

  private:
    void count(const Quad& quad, std::uint8_t mask, std::int32_t by) {
        const std::size_t first = std::size_t{4} * key(quad);
        for (std::uint32_t pixel = 0; pixel < (per_pixel_ ? 4U : 1U); ++pixel) {
            if (per_pixel_ && (mask >> pixel & 1) == 0) continue;
            in_flight_[first + pixel] += by;
            CHECK(in_flight_[first + pixel] >= 0);
        }
    }

    std::uint32_t side_, columns_;
    bool per_pixel_, hashed_;
    std::uint32_t entries_;
    std::vector<std::int32_t> in_flight_; ///< quads, by entry and pixel
};

class Scoreboard final : public ConfiguredDesign<Scoreboard, ScoreboardParams> {
  public:
    static constexpr std::string_view name = "scoreboard";
    static constexpr std::string_view text =
        "D1: scoreboard in the fragment scheduler, side buffer for conflicting quads";

    using ConfiguredDesign::ConfiguredDesign;

    KBufferPlan plan(const ModifyProgram&, const View& view) const override {
        KBufferPlan plan;
        plan.site = UpdateSite::fragment_shader;
        plan.shader.visibility = params_.visibility;
        plan.shader.coherence = TextureCoherence::none;
        plan.shader.bypass_l1 = params_.bypass_l1;
        // Released at visibility, a store must become visible without waiting for an eviction that may never come.
        plan.shader.write_through =
            params_.visibility != Visibility::rop_cache && params_.release == ReleasePoint::visible;
        plan.scheduling.guard = std::make_unique<ScoreboardTable>(params_, view);
        plan.scheduling.side_buffer = params_.side_buffer;
        plan.scheduling.lookups = params_.lookups;
        plan.scheduling.wakes = params_.wakes;
        plan.scheduling.lookup_latency = params_.lookup_latency;
        plan.scheduling.policy = params_.policy;
        plan.scheduling.order_rule = params_.order_rule;
        return plan;
    }

    // Table: one counter per entry that can hold all quads in flight (pixel masks: 4 bits). Side buffer: position,
    // sample, mask and a reference to the interpolants of each quad.
    AddedHardware area(const ModifyProgram&, const View& view, const GpuShape& shape) const override {
        const std::uint64_t entries = params_.entries != 0 ? params_.entries : areas(params_.granularity, view);
        const std::uint64_t counter =
            params_.granularity == Granularity::pixel ? 4 : std::bit_width(shape.quads_in_flight);
        const std::uint64_t packet =
            2 * std::bit_width(std::max(view.width, view.height)) + std::bit_width(view.samples - 1) + 4 + 32;
        return {
            {{"scoreboard", entries * counter}, {"side_buffer", params_.side_buffer * packet}}, params_.side_buffer, 0};
    }
};

} // namespace

DesignInfo scoreboard_design() { return Scoreboard::info(); }

} // namespace models
