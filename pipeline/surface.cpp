#include "pipeline/surface.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cstring>
#include <xxhash.h>

namespace pipeline {

namespace {

constexpr std::uint64_t alignment = 256; ///< of a level, in bytes

std::vector<std::byte> cleared_texel(const SurfaceInfo& info) {
    std::vector<std::byte> texel(info.texel_bytes());
    if (info.program == nullptr) {
        std::memcpy(texel.data(), info.cleared.data(), texel.size());
        return texel;
    }
    std::vector<float> pixel(info.program->floats_per_pixel());
    info.program->clear(pixel.data());
    std::memcpy(texel.data(), pixel.data(), texel.size());
    return texel;
}

SurfaceLayout layout_of(const PageGrid& grid) { return {grid.width, grid.rows, 1}; }

} // namespace

SurfaceStore::SurfaceStore(std::span<const SurfaceInfo> surfaces, std::uint64_t first_address,
                           Fp16Overflow fp16_overflow)
    : end_address_(first_address), fp16_overflow_(fp16_overflow) {
    for (const SurfaceInfo& info : surfaces) {
        CHECK(info.width >= 1 && info.height >= 1 && info.planes >= 1 && info.levels >= 1);
        Surface& surface = surfaces_.emplace_back();
        surface.info = info;
        surface.texel_bytes = info.texel_bytes();
        surface.tile_bytes = info.tile_bytes();
        surface.cleared = cleared_texel(info);
        for (std::uint32_t i = 0; i < info.levels; ++i) {
            Level& level = surface.levels.emplace_back();
            level.grid = PageGrid(info, i);
            level.pages.resize(level.grid.pages());
            if (info.contents != nullptr) level.pages = info.contents->levels[i];
            CHECK(level.pages.size() == level.grid.pages());
            level.address = (end_address_ + alignment - 1) / alignment * alignment;
            level.bytes = info.shape == SurfaceShape::row
                              ? std::uint64_t{level.grid.width} * surface.texel_bytes
                              : std::uint64_t{layout_of(level.grid).tiles()} * surface.tile_bytes;
            end_address_ = level.address + level.bytes;
        }
    }
}

SurfacePage SurfaceStore::own_page(const Surface& surface, const std::byte* content) {
    CHECK(!surface.info.compressed());
    if (content == nullptr) return make_page(surface.cleared.data(), surface.texel_bytes);
    const std::size_t bytes = std::size_t{PageGrid::page_texels} * surface.texel_bytes;
    SurfacePage page(new std::byte[bytes]);
    std::memcpy(page.get(), content, bytes);
    return page;
}

void SurfaceStore::clear(SurfaceId id) {
    Surface& surface = surfaces_[id];
    surface.high_water = std::max(surface.high_water, allocated(surface));
    for (Level& level : surface.levels)
        for (SurfacePage& page : level.pages) page.reset();
}

void SurfaceStore::share(const SurfaceStore& other, SurfaceId id) {
    Surface& surface = surfaces_[id];
    surface.high_water = std::max(surface.high_water, allocated(surface));
    for (std::size_t level = 0; level < surface.levels.size(); ++level)
        surface.levels[level].pages = other.surfaces_[id].levels[level].pages;
}

SurfaceStore SurfaceStore::shown() const {
    SurfaceStore store;
    for (const Surface& surface : surfaces_)
        if (!surface.info.shown.empty()) store.surfaces_.push_back(surface);
    store.end_address_ = end_address_;
    return store;
}

// Pages at the edge reach beyond the surface; what lies there is never written.
std::uint64_t SurfaceStore::digest(SurfaceId id) const {
    const Surface& surface = surfaces_[id];
    const std::size_t page_bytes = std::size_t{PageGrid::page_texels} * surface.texel_bytes;
    const SurfacePage blank = make_page(surface.cleared.data(), surface.texel_bytes);
    const std::uint64_t cleared = XXH3_64bits(blank.get(), page_bytes);
    std::vector<std::uint64_t> pages;
    for (const Level& level : surface.levels)
        for (const SurfacePage& page : level.pages)
            pages.push_back(page == nullptr ? cleared : XXH3_64bits(page.get(), page_bytes));
    return XXH3_64bits(pages.data(), pages.size() * sizeof(std::uint64_t));
}

std::uint64_t SurfaceStore::differences(const SurfaceStore& other, SurfaceId surface) const {
    std::uint64_t count = 0;
    for (std::uint32_t row = 0; row < rows(surface); ++row)
        for (std::uint32_t x = 0; x < info(surface).width; ++x) count += same(other, surface, {x, row, 0}) ? 0 : 1;
    return count;
}

bool SurfaceStore::same(const SurfaceStore& other, SurfaceId surface, SurfacePlace place) const {
    const std::byte *here = read(surface, place), *there = other.read(surface, place);
    return std::memcmp(here, there, surfaces_[surface].texel_bytes) == 0;
}

std::uint64_t SurfaceStore::address(SurfaceId id, SurfacePlace place, std::uint32_t target) const {
    const Surface& surface = surfaces_[id];
    const Level& level = surface.levels[place.level];
    if (level.grid.row) return level.address + std::uint64_t{place.x} * surface.texel_bytes;
    const SurfaceLayout layout = layout_of(level.grid);
    if (surface.info.compressed())
        return level.address + std::uint64_t{layout.tile_of(place.x, place.row)} * surface.tile_bytes;
    const std::uint64_t block = layout.block_of(place.x, place.row);
    const std::uint64_t pixel = place.row % 2 * 2 + place.x % 2;
    const std::uint64_t base = level.address + block * 4 * surface.texel_bytes;
    if (surface.info.program == nullptr) return base + pixel * surface.texel_bytes;
    return base + (std::uint64_t{target} * 4 + pixel) * target_pixel_bytes;
}

std::uint64_t SurfaceStore::end_of(SurfaceId id) const {
    const Level& last = surfaces_[id].levels.back();
    return last.address + last.bytes;
}

std::uint64_t SurfaceStore::allocated(const Surface& surface) {
    std::uint64_t pages = 0;
    for (const Level& level : surface.levels)
        pages += static_cast<std::uint64_t>(
            std::count_if(level.pages.begin(), level.pages.end(), [](const auto& page) { return page != nullptr; }));
    constexpr std::uint64_t tiles_of_page = PageGrid::page_texels / 16;
    return pages * tiles_of_page * surface.tile_bytes;
}

SurfaceMemory SurfaceStore::memory(SurfaceId id) const {
    const Surface& surface = surfaces_[id];
    const std::uint64_t now = allocated(surface);
    return {surface.info.nominal_bytes(), now, std::max(surface.high_water, now)};
}

} // namespace pipeline
