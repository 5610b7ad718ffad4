#include "pipeline/draw.hpp"

namespace pipeline {

namespace {

constexpr std::uint64_t placement_alignment = 256;

std::uint64_t aligned(std::uint64_t address) {
    return (address + placement_alignment - 1) / placement_alignment * placement_alignment;
}

std::uint64_t bytes_in_memory(const Texture::Level& level) {
    const std::uint64_t tiles_x = (std::uint64_t{level.width} + 3) / 4;
    const std::uint64_t tiles_y = (std::uint64_t{level.height} + 3) / 4;
    return tiles_x * tiles_y * 64;
}

} // namespace

const VertexAttribute* Geometry::find(Semantic semantic) const {
    for (const VertexAttribute& attribute : attributes)
        if (attribute.semantic == semantic) return &attribute;
    return nullptr;
}

std::uint32_t Geometry::triangle_count() const {
    if (primitive_restart) return runs.empty() ? 0 : runs.back().first_triangle;
    return triangles_of(topology, index_count);
}

void Resources::place() {
    std::uint64_t next = 0;
    for (Buffer& buffer : buffers) {
        buffer.address = next;
        next = aligned(next + buffer.bytes.size());
    }
    for (Texture& texture : textures) {
        for (Texture::Level& level : texture.levels) {
            level.address = next;
            next = aligned(next + bytes_in_memory(level));
        }
    }
}

} // namespace pipeline
