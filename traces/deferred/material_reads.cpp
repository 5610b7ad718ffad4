#include "traces/deferred/material_reads.hpp"

#include "pipeline/functional/number_formats.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>

namespace traces {

using pipeline::QuadTexels;
using pipeline::ShaderInput;
using pipeline::SurfaceAccess;

namespace {

constexpr float largest_coordinate = 0x1p24F; // has no fraction any more

float bounded_coordinate(float value) {
    return std::isnan(value) ? 0.0F : std::clamp(value, -largest_coordinate, largest_coordinate);
}

pipeline::SurfaceInfo surface_of_map(const pipeline::Texture& texture, std::int32_t number) {
    pipeline::SurfaceInfo info{.name = fmt::format("map {}", number),
                               .format =
                                   texture.srgb ? pipeline::SurfaceFormat::srgb8a8 : pipeline::SurfaceFormat::rgba8,
                               .width = texture.levels.front().width,
                               .height = texture.levels.front().height,
                               .levels = static_cast<std::uint32_t>(texture.levels.size())};
    std::vector<pipeline::SharedBytes> levels;
    for (const pipeline::Texture::Level& level : texture.levels) {
        const auto bytes = std::as_bytes(std::span(level.rgba));
        levels.emplace_back(std::vector<std::byte>(bytes.begin(), bytes.end()));
    }
    info.contents = pipeline::make_contents(info, levels);
    return info;
}

// A minification filter with levels blends two of them.
pipeline::SurfaceSampler sampler_of(const pipeline::Texture& texture) {
    using pipeline::Filter;
    const bool mips = texture.min_filter != Filter::nearest && texture.min_filter != Filter::linear;
    return {texture.mag_filter != Filter::nearest, mips, texture.wrap_u, texture.wrap_v, texture.border};
}

} // namespace

float phong_power(float roughness) {
    const float alpha = roughness * roughness, squared = alpha * alpha;
    if (!(squared > 0.0F)) return 255.0F;
    return std::clamp(0.25F * (2.0F / squared - 2.0F), 1.0F, 255.0F);
}

glm::vec3 tilted(const glm::vec3& normal, const glm::vec4& tangent, const glm::vec4& texel, float scale) {
    const float centre = pipeline::unorm8_decode_table()[128];
    const glm::vec3 code = glm::max((glm::vec3(texel) - centre) / (1.0F - centre), glm::vec3(-1.0F));
    const float x = code.x * scale, y = code.y * scale;
    if (x == 0.0F && y == 0.0F) return normal;
    glm::vec3 along = glm::vec3(tangent) - normal * glm::dot(normal, glm::vec3(tangent));
    const float length = glm::length(along);
    constexpr float least = 1e-6F; // of what rounding leaves of a tangent along the normal
    if (normal == glm::vec3(0.0F) || !(length > least)) return normal;
    along /= length;
    const glm::vec3 across = glm::cross(normal, along) * tangent.w;
    const glm::vec3 result = along * x + across * y + normal * code.z;
    const float size = glm::length(result);
    return size > 0.0F && std::isfinite(size) ? result / size : normal;
}

MaterialReads::MaterialReads(const pipeline::Frame& frame, const CommonShine& common, bool maps)
    : common_(common), draws_(frame.draws.size()) {
    for (std::size_t i = 0; maps && i < draws_.size(); ++i) {
        const pipeline::Draw& draw = frame.draws[i];
        const pipeline::Material& material = frame.resources->materials[draw.material];
        const pipeline::Geometry& geometry = frame.resources->geometries[draw.geometry];
        const pipeline::MaterialMaps& of = material.maps;
        const std::uint32_t before = without_coordinates_;
        OfDraw& one = draws_[i];
        one.normal = use(frame, geometry, of.normal);
        one.mirrored = glm::determinant(glm::mat3(draw.instances.front())) < 0.0F;
        one.shines = of.shines();
        if (one.shines) {
            one.roughness = use(frame, geometry, of.roughness);
            one.specular = use(frame, geometry, of.specular);
        }
        if (of.glows()) one.emissive = use(frame, geometry, of.emissive);
        without_coordinates_ = std::min(without_coordinates_, before + 1);
        one.normal_scale = of.normal_scale;
        one.metallic = of.metallic_factor;
        one.roughness_factor = of.roughness_factor;
        one.specular_factor = of.specular_factor;
        one.emission = of.emissive_factor;
        glows_ = glows_ || of.glows();
    }
}

MaterialReads::Map MaterialReads::use(const pipeline::Frame& frame, const pipeline::Geometry& geometry,
                                      const pipeline::MaterialMap& map) {
    if (!map.there()) return {};
    if (geometry.find(pipeline::texcoord(map.texcoord)) == nullptr) {
        ++without_coordinates_;
        return {};
    }
    const pipeline::Texture& texture = frame.resources->read_map(static_cast<std::uint32_t>(map.texture));
    const auto known = std::find(textures_.begin(), textures_.end(), map.texture);
    const auto slot = static_cast<std::uint32_t>(known - textures_.begin());
    if (known == textures_.end()) {
        textures_.push_back(map.texture);
        surfaces_.push_back(surface_of_map(texture, map.texture));
    }
    return {true, slot, sampler_of(texture), map.texcoord, map.uv_transform};
}

QuadTexels MaterialReads::sample(const Map& map, const ShaderInput& input, SurfaceAccess& surfaces,
                                 std::uint32_t first_slot) {
    if (map.transform != glm::mat3(1.0F)) surfaces.issue(2, input.pixels);
    pipeline::Lanes u{}, v{};
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::vec4& sets = input.texcoords[i];
        const glm::vec3 at =
            map.transform * (map.set == 0 ? glm::vec3(sets.x, sets.y, 1.0F) : glm::vec3(sets.z, sets.w, 1.0F));
        u[i] = bounded_coordinate(at.x);
        v[i] = bounded_coordinate(at.y);
    }
    return surfaces.sample(first_slot + map.slot, map.sampler, u, v, input.pixels);
}

glm::vec2 MaterialReads::reflected(const OfDraw& draw, float roughness, float metalness, float strength) const {
    const float metal = draw.metallic * metalness;
    const float dielectric = common_.specular * (draw.specular_factor * strength);
    return {dielectric + (1.0F - dielectric) * metal, phong_power(draw.roughness_factor * roughness)};
}

MaterialReads::Quad MaterialReads::read(const ShaderInput& input, SurfaceAccess& surfaces, std::uint32_t first_slot,
                                        unsigned parts) const {
    const OfDraw& draw = draws_[input.draw];
    Quad quad;
    quad.normals = input.normal;
    quad.shine.fill({common_.specular, common_.power});
    if ((parts & normals) != 0 && draw.normal.there) {
        const QuadTexels texels = sample(draw.normal, input, surfaces, first_slot);
        // Decode and scale 2; dot, multiply-add, to unit length 3; cross product 2 and its sign; sum 3, to unit
        // length 3.
        surfaces.issue(2 + 5 + 3 + 6, input.pixels);
        const float side = draw.mirrored ? -1.0F : 1.0F;
        const glm::vec4 tangent(glm::vec3(input.tangent), input.tangent.w * side);
        for (std::size_t i = 0; i < 4; ++i)
            quad.normals[i] = glm::vec4(
                side * tilted(side * glm::vec3(input.normal[i]), tangent, texels[i], draw.normal_scale), 0.0F);
    }
    if ((parts & shine) != 0 && draw.shines) {
        QuadTexels rough, strong;
        rough.fill(glm::vec4(1.0F));
        strong = rough;
        if (draw.roughness.there) {
            rough = sample(draw.roughness, input, surfaces, first_slot);
            // Factors 2, two squares, reciprocal, multiply-add, clamp; share of metal.
            surfaces.issue(2 + 2 + 1 + 1 + 1 + 1, input.pixels);
        }
        if (draw.specular.there) {
            strong = sample(draw.specular, input, surfaces, first_slot);
            surfaces.issue(draw.roughness.there ? 1 : 2, input.pixels); // factor; share of metal
        }
        for (std::size_t i = 0; i < 4; ++i) quad.shine[i] = reflected(draw, rough[i].g, rough[i].b, strong[i].a);
    }
    if ((parts & emission) != 0 && draw.emission != glm::vec3(0.0F)) {
        quad.emission.fill(draw.emission);
        if (draw.emissive.there) {
            const QuadTexels texels = sample(draw.emissive, input, surfaces, first_slot);
            surfaces.issue(1, input.pixels);
            for (std::size_t i = 0; i < 4; ++i) quad.emission[i] *= glm::vec3(texels[i]);
        }
    }
    return quad;
}

} // namespace traces
