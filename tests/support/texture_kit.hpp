// One surface, read as a texture through a sampler.
#pragma once

#include "pipeline/functional/quad_sampler.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <functional>
#include <span>
#include <vector>

namespace tests {

inline pipeline::Lanes all_lanes(float value) { return {value, value, value, value}; }

/// All lanes at one place of the finest level.
inline pipeline::TextureLookup lookup_at(const std::array<float, 4>& place) {
    pipeline::TextureLookup lookup;
    for (std::size_t i = 0; i < 4; ++i) lookup.place[i] = all_lanes(place[i]);
    lookup.level = pipeline::LevelOfDetail::given;
    return lookup;
}

/// A surface whose texels hold numbers in red: value(level, plane, x, y).
inline pipeline::SurfaceInfo
number_surface(pipeline::SurfaceInfo info,
               const std::function<float(std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t)>& value) {
    info.format = pipeline::SurfaceFormat::r32f;
    std::vector<std::vector<std::byte>> levels(info.levels);
    for (std::uint32_t level = 0; level < info.levels; ++level)
        for (std::uint32_t plane = 0; plane < info.planes_of(level); ++plane)
            for (std::uint32_t y = 0; y < info.height_of(level); ++y)
                for (std::uint32_t x = 0; x < info.width_of(level); ++x) {
                    const auto bytes = std::bit_cast<std::array<std::byte, 4>>(value(level, plane, x, y));
                    levels[level].insert(levels[level].end(), bytes.begin(), bytes.end());
                }
    info.contents = pipeline::make_contents(info, {levels.begin(), levels.end()});
    return info;
}

/// A surface of one level whose bytes are those of `texels`.
template <class Texel>
pipeline::SurfaceInfo byte_surface(pipeline::SurfaceInfo info, const std::vector<Texel>& texels) {
    std::vector<std::byte> bytes(texels.size() * sizeof(Texel));
    std::memcpy(bytes.data(), texels.data(), bytes.size());
    info.contents = pipeline::make_contents(info, {bytes});
    return info;
}

struct TextureKit {
    explicit TextureKit(const pipeline::SurfaceInfo& info, pipeline::TextureKind kind = pipeline::TextureKind::plane)
        : store(std::span(&info, 1)) {
        view.kind = kind;
        sampler.min_filter = sampler.mag_filter = pipeline::Filter::nearest;
    }

    pipeline::QuadTexels sample(const pipeline::TextureLookup& lookup) {
        pipeline::SurfaceAccess access(store, slots, &work);
        return pipeline::QuadSampler(access, view, sampler).sample(lookup);
    }
    /// Red of lane 0.
    float at(const std::array<float, 4>& place) { return sample(lookup_at(place))[0].r; }
    pipeline::QuadTexels fetch(const pipeline::TexelLookup& lookup) {
        pipeline::SurfaceAccess access(store, slots, &work);
        return pipeline::QuadSampler(access, view, sampler).fetch(lookup);
    }
    template <class Ask>
    auto ask(Ask question) {
        pipeline::SurfaceAccess access(store, slots);
        const pipeline::QuadSampler quads(access, view, sampler);
        return question(quads);
    }

    pipeline::SurfaceStore store;
    pipeline::TextureView view;
    pipeline::SamplerState sampler;
    pipeline::QuadWork work;
    std::array<pipeline::SurfaceId, 1> slots{0};
};

} // namespace tests
