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

} // namespace

std::uint64_t SurfaceInfo::nominal_bytes() const {
    std::uint64_t texels = 0;
    for (std::uint32_t level = 0; level < levels; ++level)
        texels += std::uint64_t{width_of(level)} * height_of(level) * planes;
    return texels * texel_bytes();
}

SurfaceStore::SurfaceStore(std::span<const SurfaceInfo> surfaces, std::uint64_t first_address,
                           Fp16Overflow fp16_overflow)
    : end_address_(first_address), fp16_overflow_(fp16_overflow) {
    for (const SurfaceInfo& info : surfaces) {
        CHECK(info.width >= 1 && info.height >= 1 && info.planes >= 1 && info.levels >= 1);
        Surface& surface = surfaces_.emplace_back();
        surface.info = info;
        surface.texel_bytes = info.texel_bytes();
        surface.cleared = cleared_texel(info);
        for (std::uint32_t i = 0; i < info.levels; ++i) {
            Level& level = surface.levels.emplace_back();
            level.width = info.width_of(i);
            level.rows = info.planes * plane_rows(info.height_of(i), info.planes);
            level.pages_in_row = (level.width + page_size - 1) / page_size;
            level.pages.resize(std::size_t{level.pages_in_row} * ((level.rows + page_size - 1) / page_size));
            level.address = (end_address_ + alignment - 1) / alignment * alignment;
            const SurfaceLayout layout{level.width, level.rows, 1};
            end_address_ = level.address + std::uint64_t{layout.blocks()} * 4 * surface.texel_bytes;
        }
    }
}

SurfaceStore::Page SurfaceStore::own_page(const Surface& surface, const std::byte* content) {
    const std::size_t texels = std::size_t{page_size} * page_size;
    Page page(new std::byte[texels * surface.texel_bytes]);
    if (content != nullptr) {
        std::memcpy(page.get(), content, texels * surface.texel_bytes);
        return page;
    }
    for (std::size_t i = 0; i < texels; ++i)
        std::memcpy(page.get() + i * surface.texel_bytes, surface.cleared.data(), surface.texel_bytes);
    return page;
}

void SurfaceStore::clear(SurfaceId id) {
    Surface& surface = surfaces_[id];
    surface.high_water = std::max(surface.high_water, allocated(surface));
    for (Level& level : surface.levels)
        for (Page& page : level.pages) page.reset();
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
    const std::size_t page_bytes = std::size_t{page_size} * page_size * surface.texel_bytes;
    const std::uint64_t cleared = XXH3_64bits(own_page(surface, nullptr).get(), page_bytes);
    std::vector<std::uint64_t> pages;
    for (const Level& level : surface.levels)
        for (const Page& page : level.pages)
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
    const std::uint64_t block = SurfaceLayout{level.width, level.rows, 1}.block_of(place.x, place.row);
    const std::uint64_t pixel = place.row % 2 * 2 + place.x % 2;
    const std::uint64_t base = level.address + block * 4 * surface.texel_bytes;
    if (surface.info.program == nullptr) return base + pixel * surface.texel_bytes;
    return base + (std::uint64_t{target} * 4 + pixel) * target_pixel_bytes;
}

std::uint64_t SurfaceStore::end_of(SurfaceId id) const {
    const Surface& surface = surfaces_[id];
    const Level& last = surface.levels.back();
    const std::uint64_t blocks = SurfaceLayout{last.width, last.rows, 1}.blocks();
    return last.address + blocks * 4 * surface.texel_bytes;
}

std::uint64_t SurfaceStore::allocated(const Surface& surface) {
    std::uint64_t pages = 0;
    for (const Level& level : surface.levels)
        pages += static_cast<std::uint64_t>(
            std::count_if(level.pages.begin(), level.pages.end(), [](const auto& page) { return page != nullptr; }));
    return pages * page_size * page_size * surface.texel_bytes;
}

SurfaceMemory SurfaceStore::memory(SurfaceId id) const {
    const Surface& surface = surfaces_[id];
    const std::uint64_t now = allocated(surface);
    return {surface.info.nominal_bytes(), now, std::max(surface.high_water, now)};
}

} // namespace pipeline
