// What deferred shading reads of materials beside their colour: normals, how they reflect, light that they send out.
//
// Maps are surfaces of the frame, so that what a quad reads is fetched where it lies, and recorded by the code that
// uses it. Only maps that a draw's material has, and has coordinates for, become surfaces; factors alone are constants.
//
// Normal: glTF 2.0, section 3.9.3, but that code 128 of 8 is exactly 0 (as authors mean it) and not 1/255; about the
// interpolated normal and the tangent of the triangle, made orthogonal to it. Tangents follow from derivatives of
// position and coordinates in the quad; those of files are not read, and none is averaged over triangles.
// Power: 1 to 255, from roughness r: alpha = r^2; Blinn-Phong has 2 / alpha^2 - 2 (Karis 2013, "Specular BRDF
// Reference", after Walter et al. 2007), and Phong's lobe a quarter of it (Fisher and Woo 1994, "R.E versus N.H
// specular highlights": half the angle). Intensity: what the workload says of all surfaces, times the strength of
// KHR_materials_specular; a metal's is 1. Highlights are white and diffuse light has the base colour of metals, too:
// the model (equation 2.1) has no metals, which would be black in it. A material that states nothing of how it reflects
// has the workload's intensity and power.
#pragma once

#include "pipeline/frame.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace traces {

/// Of surfaces whose materials state nothing.
struct CommonShine {
    float specular = 0.3F;
    float power = 32.0F; ///< 0 to 255
};

float phong_power(float roughness);

/// The normal that a normal map gives. `tangent` as in pipeline::ShaderInput; the same space as the normal.
glm::vec3 tilted(const glm::vec3& normal, const glm::vec4& tangent, const glm::vec4& texel, float scale);

class MaterialReads {
  public:
    /// What is asked for, as bits.
    static constexpr unsigned normals = 1, shine = 2, emission = 4;

    /// `maps`: false: all materials state nothing. Makes the texels of what is read, which throws what
    /// pipeline::Resources::read_map() throws.
    MaterialReads(const pipeline::Frame& frame, const CommonShine& common, bool maps);

    struct Quad {
        pipeline::QuadTexels normals{};   ///< in the space of the input's
        std::array<glm::vec2, 4> shine{}; ///< intensity, and power of 0 to 255
        std::array<glm::vec3, 4> emission{};
    };
    /// The shader knows surfaces() from `first_slot` on. Parts that are not asked for are as if nothing were stated.
    Quad read(const pipeline::ShaderInput& input, pipeline::SurfaceAccess& surfaces, std::uint32_t first_slot,
              unsigned parts) const;

    const std::vector<pipeline::SurfaceInfo>& surfaces() const { return surfaces_; }
    std::uint32_t count() const { return static_cast<std::uint32_t>(surfaces_.size()); }
    bool any() const { return !surfaces_.empty(); }
    /// Something of this draw is not as if its material stated nothing.
    bool stated(std::uint32_t draw) const {
        const OfDraw& of = draws_[draw];
        return of.normal.there || of.shines || of.emission != glm::vec3(0.0F);
    }
    bool tilts(std::uint32_t draw) const { return draws_[draw].normal.there; }
    /// Some draw sends out light.
    bool glows() const { return glows_; }
    /// Draws whose material has a map, and whose geometry lacks the coordinates for it.
    std::uint32_t without_coordinates() const { return without_coordinates_; }

  private:
    struct Map {
        bool there = false;
        std::uint32_t slot = 0; ///< index into surfaces_
        pipeline::SurfaceSampler sampler;
        std::uint32_t set = 0;
        glm::mat3 transform{1.0F};
    };
    struct OfDraw {
        Map normal, roughness, specular, emissive;
        float normal_scale = 1.0F;
        float metallic = 1.0F, roughness_factor = 1.0F, specular_factor = 1.0F;
        bool shines = false;
        bool mirrored = false; ///< its normals point inwards; see DeferredDraw
        glm::vec3 emission{0.0F};
    };

    Map use(const pipeline::Frame& frame, const pipeline::Geometry& geometry, const pipeline::MaterialMap& map);
    glm::vec2 reflected(const OfDraw& draw, float roughness, float metalness, float strength) const;
    static pipeline::QuadTexels sample(const Map& map, const pipeline::ShaderInput& input,
                                       pipeline::SurfaceAccess& surfaces, std::uint32_t first_slot);

    CommonShine common_;
    std::vector<OfDraw> draws_;
    std::vector<pipeline::SurfaceInfo> surfaces_;
    std::vector<std::int32_t> textures_; ///< parallel to surfaces_: index into Resources::maps
    bool glows_ = false;
    std::uint32_t without_coordinates_ = 0;
};

} // namespace traces
