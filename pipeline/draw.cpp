#include "pipeline/draw.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <fmt/format.h>

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

constexpr std::uint64_t most_texels = std::uint64_t{1} << 31U; ///< bytes

std::uint64_t texel_bytes(const Texture& texture) {
    std::uint64_t bytes = 0;
    for (const Texture::Level& level : texture.levels) bytes += std::uint64_t{level.width} * level.height * 4;
    return bytes;
}

} // namespace

void Texture::make_empty_levels(std::uint32_t width, std::uint32_t height) {
    levels.assign(1, {width, height, {}, 0});
    for (; width > 1 || height > 1; levels.push_back({width, height, {}, 0})) {
        width = std::max(1U, width / 2);
        height = std::max(1U, height / 2);
    }
}

void Resources::read_textures() const {
    std::uint64_t bytes = 0;
    for (const Texture& texture : textures) bytes += texel_bytes(texture);
    const bool any = std::any_of(textures.begin(), textures.end(), [](const Texture& one) { return bool(one.decode); });
    if (any && bytes > most_texels)
        throw sim::InputError(fmt::format("textures: expected at most {} MiB of texels, got {} MiB in {} textures",
                                          most_texels >> 20U, bytes >> 20U, textures.size()));
    for (Texture& texture : textures) {
        if (!texture.decode) continue;
        std::vector<std::uint64_t> addresses;
        for (const Texture::Level& level : texture.levels) addresses.push_back(level.address);
        texture.levels[0].rgba = texture.decode();
        texture.decode = nullptr;
        texture.make_mips();
        CHECK(texture.levels.size() == addresses.size());
        for (std::size_t i = 0; i < addresses.size(); ++i) texture.levels[i].address = addresses[i];
    }
}

const Texture& Resources::read_map(std::uint32_t number) const {
    LateTexture& map = maps.at(number);
    if (!map.make) return map.texture;
    map.texture = map.make();
    map.make = nullptr;
    std::uint64_t bytes = 0;
    for (const LateTexture& one : maps) bytes += texel_bytes(one.texture);
    if (bytes > most_texels)
        throw sim::InputError(fmt::format("maps of materials: expected at most {} MiB of texels, got {} MiB",
                                          most_texels >> 20U, bytes >> 20U));
    return map.texture;
}

const VertexAttribute* Geometry::find(Semantic semantic) const {
    for (const VertexAttribute& attribute : attributes)
        if (attribute.semantic == semantic) return &attribute;
    return nullptr;
}

std::uint32_t Geometry::primitive_count() const {
    if (primitive_restart) return runs.empty() ? 0 : runs.back().first_primitive;
    return primitives_of(topology, index_count);
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
