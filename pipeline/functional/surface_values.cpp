#include "pipeline/functional/surface_values.hpp"

#include "pipeline/functional/surface_texel.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cstring>

namespace pipeline {

namespace {

template <class Visit>
void for_each_place(const SurfaceStore& surfaces, SurfaceId surface, Visit visit) {
    if (surface == no_surface) return;
    const std::uint32_t width = surfaces.info(surface).width, rows = surfaces.rows(surface);
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t x = 0; x < width; ++x) visit(SurfacePlace{x, row, 0});
}

} // namespace

std::vector<float> colours_of(const SurfaceStore& surfaces, SurfaceId surface) {
    std::vector<float> values;
    if (surface != no_surface) values.reserve(surfaces.places(surface) * 4);
    for_each_place(surfaces, surface, [&](const SurfacePlace& place) {
        const glm::vec4 texel = unpack_texel(surfaces.info(surface).format, surfaces.read(surface, place));
        values.insert(values.end(), {texel.r, texel.g, texel.b, texel.a});
    });
    return values;
}

std::vector<float> channel_of(const SurfaceStore& surfaces, SurfaceId surface, std::uint32_t channel) {
    std::vector<float> values;
    if (surface != no_surface) values.reserve(surfaces.places(surface));
    for_each_place(surfaces, surface, [&](const SurfacePlace& place) {
        const glm::vec4 texel = unpack_texel(surfaces.info(surface).format, surfaces.read(surface, place));
        values.push_back(texel[static_cast<int>(channel)]);
    });
    return values;
}

std::vector<float> depths_of(const SurfaceStore& surfaces, SurfaceId surface) {
    std::vector<float> values;
    if (surface == no_surface || !has_depth(surfaces.info(surface).format)) return values;
    const SurfaceFormat format = surfaces.info(surface).format;
    values.reserve(surfaces.places(surface));
    for_each_place(surfaces, surface, [&](const SurfacePlace& place) {
        values.push_back(depth_value(format, unpack_depth_stencil(format, surfaces.read(surface, place)).depth));
    });
    return values;
}

std::vector<std::uint8_t> stencils_of(const SurfaceStore& surfaces, SurfaceId surface) {
    std::vector<std::uint8_t> values;
    if (surface == no_surface || !has_stencil(surfaces.info(surface).format)) return values;
    const SurfaceFormat format = surfaces.info(surface).format;
    values.reserve(surfaces.places(surface));
    for_each_place(surfaces, surface, [&](const SurfacePlace& place) {
        values.push_back(unpack_depth_stencil(format, surfaces.read(surface, place)).stencil);
    });
    return values;
}

std::vector<float> entries_of(const SurfaceStore& surfaces, SurfaceId kbuffer) {
    std::vector<float> values;
    if (kbuffer == no_surface) return values;
    const std::size_t floats = surfaces.info(kbuffer).program->floats_per_pixel();
    values.reserve(surfaces.places(kbuffer) * floats);
    for_each_place(surfaces, kbuffer, [&](const SurfacePlace& place) {
        const float* entries = surfaces.entries(kbuffer, place);
        values.insert(values.end(), entries, entries + floats);
    });
    return values;
}

void store_entries(SurfaceStore& surfaces, SurfaceId kbuffer, std::span<const float> entries) {
    const std::size_t floats = surfaces.info(kbuffer).program->floats_per_pixel();
    CHECK(entries.size() == surfaces.places(kbuffer) * floats);
    const float* next = entries.data();
    for_each_place(surfaces, kbuffer, [&](const SurfacePlace& place) {
        if (std::memcmp(surfaces.read(kbuffer, place), next, floats * sizeof(float)) != 0)
            std::copy(next, next + floats, surfaces.written_entries(kbuffer, place));
        next += floats;
    });
}

} // namespace pipeline
