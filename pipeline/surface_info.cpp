#include "pipeline/surface_info.hpp"

#include "pipeline/functional/block_compression.hpp"
#include "sim/check.hpp"

#include <cstring>
#include <fmt/format.h>

namespace pipeline {

namespace {

constexpr std::uint32_t block_size = 4; ///< texels along a side of a compressed block

std::uint64_t blocks_along(std::uint32_t texels) { return (std::uint64_t{texels} + block_size - 1) / block_size; }

/// Of one plane, without gaps.
std::uint64_t plane_bytes(const SurfaceInfo& info, std::uint32_t level) {
    const std::uint32_t width = info.width_of(level), height = info.height_of(level);
    if (info.compressed()) return blocks_along(width) * blocks_along(height) * info.tile_bytes();
    return std::uint64_t{width} * height * info.texel_bytes();
}

/// Fills the pages of a level from bytes without gaps.
class PageFiller {
  public:
    PageFiller(const SurfaceInfo& info, std::uint32_t level, std::vector<SurfacePage>& pages)
        : info_(info), level_(level), grid_(info, level), texel_bytes_(info.texel_bytes()), pages_(pages) {
        pages_.resize(grid_.pages());
    }

    void fill(const std::byte* source) {
        for (std::uint32_t plane = 0; plane < info_.planes_of(level_); ++plane) {
            const std::uint32_t first_row = plane * info_.rows_between_planes(level_);
            if (info_.compressed())
                fill_blocks(first_row, source);
            else
                fill_texels(first_row, source);
            source += plane_bytes(info_, level_);
        }
    }

    void fill_with_zero() {
        const std::array<std::byte, largest_texel> zero{};
        if (info_.cleared == zero) return;
        const SurfacePage page = make_page(zero.data(), texel_bytes_);
        std::fill(pages_.begin(), pages_.end(), page);
    }

  private:
    void fill_texels(std::uint32_t first_row, const std::byte* source) {
        for (std::uint32_t y = 0; y < info_.height_of(level_); ++y)
            for (std::uint32_t x = 0; x < grid_.width;) { // as far as texels lie in a row of a page
                const std::uint32_t count = std::min(PageGrid::page_size - x % PageGrid::page_size, grid_.width - x);
                std::memcpy(texel(x, first_row + y), source, std::size_t{count} * texel_bytes_);
                source += std::size_t{count} * texel_bytes_;
                x += count;
            }
    }

    void fill_blocks(std::uint32_t first_row, const std::byte* source) {
        const std::uint32_t height = info_.height_of(level_);
        for (std::uint32_t y = 0; y < height; y += block_size)
            for (std::uint32_t x = 0; x < grid_.width; x += block_size, source += info_.tile_bytes()) {
                const DecodedBlock block = decode_block(info_.format, source);
                const std::uint32_t columns = std::min(block_size, grid_.width - x);
                for (std::uint32_t row = 0; row < std::min(block_size, height - y); ++row)
                    std::memcpy(texel(x, first_row + y + row), block[row].data(), std::size_t{columns} * 4);
            }
    }

    std::byte* texel(std::uint32_t x, std::uint32_t row) {
        const PageGrid::Place place = grid_.find(x, row);
        SurfacePage& page = pages_[place.page];
        // What lies beyond the edge is as in pages that a pass was the first to write to.
        if (page == nullptr) page = make_page(info_.cleared.data(), texel_bytes_);
        return page.get() + std::size_t{place.texel} * texel_bytes_;
    }

    const SurfaceInfo& info_;
    std::uint32_t level_;
    PageGrid grid_;
    std::uint32_t texel_bytes_;
    std::vector<SurfacePage>& pages_;
};

} // namespace

std::uint64_t SurfaceInfo::nominal_bytes() const {
    std::uint64_t bytes = 0;
    for (std::uint32_t level = 0; level < levels; ++level) bytes += planes_of(level) * plane_bytes(*this, level);
    return bytes;
}

SurfacePage make_page(const std::byte* texel, std::uint32_t texel_bytes) {
    SurfacePage page(new std::byte[std::size_t{PageGrid::page_texels} * texel_bytes]);
    for (std::size_t i = 0; i < PageGrid::page_texels; ++i)
        std::memcpy(page.get() + i * texel_bytes, texel, texel_bytes);
    return page;
}

std::shared_ptr<const SurfaceContents> make_contents(const SurfaceInfo& info, const std::vector<SharedBytes>& levels) {
    CHECK(info.program == nullptr);
    if (levels.size() > info.levels)
        throw sim::InputError(fmt::format("surface '{}': contents of {} levels, expected {} at most", info.name,
                                          levels.size(), info.levels));
    auto contents = std::make_shared<SurfaceContents>();
    contents->levels.resize(info.levels);
    for (std::uint32_t level = 0; level < info.levels; ++level) {
        PageFiller filler(info, level, contents->levels[level]);
        if (level >= levels.size() || levels[level].empty()) {
            filler.fill_with_zero();
            continue;
        }
        const std::uint64_t expected = info.planes_of(level) * plane_bytes(info, level);
        if (levels[level].size() != expected)
            throw sim::InputError(fmt::format("surface '{}': level {} has {} bytes, expected {}", info.name, level,
                                              levels[level].size(), expected));
        filler.fill(levels[level].data());
    }
    return contents;
}

} // namespace pipeline
