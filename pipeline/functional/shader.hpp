// The fragment shader: base colour x vertex colour x texture, lit by a lamp on the camera; alpha test.
//
// Lighting is a two-sided Lambert term with an ambient floor: ambient + (1 - ambient) * |n.z|, n the unit normal in eye
// space. Geometry without normals takes the face normal. Unlit materials skip it. Instead of a colour the shader can
// give the cosine between normal and direction to the eye, for Fresnel terms (specification 004, A12).
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/functional/interpolation.hpp"
#include "pipeline/functional/texture_sampler.hpp"
#include "pipeline/functional/vertex_fetch.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

namespace pipeline {

/// Light that reaches a surface seen edge-on.
inline constexpr float ambient_light = 0.25F;

/// Instructions, texture reads and registers of the shader that `material` needs on `geometry` in a frame with `needs`:
/// what the frame does not need, and what the geometry does not have, costs nothing. The table is in README.md.
ShaderCost shader_cost(const Material& material, const Geometry& geometry, const Needs& needs);

/// What the fragments of a draw are asked for.
struct ShaderOptions {
    bool colours = true;
    bool normals = false;
    bool map_texcoords = false; ///< of the material's maps, where it has some
    FragmentColour fragment_colour = FragmentColour::lit;
    bool perspective = true; ///< the directions to the eye meet there; else they are parallel
    bool textures = true;
    bool alpha_test = true;
    bool sprites = false; ///< texture coordinates come from the rasterizer, not from vertices
};

/// Attributes at a corner of a triangle.
struct ShaderCorner {
    glm::vec3 position{}; ///< eye space; for cosines
    glm::vec3 normal{};   ///< eye space, any length
    glm::vec4 colour{1.0F};
    glm::vec2 texcoord{};      ///< transformed by the material
    glm::vec4 map_texcoords{}; ///< {u, v} of set 0, then of set 1, as the vertex has them
};

/// A primitive part ready for shading.
struct ShaderTriangle {
    std::array<ShaderCorner, 3> corners;
    float face_light = 1.0F; ///< where there are no vertex normals
    glm::vec3 face_normal{}; ///< eye space, of unit length or none; where cosines or normals are wanted
    glm::vec4 tangent{};     ///< see ShaderInput::tangent
};

/// The shader of one instance of one draw.
class FragmentShader {
  public:
    FragmentShader(const Resources& resources, const Geometry& geometry, const Material& material,
                   const glm::mat4& model_to_eye, const ShaderOptions& options, std::uint32_t instance = 0);

    /// True when shade() must be called: a colour or normal is wanted, or fragments may be discarded.
    bool needed() const { return options_.colours || options_.normals || discards_ || gives_texcoords(); }
    /// True when it gives coordinates of maps.
    bool gives_texcoords() const { return map_sets_[0] || map_sets_[1]; }
    /// True when shade() reads the texture.
    bool samples() const { return sampler_.has_value(); }

    /// Attributes of a part of the primitive with these vertices. `weights`: see PrimitivePart; null when not clipped.
    /// `provoking`: the corner whose colour and normal a flat material takes.
    ShaderTriangle triangle(const std::array<std::uint32_t, 3>& vertices, const std::array<glm::vec3, 3>* weights,
                            std::size_t provoking = 2) const;

    struct Output {
        std::array<glm::vec4, 4> colours;     ///< linear RGBA; 0 where not covered
        std::array<glm::vec4, 4> normals{};   ///< eye space, of unit length or 0; 0 where not covered or not asked for
        std::array<glm::vec4, 4> texcoords{}; ///< see ShaderInput::texcoords
        std::uint8_t alive = 0;               ///< covered and not discarded
        std::uint32_t texture_line = ~0U;     ///< of the first covered pixel; ~0 = no texture read
    };
    /// Shades the covered pixels of a quad.
    Output shade(const ShaderTriangle& triangle, const CornerWeights& weights, unsigned covered) const;

  private:
    ShaderCorner corner(std::uint32_t vertex) const;
    glm::vec3 face_normal(const std::array<std::uint32_t, 3>& vertices) const;
    glm::vec4 tangent(const std::array<std::uint32_t, 3>& vertices, const ShaderTriangle& triangle) const;
    std::array<glm::dvec3, 4> normals(const ShaderTriangle& triangle, const CornerWeights& weights) const;
    Lanes cosines(const ShaderTriangle& triangle, const CornerWeights& weights) const;
    Lanes light(const ShaderTriangle& triangle, const CornerWeights& weights) const;
    void texture(const ShaderTriangle& triangle, const CornerWeights& weights, unsigned covered, Output& output) const;
    void colour(const ShaderTriangle& triangle, const CornerWeights& weights, unsigned covered, Output& output) const;
    void discard(Output& output) const;

    ShaderOptions options_;
    AttributeReader positions_;
    std::optional<AttributeReader> normals_, colours_, texcoords_;
    std::array<std::optional<AttributeReader>, 2> map_sets_; ///< texture coordinates 0 and 1, where maps read them
    const MaterialMap* normal_map_ = nullptr;                ///< where its coordinates are given
    std::optional<TextureSampler> sampler_;
    glm::dmat4 model_to_eye_;
    glm::dmat3 normal_matrix_; ///< model to eye space, of unit size
    glm::mat3 texcoord_matrix_;
    glm::vec4 base_colour_;
    float alpha_cutoff_;
    bool discards_; ///< the material is alpha-tested and somebody asks
    bool lit_;
    bool cosine_;
    bool flat_;
    bool keeps_alpha_; ///< the surface blends; others are opaque
};

} // namespace pipeline
