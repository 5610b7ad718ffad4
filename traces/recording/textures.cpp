#include "traces/recording/textures.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

namespace traces {

namespace {

using pipeline::TextureKind;
using spirv::ImageDimension;

TextureKind texture_kind(ImageDimension dimension) {
    switch (dimension) {
    case ImageDimension::d1:
        return TextureKind::line;
    case ImageDimension::d2:
        return TextureKind::plane;
    case ImageDimension::d3:
        return TextureKind::volume;
    case ImageDimension::cube:
        return TextureKind::cube;
    case ImageDimension::rectangle:
        return TextureKind::rectangle;
    case ImageDimension::buffer:
        break;
    }
    return TextureKind::buffer;
}

/// By lane to by component.
spirv::Texels by_component(const pipeline::QuadTexels& quad) {
    spirv::Texels texels{};
    for (std::size_t lane = 0; lane < 4; ++lane)
        for (std::size_t i = 0; i < 4; ++i) texels[i][lane] = quad[lane][static_cast<int>(i)];
    return texels;
}

std::uint32_t planes_in(const RecordedSurface& surface) {
    switch (surface.kind) {
    case SurfaceKind::cube:
        return 6;
    case SurfaceKind::layers:
    case SurfaceKind::volume:
        return surface.depth;
    case SurfaceKind::plane:
    case SurfaceKind::buffer:
        break;
    }
    return surface.samples;
}

} // namespace

pipeline::SurfaceInfo surface_of(const RecordedSurface& surface) {
    using pipeline::SurfaceShape;
    pipeline::SurfaceInfo info{.name = surface.name,
                               .format = surface.format,
                               .width = surface.width,
                               .height = surface.height,
                               .planes = planes_in(surface),
                               .levels = static_cast<std::uint32_t>(surface.levels.size())};
    info.shape = surface.kind == SurfaceKind::volume   ? SurfaceShape::volume
                 : surface.kind == SurfaceKind::buffer ? SurfaceShape::row
                                                       : SurfaceShape::planes;
    const bool blank =
        std::all_of(surface.levels.begin(), surface.levels.end(), [](const auto& level) { return level.empty(); });
    if (!blank) info.contents = pipeline::make_contents(info, surface.levels);
    return info;
}

TextureTable::TextureTable(const spirv::Program& program, std::span<const TextureBinding> bindings,
                           std::span<const RecordedSampler> samplers, std::span<const std::uint32_t> slots,
                           std::span<const std::vector<pipeline::TexturePart>> parts) {
    CHECK(slots.size() == bindings.size() && (parts.empty() || parts.size() == bindings.size()));
    for (const spirv::TextureVariable& variable : program.textures) {
        std::vector<Entry>& elements = entries_.emplace_back(variable.elements);
        for (std::size_t i = 0; i < bindings.size(); ++i) {
            const TextureBinding& binding = bindings[i];
            if (binding.variable != variable.name || binding.element >= variable.elements) continue;
            CHECK(binding.sampler < samplers.size());
            const spirv::ImageType& image = variable.image;
            Entry& entry = elements[binding.element];
            entry.bound = !(image.multisampled && image.arrayed);
            entry.sampler = samplers[binding.sampler];
            entry.view = {slots[i],           texture_kind(image.dimension),
                          image.arrayed,      image.multisampled,
                          binding.base_level, binding.last_level,
                          binding.swizzle,    parts.empty() ? std::vector<pipeline::TexturePart>() : parts[i]};
        }
        for (std::size_t element = 0; element < elements.size(); ++element)
            if (!elements[element].bound)
                unbound_.push_back(elements.size() == 1 ? variable.name
                                                        : fmt::format("{}[{}]", variable.name, element));
    }
}

spirv::Texels BoundTextures::unbound(const spirv::ImageType& image) {
    ++unbound_reads_;
    spirv::Texels texels{};
    texels[3].fill(image.texel == spirv::Kind::real ? 1.0F : std::bit_cast<float>(1U));
    return texels;
}

spirv::Texels BoundTextures::sample(const spirv::TextureSample& call) {
    const TextureTable::Entry& texture = table_.at(call.texture, call.element);
    if (!texture.bound) return unbound(*call.image);
    const TextureTable::Entry& sampler = table_.at(call.sampler, call.sampler_element);
    return by_component(pipeline::QuadSampler(surfaces_, texture.view, sampler.sampler).sample(call));
}

spirv::Texels BoundTextures::fetch(const spirv::TextureFetch& call) {
    const TextureTable::Entry& texture = table_.at(call.texture, call.element);
    if (!texture.bound) return unbound(*call.image);
    return by_component(pipeline::QuadSampler(surfaces_, texture.view, texture.sampler).fetch(call));
}

spirv::TextureSize BoundTextures::size(std::uint32_t texture, std::uint32_t element, std::int32_t level) {
    const TextureTable::Entry& entry = table_.at(texture, element);
    if (!entry.bound) return {};
    return pipeline::QuadSampler(surfaces_, entry.view, entry.sampler).size(level);
}

std::int32_t BoundTextures::levels(std::uint32_t texture, std::uint32_t element) {
    const TextureTable::Entry& entry = table_.at(texture, element);
    return entry.bound ? pipeline::QuadSampler(surfaces_, entry.view, entry.sampler).levels() : 0;
}

std::int32_t BoundTextures::samples(std::uint32_t texture, std::uint32_t element) {
    const TextureTable::Entry& entry = table_.at(texture, element);
    return entry.bound ? pipeline::QuadSampler(surfaces_, entry.view, entry.sampler).samples() : 0;
}

spirv::Texels BoundTextures::level(const spirv::TextureSample& call) {
    const TextureTable::Entry& texture = table_.at(call.texture, call.element);
    if (!texture.bound) return {};
    const TextureTable::Entry& sampler = table_.at(call.sampler, call.sampler_element);
    const auto levels = pipeline::QuadSampler(surfaces_, texture.view, sampler.sampler).levels(call);
    spirv::Texels result{};
    for (std::size_t lane = 0; lane < 4; ++lane) {
        result[0][lane] = levels[lane].x;
        result[1][lane] = levels[lane].y;
    }
    return result;
}

} // namespace traces
