#include "pipeline/surface_access.hpp"

#include "pipeline/functional/surface_texel.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>

namespace pipeline {

namespace {

/// Exactly `a` where both are equal: a surface of one value stays one, whatever the weights.
glm::vec4 between(const glm::vec4& a, const glm::vec4& b, float t) { return a + (b - a) * t; }

template <class Use>
void for_each_pixel(unsigned pixels, Use&& use) {
    for (std::size_t i = 0; i < 4; ++i)
        if (((pixels >> i) & 1U) != 0) use(i);
}

/// log2 of the longer of the quad's two footprints in texels of level 0; 0 where the surface is magnified.
float level_of_detail(const SurfaceInfo& info, const Lanes& u, const Lanes& v) {
    const auto squared_distance_to = [&](std::size_t pixel) {
        const double du = (static_cast<double>(u[pixel]) - static_cast<double>(u[0])) * info.width;
        const double dv = (static_cast<double>(v[pixel]) - static_cast<double>(v[0])) * info.height;
        return du * du + dv * dv;
    };
    const double texels = std::max(squared_distance_to(1), squared_distance_to(2));
    return texels > 1.0 ? static_cast<float>(0.5 * std::log2(texels)) : 0.0F;
}

} // namespace

glm::vec4 SurfaceAccess::texel(SurfaceId surface, std::int32_t x, std::int32_t y, std::uint32_t plane,
                               std::uint32_t level, const glm::vec4& outside) {
    const SurfaceInfo& info = surfaces_.info(surface);
    const auto width = static_cast<std::int32_t>(info.width_of(level));
    const auto height = static_cast<std::int32_t>(info.height_of(level));
    if (x < 0 || y < 0 || x >= width || y >= height) return outside;
    const std::uint32_t row = plane * info.rows_between_planes(level) + static_cast<std::uint32_t>(y);
    return unpack_texel(info.format, bytes(surface, {static_cast<std::uint32_t>(x), row, level}));
}

QuadTexels SurfaceAccess::fetch(std::uint32_t slot, const LaneIndices& x, const LaneIndices& y, unsigned pixels,
                                std::uint32_t plane, std::uint32_t level) {
    const SurfaceId surface = slots_[slot];
    const SurfaceInfo& info = surfaces_.info(surface);
    CHECK(info.program == nullptr);
    begin_fetch(surface);
    const std::uint32_t width = info.width_of(level), height = info.height_of(level);
    const std::uint32_t first_row = plane * info.rows_between_planes(level);
    std::array<const std::byte*, 4> texels{};
    for_each_pixel(pixels, [&](std::size_t i) {
        const auto column = static_cast<std::uint32_t>(x[i]), row = static_cast<std::uint32_t>(y[i]); // < 0: very large
        if (column < width && row < height) texels[i] = bytes(surface, {column, first_row + row, level});
    });
    return unpack_texels(info.format, texels);
}

QuadTexels SurfaceAccess::filter(SurfaceId surface, const SurfaceSampler& sampler, const Lanes& u, const Lanes& v,
                                 unsigned pixels, std::uint32_t plane, std::uint32_t level) {
    const SurfaceInfo& info = surfaces_.info(surface);
    const AxisReads x = reads_along(sampler.wrap_u, sampler.linear, wrapped(sampler.wrap_u, u), info.width_of(level));
    const AxisReads y = reads_along(sampler.wrap_v, sampler.linear, wrapped(sampler.wrap_v, v), info.height_of(level));
    const auto at = [&](std::int32_t column, std::int32_t row) {
        return texel(surface, column, row, plane, level, sampler.border);
    };
    QuadTexels result{};
    for_each_pixel(pixels, [&](std::size_t i) {
        result[i] = at(x.low[i], y.low[i]);
        if (!sampler.linear) return;
        const glm::vec4 top = between(result[i], at(x.high[i], y.low[i]), x.share[i]);
        const glm::vec4 bottom = between(at(x.low[i], y.high[i]), at(x.high[i], y.high[i]), x.share[i]);
        result[i] = between(top, bottom, y.share[i]);
    });
    return result;
}

QuadTexels SurfaceAccess::sample(std::uint32_t slot, const SurfaceSampler& sampler, const Lanes& u, const Lanes& v,
                                 unsigned pixels, std::uint32_t plane) {
    const float level = sampler.mips ? level_of_detail(info(slot), u, v) : 0.0F;
    return sample_level(slot, sampler, u, v, pixels, level, plane);
}

QuadTexels SurfaceAccess::sample_level(std::uint32_t slot, const SurfaceSampler& sampler, const Lanes& u,
                                       const Lanes& v, unsigned pixels, float level_of_detail, std::uint32_t plane) {
    const SurfaceId surface = slots_[slot];
    const SurfaceInfo& info = surfaces_.info(surface);
    CHECK(info.program == nullptr);
    const auto last = static_cast<float>(info.levels - 1);
    const float level = std::clamp(level_of_detail, 0.0F, last);
    begin_fetch(surface);
    if (!sampler.linear) // halves go down
        return filter(surface, sampler, u, v, pixels, plane, static_cast<std::uint32_t>(std::ceil(level - 0.5F)));
    const auto fine = static_cast<std::uint32_t>(level);
    QuadTexels result = filter(surface, sampler, u, v, pixels, plane, fine);
    const float share = level - static_cast<float>(fine);
    if (share == 0.0F) return result;
    const QuadTexels coarse = filter(surface, sampler, u, v, pixels, plane, fine + 1);
    for_each_pixel(pixels, [&](std::size_t i) { result[i] = between(result[i], coarse[i], share); });
    return result;
}

std::array<const float*, 4> SurfaceAccess::pixels(std::uint32_t slot, const LaneIndices& x, const LaneIndices& row,
                                                  unsigned pixels, std::uint32_t first, std::uint32_t count) {
    const SurfaceId kbuffer = slots_[slot];
    const SurfaceInfo& info = surfaces_.info(kbuffer);
    CHECK(info.program != nullptr && first + count <= info.program->targets());
    std::array<const float*, 4> result{};
    const auto place = [&](std::size_t i) {
        return SurfacePlace{static_cast<std::uint32_t>(x[i]), static_cast<std::uint32_t>(row[i]), 0};
    };
    for_each_pixel(pixels, [&](std::size_t i) { result[i] = surfaces_.entries(kbuffer, place(i)); });
    if (work_ == nullptr) return result;
    for (std::uint32_t target = first; target < first + count; ++target) {
        work_->begin_fetch(16);
        for_each_pixel(pixels, [&](std::size_t i) { work_->touch(surfaces_.address(kbuffer, place(i), target)); });
    }
    return result;
}

} // namespace pipeline
