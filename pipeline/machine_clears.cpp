// Clears of surfaces, fast ones too, and what they leave to be written before somebody reads past the ROPs.
#include "pipeline/machine_units.hpp"

namespace pipeline {

void Machine::clear(const Pass& pass) {
    begin(pass.name);
    std::uint64_t bytes = 0;
    for (const SurfaceId surface : pass.clears) {
        const SurfaceInfo& info = frame_->surfaces[surface];
        const SurfaceLayout layout = layout_of(info.width, info.height, info.planes);
        const std::uint64_t texels = std::uint64_t{info.width} * info.height * info.planes;
        units_->surfaces.clear(surface);
        if (info.program != nullptr) forget_entries();
        drop_written(std::span(&surface, 1));
        if (info.program == nullptr)
            bytes += clear_surface(units_->cleared[surface], layout, texels, bytes_of(info.format));
        // Peeling clears its layers one by one instead. Tile memory is cleared on chip, and stores whole sectors.
        else if (plan_.shader.tile_memory)
            units_->kbuffer_clear.set(layout);
        else if (units_->lists || units_->kbuffer)
            bytes += clear_surface(units_->kbuffer_clear, layout, texels, kbuffer_bytes());
    }
    if (bytes != 0) stream_surface(0, bytes);
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

bool Machine::clears_fast(const SurfaceLayout& layout) const {
    return gpu_.rop.fast_clear && layout.blocks() <= gpu_.rop.clear_sectors;
}

std::uint64_t Machine::clear_surface(ClearBits& bits, const SurfaceLayout& layout, std::uint64_t pixels,
                                     std::uint32_t pixel_bytes) {
    bits.reset();
    if (!clears_fast(layout)) return pixels * pixel_bytes;
    bits.set(layout);
    return 0;
}

void Machine::resolve_cleared(std::span<const SurfaceId> read) {
    for (const SurfaceId surface : read) {
        const SurfaceInfo& info = frame_->surfaces[surface];
        if (info.program == nullptr)
            resolve_cleared(units_->cleared[surface], bytes_of(info.format));
        else
            resolve_cleared(units_->kbuffer_clear, kbuffer_bytes());
    }
}

// Readers on the memory side do not see the table.
void Machine::resolve_cleared(ClearBits& bits, std::uint32_t pixel_bytes) {
    if (bits.left() != 0) stream_surface(0, bits.left() * 4 * pixel_bytes, true);
    bits.reset();
}

} // namespace pipeline
