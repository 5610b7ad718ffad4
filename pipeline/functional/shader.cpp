#include "pipeline/functional/shader.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pipeline {

namespace {

// Attributes and factors are kept within these, so that no product of them overflows; real data is far below.
constexpr float largest_colour = 65504.0F;
constexpr float largest_normal = 1e9F;
constexpr float largest_texcoord = 0x1p24F; // has no fraction any more

float bounded(float value, float largest) { return std::isnan(value) ? 0.0F : std::clamp(value, -largest, largest); }

template <class Vector>
Vector bounded_vector(Vector vector, float largest) {
    for (int i = 0; i < Vector::length(); ++i) vector[i] = bounded(vector[i], largest);
    return vector;
}

/// The matrix that takes normals along: cofactors of the upper 3x3, scaled to unit size. Unlike the inverse transpose
/// it exists for singular matrices.
glm::dmat3 normal_matrix(const glm::mat4& model_to_eye) {
    const glm::dmat3 m{glm::dmat4(model_to_eye)};
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    double size = 0.0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) size = std::max(size, std::fabs(cofactors[column][row]));
    return size > 0.0 && std::isfinite(size) ? cofactors / size : glm::dmat3(1.0);
}

std::optional<AttributeReader> reader(const Resources& resources, const Geometry& geometry, bool wanted,
                                      Semantic semantic, std::uint32_t instance) {
    const VertexAttribute* attribute = wanted ? geometry.find(semantic) : nullptr;
    if (attribute == nullptr) return std::nullopt;
    return AttributeReader(resources, *attribute, instance);
}

float lambert(float cosine) { return ambient_light + (1.0F - ambient_light) * cosine; }

} // namespace

FragmentShader::FragmentShader(const Resources& resources, const Geometry& geometry, const Material& material,
                               const glm::mat4& model_to_eye, const ShaderOptions& options, std::uint32_t instance)
    : options_(options),
      positions_(resources, *geometry.find(Semantic::position), instance),
      model_to_eye_(model_to_eye),
      normal_matrix_(normal_matrix(model_to_eye)),
      texcoord_matrix_(material.uv_transform),
      base_colour_(bounded_vector(material.base_colour, largest_colour)),
      alpha_cutoff_(material.alpha_cutoff),
      discards_(options.alpha_test && material.alpha_mode == AlphaMode::mask),
      lit_(options.colours && options.fragment_colour == FragmentColour::lit && !material.unlit),
      cosine_(options.colours && options.fragment_colour == FragmentColour::cosine),
      flat_(material.flat),
      keeps_alpha_(material.transparent()) {
    const bool of_material = options.colours && (options.fragment_colour == FragmentColour::lit ||
                                                 options.fragment_colour == FragmentColour::unlit);
    const bool reads_colour = of_material || discards_;
    normals_ = reader(resources, geometry, lit_ || cosine_ || options.normals, Semantic::normal, instance);
    colours_ = reader(resources, geometry, reads_colour, Semantic::colour, instance);
    const bool textured = options.textures && reads_colour && material.base_texture >= 0;
    texcoords_ = reader(resources, geometry, textured && !options.sprites, texcoord(material.texcoord), instance);
    for (std::uint32_t set = 0; options.map_texcoords && set < map_sets_.size(); ++set)
        map_sets_[set] = reader(resources, geometry, material.maps.read(set), texcoord(set), instance);
    const MaterialMap& normal = material.maps.normal;
    if (options.map_texcoords && normal.there() && map_sets_.at(normal.texcoord)) normal_map_ = &normal;
    if ((texcoords_ || (textured && options.sprites)) && needed())
        sampler_.emplace(resources.textures[static_cast<std::size_t>(material.base_texture)]);
}

ShaderCorner FragmentShader::corner(std::uint32_t vertex) const {
    ShaderCorner result;
    if (cosine_) result.position = glm::vec3(model_to_eye_ * glm::dvec4(glm::vec3(positions_(vertex)), 1.0));
    if (normals_) {
        const glm::dvec3 normal(bounded_vector(glm::vec3((*normals_)(vertex)), largest_normal));
        result.normal = glm::vec3(normal_matrix_ * normal);
    }
    if (colours_) result.colour = bounded_vector((*colours_)(vertex), largest_colour);
    if (texcoords_) {
        const glm::vec4 raw = (*texcoords_)(vertex);
        result.texcoord = bounded_vector(glm::vec2(texcoord_matrix_ * glm::vec3(raw.x, raw.y, 1.0F)), largest_texcoord);
    }
    for (std::size_t set = 0; set < map_sets_.size(); ++set) {
        if (!map_sets_[set]) continue;
        const glm::vec2 raw = bounded_vector(glm::vec2((*map_sets_[set])(vertex)), largest_texcoord);
        result.map_texcoords[static_cast<int>(2 * set)] = raw.x;
        result.map_texcoords[static_cast<int>(2 * set + 1)] = raw.y;
    }
    return result;
}

// Positions are a linear function of texture coordinates over a triangle: P(u, v) = P0 + u T + v V. The bitangent of a
// normal map runs against v, which grows downwards (glTF 2.0, section 3.7.2.1: bitangent = w * cross(normal, tangent)).
glm::vec4 FragmentShader::tangent(const std::array<std::uint32_t, 3>& vertices, const ShaderTriangle& triangle) const {
    std::array<glm::dvec3, 3> at;
    std::array<glm::dvec2, 3> uv;
    glm::dvec3 outside(triangle.face_normal);
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec4& sets = triangle.corners[i].map_texcoords;
        const glm::vec2 raw = normal_map_->texcoord == 0 ? glm::vec2(sets.x, sets.y) : glm::vec2(sets.z, sets.w);
        at[i] = glm::dvec3(model_to_eye_ * glm::dvec4(glm::dvec3(positions_(vertices[i])), 1.0));
        uv[i] = glm::dvec2(normal_map_->uv_transform * glm::vec3(raw, 1.0F));
        if (normals_) outside += glm::dvec3(triangle.corners[i].normal);
    }
    const glm::dvec3 a = at[1] - at[0], b = at[2] - at[0];
    const glm::dvec2 s = uv[1] - uv[0], t = uv[2] - uv[0];
    const double area = s.x * t.y - t.x * s.y;
    const glm::dvec3 along = (a * t.y - b * s.y) * (area < 0.0 ? -1.0 : 1.0);
    const double length = glm::length(along);
    if (area == 0.0 || !(length > 0.0) || !std::isfinite(length)) return glm::vec4(0.0F);
    const bool outwards = glm::dot(outside, glm::cross(a, b)) > 0.0;
    return {glm::vec3(along / length), outwards == (area > 0.0) ? -1.0F : 1.0F};
}

glm::vec3 FragmentShader::face_normal(const std::array<std::uint32_t, 3>& vertices) const {
    const glm::dvec3 a(positions_(vertices[0])), b(positions_(vertices[1])), c(positions_(vertices[2]));
    const glm::dvec3 normal = normal_matrix_ * glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(normal / length) : glm::vec3(0.0F);
}

ShaderTriangle FragmentShader::triangle(const std::array<std::uint32_t, 3>& vertices,
                                        const std::array<glm::vec3, 3>* weights, std::size_t provoking) const {
    ShaderTriangle result;
    for (std::size_t i = 0; i < 3; ++i) result.corners[i] = corner(vertices[i]);
    if (flat_)
        for (ShaderCorner& corner : result.corners) {
            corner.normal = result.corners[provoking].normal;
            corner.colour = result.corners[provoking].colour;
        }
    if ((lit_ || cosine_ || options_.normals) && !normals_) result.face_normal = face_normal(vertices);
    if (lit_ && result.face_normal != glm::vec3(0.0F)) result.face_light = lambert(std::fabs(result.face_normal.z));
    if (normal_map_ != nullptr) result.tangent = tangent(vertices, result);
    if (weights == nullptr) return result;

    const std::array<ShaderCorner, 3> whole = result.corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec3& w = (*weights)[i];
        result.corners[i].position = whole[0].position * w.x + whole[1].position * w.y + whole[2].position * w.z;
        result.corners[i].normal = whole[0].normal * w.x + whole[1].normal * w.y + whole[2].normal * w.z;
        result.corners[i].colour = whole[0].colour * w.x + whole[1].colour * w.y + whole[2].colour * w.z;
        result.corners[i].texcoord = whole[0].texcoord * w.x + whole[1].texcoord * w.y + whole[2].texcoord * w.z;
        result.corners[i].map_texcoords =
            whole[0].map_texcoords * w.x + whole[1].map_texcoords * w.y + whole[2].map_texcoords * w.z;
    }
    return result;
}

// As interpolated, of any length.
std::array<glm::dvec3, 4> FragmentShader::normals(const ShaderTriangle& triangle, const CornerWeights& weights) const {
    std::array<glm::dvec3, 4> result;
    result.fill(glm::dvec3(triangle.face_normal));
    const auto& c = triangle.corners;
    for (int i = 0; normals_ && i < 3; ++i) {
        const Lanes axis = weights.interpolate(c[0].normal[i], c[1].normal[i], c[2].normal[i]);
        for (std::size_t lane = 0; lane < 4; ++lane) result[lane][i] = axis[lane];
    }
    return result;
}

// Normals and directions of no length have the cosine 1: such a surface has no edge to be seen from.
Lanes FragmentShader::cosines(const ShaderTriangle& triangle, const CornerWeights& weights) const {
    const auto& c = triangle.corners;
    Lanes result;
    const std::array<glm::dvec3, 4> normal = normals(triangle, weights);
    std::array<Lanes, 3> position{};
    for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(i);
        if (options_.perspective)
            position[axis] = weights.interpolate(c[0].position[i], c[1].position[i], c[2].position[i]);
        else
            position[axis].fill(i == 2 ? 1.0F : 0.0F);
    }
    for (std::size_t lane = 0; lane < 4; ++lane) {
        const glm::dvec3& n = normal[lane];
        const glm::dvec3 p(position[0][lane], position[1][lane], position[2][lane]);
        const double lengths = glm::length(n) * glm::length(p);
        const double cosine = std::fabs(glm::dot(n, p)) / lengths;
        result[lane] = lengths > 0.0 && std::isfinite(cosine) ? static_cast<float>(std::min(cosine, 1.0)) : 1.0F;
    }
    return result;
}

Lanes FragmentShader::light(const ShaderTriangle& triangle, const CornerWeights& weights) const {
    const auto& c = triangle.corners;
    const Lanes x = weights.interpolate(c[0].normal.x, c[1].normal.x, c[2].normal.x);
    const Lanes y = weights.interpolate(c[0].normal.y, c[1].normal.y, c[2].normal.y);
    const Lanes z = weights.interpolate(c[0].normal.z, c[1].normal.z, c[2].normal.z);
    Lanes result;
    // The addend is lost in the square of any real normal; it keeps one of no length from dividing by zero.
    for (std::size_t i = 0; i < 4; ++i)
        result[i] = std::fabs(z[i]) / std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i] + 1e-30F);
    for (float& value : result) value = lambert(std::min(value, 1.0F));
    return result;
}

void FragmentShader::texture(const ShaderTriangle& triangle, const CornerWeights& weights, unsigned covered,
                             Output& output) const {
    const auto& c = triangle.corners;
    const QuadTexcoords coordinates{weights.interpolate(c[0].texcoord.x, c[1].texcoord.x, c[2].texcoord.x),
                                    weights.interpolate(c[0].texcoord.y, c[1].texcoord.y, c[2].texcoord.y)};
    const TextureFootprint footprint = sampler_->footprint(sampler_->level_of_detail(coordinates));
    std::array<glm::vec4, 4> texels{};
    output.texture_line = sampler_->sample(coordinates, footprint, covered, texels);
    for (std::size_t lane = 0; lane < 4; ++lane) output.colours[lane] *= texels[lane];
}

void FragmentShader::colour(const ShaderTriangle& triangle, const CornerWeights& weights, unsigned covered,
                            Output& output) const {
    output.colours.fill(base_colour_);
    const auto& c = triangle.corners;
    if (colours_)
        for (int channel = 0; channel < 4; ++channel) {
            const auto values = weights.interpolate(c[0].colour[channel], c[1].colour[channel], c[2].colour[channel]);
            for (std::size_t lane = 0; lane < 4; ++lane) output.colours[lane][channel] *= values[lane];
        }
    if (sampler_) texture(triangle, weights, covered, output);
}

void FragmentShader::discard(Output& output) const {
    // glTF 2.0, section 3.9.4: a fragment whose alpha equals the cutoff is drawn.
    for (std::size_t lane = 0; lane < 4; ++lane)
        if (!(output.colours[lane].a >= alpha_cutoff_)) output.alive &= static_cast<std::uint8_t>(~(1U << lane));
}

FragmentShader::Output FragmentShader::shade(const ShaderTriangle& triangle, const CornerWeights& weights,
                                             unsigned covered) const {
    Output output;
    output.alive = static_cast<std::uint8_t>(covered);
    colour(triangle, weights, covered, output);
    if (discards_) discard(output);
    Lanes lights;
    lights.fill(triangle.face_light);
    if (cosine_) {
        output.colours.fill(glm::vec4(1.0F));
        lights = cosines(triangle, weights);
    } else if (lit_ && normals_) {
        lights = light(triangle, weights);
    }
    if (options_.normals) {
        const std::array<glm::dvec3, 4> normal = normals(triangle, weights);
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const double length = glm::length(normal[lane]);
            if ((covered >> lane & 1U) != 0 && length > 0.0 && std::isfinite(length))
                output.normals[lane] = glm::vec4(normal[lane] / length, 0.0);
        }
    }
    if (gives_texcoords()) {
        const auto& c = triangle.corners;
        for (int i = 0; i < 4; ++i) {
            const Lanes values =
                weights.interpolate(c[0].map_texcoords[i], c[1].map_texcoords[i], c[2].map_texcoords[i]);
            for (std::size_t lane = 0; lane < 4; ++lane) output.texcoords[lane][i] = values[lane];
        }
    }
    for (std::size_t lane = 0; lane < 4; ++lane) {
        glm::vec4& colour = output.colours[lane];
        const unsigned bit = 1U << lane;
        const float light = (covered & bit) != 0 ? lights[lane] : 0.0F;
        const float alpha = (covered & bit) == 0 ? 0.0F : keeps_alpha_ ? colour.a : 1.0F;
        colour = glm::vec4(colour.r * light, colour.g * light, colour.b * light, alpha);
    }
    return output;
}

} // namespace pipeline
