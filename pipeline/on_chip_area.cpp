#include "pipeline/on_chip_area.hpp"

#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/surface_texel.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace pipeline {

namespace {

constexpr std::uint64_t pixels_of_quad = 4, bits_of_byte = 8;

std::uint64_t whole_bytes(std::uint64_t bits) { return (bits + bits_of_byte - 1) / bits_of_byte; }

bool updates_in_place(const Frame& frame, const KBufferPlan& plan) {
    return frame.needs.kbuffer && (plan.site == UpdateSite::fragment_shader || plan.site == UpdateSite::blender);
}

// A shader's store carries the whole pixel, everything else what the fragment is: colour and depth.
std::uint64_t payload_of_pixel(const Frame& frame, const KBufferPlan& plan) {
    constexpr std::uint64_t colour = 16, depth = 4;
    if (!frame.needs.kbuffer) return depth + (frame.needs.colour_surface ? colour : 0);
    if (plan.site == UpdateSite::fragment_shader) return frame.program->bytes_per_pixel();
    return std::uint64_t{sizeof(float)} * frame.program->floats_per_entry();
}

// Quads that leave in any order, and those inside a critical section, go to the ROPs at once.
bool waits_for_order(const KBufferPlan& plan) {
    return plan.retirement == Retirement::in_order &&
           !(plan.site == UpdateSite::fragment_shader && plan.shader.critical_section != CriticalSection::none);
}

std::uint64_t payload_bytes(const GpuParams& gpu, const Frame& frame, const KBufferPlan& plan) {
    const std::uint64_t queues = std::uint64_t{shape_of(gpu).rop_groups} * gpu.rop.queue;
    const std::uint64_t places = queues + (waits_for_order(plan) ? gpu.reorder_quads() : 0);
    return places * pixels_of_quad * payload_of_pixel(frame, plan);
}

TileCacheBytes caches_of(const GpuParams& gpu, const Frame& frame, const KBufferPlan& plan) {
    const bool lists = frame.needs.kbuffer && plan.site == UpdateSite::lists;
    const bool tiles = lists || (updates_in_place(frame, plan) && !plan.shader.tile_memory);
    return {uses_depth(frame, plan) ? gpu.rop.depth_cache_bytes : 0,
            uses_colour(frame, plan) ? gpu.rop.colour_cache_bytes : 0, tiles ? gpu.rop.kbuffer_cache_bytes : 0};
}

// One bit says of each sector of a surface that it is cleared, and of no memory yet; a table for each surface that has
// a cache.
std::uint64_t clear_bits(const GpuParams& gpu, const Frame& frame, const KBufferPlan& plan) {
    const TileCacheBytes caches = caches_of(gpu, frame, plan);
    const bool tile_memory = updates_in_place(frame, plan) && plan.shader.tile_memory;
    const int tables = (caches.depth != 0) + (caches.colour != 0) + (caches.kbuffer != 0 || tile_memory);
    return std::uint64_t{gpu.rop.clear_sectors} * static_cast<unsigned>(tables);
}

KBufferPlan plan_of(const Frame& frame, const KBufferDesign& design) {
    if (frame.program) return design.plan(*frame.program, frame.view_of_kbuffer());
    KBufferPlan plan;
    plan.site = UpdateSite::passes;
    return plan;
}

} // namespace

std::uint64_t OnChipArea::added_bytes() const {
    std::uint64_t bytes = 0;
    for (const AddedMemory& memory : added.memories) bytes += whole_bytes(memory.bits);
    return bytes;
}

bool uses_depth(const Frame& frame, const KBufferPlan& plan) {
    return frame.needs.depth || (frame.needs.kbuffer && plan.site == UpdateSite::passes);
}

bool uses_colour(const Frame& frame, const KBufferPlan& plan) {
    return frame.needs.colour_surface ||
           (frame.needs.kbuffer && plan.site == UpdateSite::passes && frame.program->needs_colour()) ||
           (frame.needs.kbuffer && plan.site == UpdateSite::lists); // the pass that sorts them writes entries
}

TileCacheBytes sector_bytes(const Frame& frame, const KBufferPlan& plan) {
    const std::uint32_t entries = plan.site == UpdateSite::lists ? plan.lists.head_bytes
                                  : frame.program != nullptr     ? frame.program->bytes_per_pixel()
                                                                 : 0;
    const auto line = [](std::uint32_t pixel_bytes) -> std::uint64_t {
        return pixel_bytes == 0 ? 0 : SectorShape{pixel_bytes}.line_bytes();
    };
    return {line(bytes_of(frame.depth_format)), line(bytes_of(frame.colour_format)), line(entries)};
}

GpuShape shape_of(const GpuParams& gpu) { return {gpu.reorder_quads(), gpu.rop.units, gpu.rop.groups()}; }

OnChipArea on_chip_area(const GpuParams& gpu, const Frame& frame, const KBufferDesign& design) {
    const KBufferPlan plan = plan_of(frame, design);
    OnChipArea area{caches_of(gpu, frame, plan), payload_bytes(gpu, frame, plan), {}};
    if (frame.program) area.added = design.area(*frame.program, frame.view_of_kbuffer(), shape_of(gpu));
    if (gpu.rop.fast_clear) area.added.memories.push_back({"clear_bits", clear_bits(gpu, frame, plan)});
    return area;
}

nlohmann::ordered_json area_json(const OnChipArea& area) {
    nlohmann::ordered_json added = nlohmann::ordered_json::object();
    for (const AddedMemory& memory : area.added.memories) added[memory.name] = whole_bytes(memory.bits);
    return {{"tile_cache_bytes", area.tile_caches.total()},
            {"payload_bytes", area.payload_bytes},
            {"added_bytes", area.added_bytes()},
            {"total_bytes", area.total_bytes()},
            {"tile_caches",
             {{"depth", area.tile_caches.depth},
              {"colour", area.tile_caches.colour},
              {"kbuffer", area.tile_caches.kbuffer}}},
            {"added", std::move(added)},
            {"added_comparators", area.added.comparators},
            {"added_alu_lanes", area.added.alu_lanes}};
}

FittedCaches fit_caches(const GpuParams& gpu, const Frame& frame, const KBufferDesign& design, std::uint64_t budget) {
    const OnChipArea area = on_chip_area(gpu, frame, design);
    const TileCacheBytes sector = sector_bytes(frame, plan_of(frame, design));
    const std::uint64_t groups = shape_of(gpu).rop_groups;
    FittedCaches fitted{false, gpu.rop, 0};
    struct Cache {
        std::uint64_t size, line;
        std::uint32_t RopParams::*bytes;
    };
    std::vector<Cache> caches;
    std::uint64_t least = 0;
    for (const Cache& cache : {Cache{area.tile_caches.depth, sector.depth, &RopParams::depth_cache_bytes},
                               Cache{area.tile_caches.colour, sector.colour, &RopParams::colour_cache_bytes},
                               Cache{area.tile_caches.kbuffer, sector.kbuffer, &RopParams::kbuffer_cache_bytes}}) {
        if (cache.size == 0) continue;
        caches.push_back(cache);
        least += groups * cache.line;
    }
    const std::uint64_t fixed = area.total_bytes() - area.tile_caches.total();
    fitted.needed = fixed + least;
    if (fitted.needed > budget) return fitted;
    fitted.fits = true;
    std::uint64_t left = budget - fixed, sizes = area.tile_caches.total();
    for (const Cache& cache : caches) {
        // What the next ones need at least stays theirs; the last one takes the rest.
        least -= groups * cache.line;
        const std::uint64_t share =
            cache.size == sizes ? left : left / sizes * cache.size + left % sizes * cache.size / sizes;
        const std::uint64_t most = std::min<std::uint64_t>(left - least, RopParams::largest_cache);
        const std::uint64_t lines =
            std::clamp(share / (groups * cache.line), std::uint64_t{1}, most / (groups * cache.line));
        const std::uint64_t bytes = lines * groups * cache.line;
        fitted.rop.*cache.bytes = static_cast<std::uint32_t>(bytes);
        left -= bytes;
        sizes -= cache.size;
    }
    fitted.needed = budget - left;
    return fitted;
}

} // namespace pipeline
