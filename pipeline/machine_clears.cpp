// Clears of surfaces, fast ones too, and what they leave to be written before somebody reads past the ROPs.
#include "pipeline/machine_units.hpp"

namespace pipeline {

void Machine::clear(const Pass& pass) {
    begin(pass.name);
    for (const SurfaceId surface : pass.clears) {
        const SurfaceInfo& info = frame_->surfaces[surface];
        const SurfaceLayout layout = layout_of(info.width, info.height, info.planes);
        const std::uint64_t texels = std::uint64_t{info.width} * info.height * info.planes;
        units_->surfaces.clear(surface);
        if (info.program != nullptr) forget_entries();
        drop_written(std::span(&surface, 1));
        if (info.program == nullptr)
            clear_surface(units_->cleared[surface], layout, texels,
                          {units_->surfaces.address(surface, {}), bytes_of(info.format)});
        // Peeling clears its layers one by one instead. Tile memory is cleared on chip, and stores whole sectors.
        else if (plan_.shader.tile_memory)
            units_->kbuffer_clear.set(layout);
        else if (units_->lists || units_->kbuffer)
            clear_surface(units_->kbuffer_clear, layout, texels, {kbuffer_address(surface), kbuffer_bytes()});
    }
    units_->simulation.run(options_.stop);
    end();
}

void Machine::forget_entries() {
    if (units_->kbuffer) {
        lost_before_clears_ += units_->kbuffer->lost_updates();
        units_->kbuffer->clear();
    }
    if (units_->lists) units_->lists->clear();
    units_->history->forget_stores();
}

std::uint32_t Machine::kbuffer_bytes() const {
    return units_->lists ? plan_.lists.head_bytes : frame_->program->bytes_per_pixel();
}

std::uint64_t Machine::kbuffer_address(SurfaceId kbuffer) const {
    return units_->lists ? own_address() : units_->surfaces.address(kbuffer, {});
}

std::uint64_t Machine::own_address() const {
    constexpr std::uint64_t alignment = 4096;
    return (units_->surfaces.end_address() + alignment - 1) / alignment * alignment;
}

bool Machine::clears_fast(const SurfaceLayout& layout) const {
    return gpu_.rop.fast_clear && layout.blocks() <= gpu_.rop.clear_sectors;
}

void Machine::clear_surface(ClearBits& bits, const SurfaceLayout& layout, std::uint64_t pixels,
                            const SurfaceBytes& surface) {
    bits.reset();
    if (clears_fast(layout))
        bits.set(layout);
    else
        stream_surface({.write_bytes = pixels * surface.pixel_bytes, .write_address = surface.address});
}

void Machine::resolve_cleared(std::span<const SurfaceId> read) {
    for (const SurfaceId surface : read) {
        const SurfaceInfo& info = frame_->surfaces[surface];
        if (info.program == nullptr)
            resolve_cleared(units_->cleared[surface], {units_->surfaces.address(surface, {}), bytes_of(info.format)});
        else
            resolve_cleared(units_->kbuffer_clear, {kbuffer_address(surface), kbuffer_bytes()});
    }
}

// Readers on the memory side do not see the table.
void Machine::resolve_cleared(ClearBits& bits, const SurfaceBytes& surface) {
    if (bits.left() != 0)
        stream_surface(
            {.write_bytes = bits.left() * 4 * surface.pixel_bytes, .write_address = surface.address, .resolve = true});
    units_->simulation.run(options_.stop);
    bits.reset();
}

} // namespace pipeline
