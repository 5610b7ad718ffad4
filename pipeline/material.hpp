// What a surface is made of: colour and opacity, and what shaders may ask for beside them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace pipeline {

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// A texture that a material has beside that of its colour.
struct MaterialMap {
    std::int32_t texture = -1;    ///< index into Resources::maps, -1 = none
    std::uint8_t texcoord = 0;    ///< which set of texture coordinates, 0 or 1
    glm::mat3 uv_transform{1.0F}; ///< KHR_texture_transform

    bool there() const { return texture >= 0; }
    bool operator==(const MaterialMap&) const = default;
};

/// Of a material, beside its colour; linear. Defaults are glTF's, at which nothing is stated.
/// Source: glTF 2.0, sections 3.9.2 and 3.9.3; KHR_materials_specular.
struct MaterialMaps {
    MaterialMap normal;    ///< x, y and z in tangent space: red, green and blue
    MaterialMap roughness; ///< green: roughness; blue: metalness
    MaterialMap specular;  ///< alpha: strength of reflection, metals aside
    MaterialMap emissive;  ///< light that it sends out, sRGB-encoded
    float normal_scale = 1.0F;
    float metallic_factor = 1.0F, roughness_factor = 1.0F, specular_factor = 1.0F; ///< 0 to 1
    glm::vec3 emissive_factor{0.0F};                                               ///< 0 to 1

    std::array<const MaterialMap*, 4> all() const { return {&normal, &roughness, &specular, &emissive}; }
    /// Something is said about how it reflects.
    bool shines() const {
        return roughness.there() || specular.there() || metallic_factor != 1.0F || roughness_factor != 1.0F ||
               specular_factor != 1.0F;
    }
    bool glows() const { return emissive_factor != glm::vec3(0.0F); }
    /// Whether a map reads this set of texture coordinates.
    bool read(std::uint32_t texcoord_set) const {
        for (const MaterialMap* map : all())
            if (map->there() && map->texcoord == texcoord_set) return true;
        return false;
    }
    bool operator==(const MaterialMaps&) const = default;
};

struct Material {
    std::string name;
    glm::vec4 base_colour{1.0F};    ///< linear RGBA factor
    std::int32_t base_texture = -1; ///< index into Resources::textures, -1 = none
    std::uint8_t texcoord = 0;      ///< which set of texture coordinates, 0 to 7
    glm::mat3 uv_transform{1.0F};   ///< KHR_texture_transform
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5F;
    bool double_sided = false;
    float transmission = 0.0F; ///< > 0: drawn as transparent
    bool unlit = false;
    bool flat = false; ///< colour and normal are those of the provoking vertex
    MaterialMaps maps{};

    bool transparent() const { return alpha_mode == AlphaMode::blend || transmission > 0.0F; }
};

} // namespace pipeline
