// Old built-in uniforms (OpenGL Shading Language 1.20, section 7.5).
#include "traces/recording/import/fixed_state.hpp"

#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_inverse.hpp>

namespace traces::recorded {

namespace {

class Values {
  public:
    void add(std::string name, float value) {
        list_.push_back({std::move(name), {std::bit_cast<std::uint32_t>(value)}});
    }
    template <glm::length_t n>
    void add(std::string name, const glm::vec<n, float>& vector) {
        UniformValue& value = list_.emplace_back(UniformValue{std::move(name), {}});
        append(value, vector);
    }
    template <glm::length_t n>
    void add(std::string name, const glm::mat<n, n, float>& matrix) {
        UniformValue& value = list_.emplace_back(UniformValue{std::move(name), {}});
        for (glm::length_t column = 0; column < n; ++column) append(value, matrix[column]);
    }
    /// With its inverse, and both transposed.
    void add_matrices(const std::string& name, const std::string& index, const glm::mat4& matrix) {
        const glm::mat4 inverse = glm::inverse(matrix);
        add(name + index, matrix);
        add(name + "Inverse" + index, inverse);
        add(name + "Transpose" + index, glm::transpose(matrix));
        add(name + "InverseTranspose" + index, glm::transpose(inverse));
    }
    /// An array: its elements' words, one after the other.
    template <glm::length_t n>
    void add(std::string name, const std::vector<glm::vec<n, float>>& vectors) {
        UniformValue& value = list_.emplace_back(UniformValue{std::move(name), {}});
        for (const auto& vector : vectors) append(value, vector);
    }
    void add(std::string name, const std::vector<glm::mat4>& matrices) {
        UniformValue& value = list_.emplace_back(UniformValue{std::move(name), {}});
        for (const glm::mat4& matrix : matrices)
            for (int column = 0; column < 4; ++column) append(value, matrix[column]);
    }
    std::vector<UniformValue> take() { return std::move(list_); }

  private:
    template <glm::length_t n>
    static void append(UniformValue& value, const glm::vec<n, float>& vector) {
        for (glm::length_t i = 0; i < n; ++i) value.words.push_back(std::bit_cast<std::uint32_t>(vector[i]));
    }

    std::vector<UniformValue> list_;
};

void add_light(Values& values, std::size_t number, const FixedLight& light) {
    const std::string name = fmt::format("gl_LightSource[{}].", number);
    const float degrees = light.spot_cutoff * (3.14159265F / 180.0F);
    values.add(name + "ambient", light.ambient);
    values.add(name + "diffuse", light.diffuse);
    values.add(name + "specular", light.specular);
    values.add(name + "position", light.position);
    const glm::vec3 towards = glm::normalize(glm::vec3(light.position));
    values.add(name + "halfVector", glm::vec4(glm::normalize(towards + glm::vec3(0.0F, 0.0F, 1.0F)), 0.0F));
    values.add(name + "spotDirection", light.spot_direction);
    values.add(name + "spotExponent", light.spot_exponent);
    values.add(name + "spotCutoff", light.spot_cutoff);
    values.add(name + "spotCosCutoff", std::cos(degrees));
    values.add(name + "constantAttenuation", light.attenuation.x);
    values.add(name + "linearAttenuation", light.attenuation.y);
    values.add(name + "quadraticAttenuation", light.attenuation.z);
}

void add_material(Values& values, const std::string& face, const FixedMaterial& material,
                  const FixedLighting& lighting) {
    const std::string name = fmt::format("gl_{}Material.", face);
    values.add(name + "ambient", material.ambient);
    values.add(name + "diffuse", material.diffuse);
    values.add(name + "specular", material.specular);
    values.add(name + "emission", material.emission);
    values.add(name + "shininess", material.shininess);
    values.add(fmt::format("gl_{}LightModelProduct.sceneColor", face),
               material.emission + material.ambient * lighting.ambient);
    for (std::size_t i = 0; i < lighting.lights.size(); ++i) {
        const std::string product = fmt::format("gl_{}LightProduct[{}].", face, i);
        values.add(product + "ambient", material.ambient * lighting.lights.at(i).ambient);
        values.add(product + "diffuse", material.diffuse * lighting.lights.at(i).diffuse);
        values.add(product + "specular", material.specular * lighting.lights.at(i).specular);
    }
}

void add_units(Values& values, const FixedFunctionState& state) {
    std::vector<glm::mat4> matrices, inverses, transposed, inverse_transposed;
    std::vector<glm::vec4> colours;
    for (const FixedTextureUnit& unit : state.units) {
        matrices.push_back(unit.matrix);
        inverses.push_back(glm::inverse(unit.matrix));
        transposed.push_back(glm::transpose(unit.matrix));
        inverse_transposed.push_back(glm::transpose(inverses.back()));
        colours.push_back(unit.constant);
    }
    values.add("gl_TextureMatrix", matrices);
    values.add("gl_TextureMatrixInverse", inverses);
    values.add("gl_TextureMatrixTranspose", transposed);
    values.add("gl_TextureMatrixInverseTranspose", inverse_transposed);
    values.add("gl_TextureEnvColor", colours);
    constexpr std::array letters{'S', 'T', 'R', 'Q'};
    for (std::size_t i = 0; i < letters.size(); ++i) {
        std::vector<glm::vec4> object, eye;
        for (const FixedTextureUnit& unit : state.units) {
            object.push_back(unit.object_planes.at(i));
            eye.push_back(unit.eye_planes.at(i));
        }
        values.add(fmt::format("gl_ObjectPlane{}", letters.at(i)), object);
        values.add(fmt::format("gl_EyePlane{}", letters.at(i)), eye);
    }
}

} // namespace

std::vector<UniformValue> built_in_uniforms(const record_stream::FixedFunction& fixed,
                                            const record_stream::State& state) {
    // Points are asked for, so that their parameters are read, too.
    const FixedFunctionState all = fixed_function_state_of(fixed, state, {}, GL_POINTS);
    Values values;
    values.add_matrices("gl_ModelViewMatrix", "", all.model_view);
    values.add_matrices("gl_ProjectionMatrix", "", all.projection);
    values.add_matrices("gl_ModelViewProjectionMatrix", "", all.projection * all.model_view);
    const glm::mat3 upper(all.model_view);
    values.add("gl_NormalMatrix", glm::inverseTranspose(upper));
    const glm::vec3 third = glm::inverse(all.model_view)[2];
    values.add("gl_NormalScale", 1.0F / glm::length(third));
    for (std::size_t i = 0; i < all.lighting.lights.size(); ++i) add_light(values, i, all.lighting.lights.at(i));
    values.add("gl_LightModel.ambient", all.lighting.ambient);
    add_material(values, "Front", all.lighting.materials[0], all.lighting);
    add_material(values, "Back", all.lighting.materials[1], all.lighting);
    add_units(values, all);
    values.add("gl_Fog.color",
               fixed_vector(fixed.values, record_stream::place_of(record_stream::fixed_names, GL_FOG_COLOR)));
    const auto start = static_cast<float>(fixed_value(fixed, GL_FOG_START)),
               end = static_cast<float>(fixed_value(fixed, GL_FOG_END));
    values.add("gl_Fog.density", static_cast<float>(fixed_value(fixed, GL_FOG_DENSITY)));
    values.add("gl_Fog.start", start);
    values.add("gl_Fog.end", end);
    values.add("gl_Fog.scale", 1.0F / (end - start));
    values.add("gl_Point.size", all.points.size);
    values.add("gl_Point.sizeMin", all.points.least);
    values.add("gl_Point.sizeMax", all.points.most);
    values.add("gl_Point.fadeThresholdSize", all.points.fade_threshold);
    values.add("gl_Point.distanceConstantAttenuation", all.points.attenuation.x);
    values.add("gl_Point.distanceLinearAttenuation", all.points.attenuation.y);
    values.add("gl_Point.distanceQuadraticAttenuation", all.points.attenuation.z);
    values.add("gl_ClipPlane", std::vector<glm::vec4>(all.clip_plane.begin(), all.clip_plane.end()));
    const auto near = static_cast<float>(value_in(state, GL_DEPTH_RANGE, 0)),
               far = static_cast<float>(value_in(state, GL_DEPTH_RANGE, 1));
    values.add("gl_DepthRange.near", near);
    values.add("gl_DepthRange.far", far);
    values.add("gl_DepthRange.diff", far - near);
    return values.take();
}

} // namespace traces::recorded
