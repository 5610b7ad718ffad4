#include "traces/recording/recording.hpp"

#include <algorithm>

namespace traces {

LevelSize level_size(const RecordedSurface& surface, std::uint32_t level) {
    const auto halved = [level](std::uint32_t texels) { return std::max(1U, level < 32 ? texels >> level : 0U); };
    const LevelSize size{halved(surface.width), halved(surface.height), surface.depth};
    switch (surface.kind) {
    case SurfaceKind::cube:
        return {size.width, size.height, 6};
    case SurfaceKind::volume:
        return {size.width, size.height, halved(surface.depth)};
    default:
        return size;
    }
}

std::uint64_t level_bytes(const RecordedSurface& surface, std::uint32_t level) {
    const LevelSize size = level_size(surface, level);
    const std::uint64_t plane =
        is_compressed(surface.format)
            ? std::uint64_t{(size.width + 3) / 4} * ((size.height + 3) / 4) * block_bytes_of(surface.format)
            : std::uint64_t{size.width} * size.height * bytes_of(surface.format);
    return plane * size.planes;
}

} // namespace traces
