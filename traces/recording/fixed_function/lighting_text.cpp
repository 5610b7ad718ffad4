#include "traces/recording/fixed_function/lighting_text.hpp"

#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

namespace traces::fixed_function {

namespace {

glm::vec3 direction_of(const glm::vec3& vector) {
    const float length = glm::length(vector);
    return length > 0.0F ? vector / length : vector;
}

class SideLighting {
  public:
    SideLighting(const FixedFunctionState& state, bool front, const EyeSpace& eye, ShaderText& text)
        : lighting_(state.lighting),
          material_(lighting_.materials[front ? 0 : 1]),
          tracked_(lighting_.colour_material[front ? 0 : 1]),
          side_(front ? "front" : "back"),
          eye_(eye),
          text_(text) {}

    void write() {
        const std::string scene = scene_colour();
        const std::string alpha = tracks(ColourMaterial::diffuse)
                                      ? text_.input("vec4", "colour") + ".a"
                                      : text_.uniform(side_ + "_alpha", material_.diffuse.a);
        const std::string lit = text_.local("vec4", "lit_" + side_, fmt::format("vec4({}, {})", scene, alpha));
        if (lighting_.separate_specular) text_.local("vec3", "shine_" + side_, "vec3(0.0)");
        std::uint32_t number = 0; // counts those that shine, so that it does not matter which do
        for (const FixedLight& light : lighting_.lights)
            if (light.enabled) add(light, number++, lit);
    }

  private:
    bool tracks(ColourMaterial colour) const {
        return tracked_ == colour || (tracked_ == ColourMaterial::ambient_and_diffuse &&
                                      (colour == ColourMaterial::ambient || colour == ColourMaterial::diffuse));
    }

    /// Emission, and what the scene's ambient light gives.
    std::string scene_colour() {
        const glm::vec3 ambient(lighting_.ambient), emission(material_.emission);
        const glm::vec3 reflected = glm::vec3(material_.ambient) * ambient;
        const std::string name = side_ + "_scene";
        if (tracks(ColourMaterial::emission)) {
            const std::string colour = text_.input("vec4", "colour");
            return fmt::format("{}.rgb + {}", colour, text_.uniform(name, reflected));
        }
        if (!tracks(ColourMaterial::ambient)) return text_.uniform(name, emission + reflected);
        const std::string colour = text_.input("vec4", "colour");
        const std::string light = text_.uniform("scene_ambient", ambient);
        return fmt::format("{}.rgb * {} + {}", colour, light, text_.uniform(name, emission));
    }

    /// A light's colour times the material's; one uniform, unless the vertex's colour is the material's.
    std::string product(ColourMaterial which, const glm::vec4& light, const glm::vec4& material,
                        const std::string& name) {
        if (!tracks(which)) return text_.uniform(side_ + "_" + name, glm::vec3(light) * glm::vec3(material));
        const std::string colour = text_.input("vec4", "colour");
        return fmt::format("{} * {}.rgb", text_.uniform(name, glm::vec3(light)), colour);
    }

    std::string towards(const FixedLight& light, const std::string& name);
    std::string half_vector(const FixedLight& light, const std::string& name, const std::string& direction);
    std::string strength(const FixedLight& light, const std::string& name, const std::string& direction);
    void add(const FixedLight& light, std::uint32_t number, const std::string& lit);

    const FixedLighting& lighting_;
    const FixedMaterial& material_;
    ColourMaterial tracked_;
    std::string side_;
    const EyeSpace& eye_;
    ShaderText& text_;
};

/// The direction to the light, a unit vector; for lights at a place its length before is left in NAME_distance.
std::string SideLighting::towards(const FixedLight& light, const std::string& name) {
    const glm::vec3 position(light.position);
    if (light.position.w == 0.0F) return text_.uniform(name + "_direction", direction_of(position));
    const std::string eye = eye_.position();
    const std::string place = text_.uniform(name + "_position", position / light.position.w);
    const std::string offset = text_.local("vec3", name + "_offset", fmt::format("{} - {}.xyz", place, eye));
    const std::string distance = text_.local("float", name + "_distance", fmt::format("length({})", offset));
    return text_.local("vec3", name + "_towards", fmt::format("{} / {}", offset, distance));
}

std::string SideLighting::half_vector(const FixedLight& light, const std::string& name, const std::string& direction) {
    const std::string half = name + "_half_vector";
    if (lighting_.local_viewer) {
        const std::string eye = eye_.position();
        const std::string view = text_.local("vec3", "view_direction", fmt::format("normalize({}.xyz)", eye));
        return text_.local("vec3", half, fmt::format("normalize({} - {})", direction, view));
    }
    constexpr glm::vec3 to_viewer(0.0F, 0.0F, 1.0F);
    if (light.position.w == 0.0F)
        return text_.uniform(half, direction_of(direction_of(glm::vec3(light.position)) + to_viewer));
    return text_.local("vec3", half, fmt::format("normalize({} + vec3(0.0, 0.0, 1.0))", direction));
}

/// Attenuation and cone; "" when there is neither.
std::string SideLighting::strength(const FixedLight& light, const std::string& name, const std::string& direction) {
    std::string factors;
    if (light.position.w != 0.0F && light.attenuation != glm::vec3(1.0F, 0.0F, 0.0F))
        factors = fmt::format("1.0 / ({0}.x + {1} * ({0}.y + {1} * {0}.z))",
                              text_.uniform(name + "_attenuation", light.attenuation), name + "_distance");
    if (light.spot_cutoff != 180.0F) {
        const std::string axis = text_.uniform(name + "_axis", direction_of(light.spot_direction));
        const std::string cosine = text_.local("float", name + "_cosine", fmt::format("dot(-{}, {})", direction, axis));
        const std::string cutoff =
            text_.uniform(name + "_cutoff", std::cos(light.spot_cutoff * (glm::pi<float>() / 180.0F)));
        const std::string cone = fmt::format("({0} >= {1} ? power({0}, {2}) : 0.0)", cosine, cutoff,
                                             text_.uniform(name + "_exponent", light.spot_exponent));
        factors = factors.empty() ? cone : fmt::format("{} * {}", cone, factors);
    }
    return factors.empty() ? factors : text_.local("float", name + "_strength", factors);
}

void SideLighting::add(const FixedLight& light, std::uint32_t number, const std::string& lit) {
    // An exponent of 0 gives 1, also of 0, which GLSL leaves undefined.
    text_.function("power", "float power(float base, float exponent) { return pow(max(base, 1e-30), exponent); }\n");
    const std::string name = fmt::format("light{}", number);
    const std::string direction = towards(light, name);
    const std::string half = half_vector(light, name, direction);
    const std::string factor = strength(light, name, direction);
    const std::string normal = eye_.normal();
    const std::string side_normal =
        side_ == "front" ? normal : text_.local("vec3", "back_normal", fmt::format("-{}", normal));

    const std::string facing = text_.local("float", fmt::format("{}_{}_facing", name, side_),
                                           fmt::format("dot({}, {})", side_normal, direction));
    const std::string ambient = product(ColourMaterial::ambient, light.ambient, material_.ambient, name + "_ambient");
    const std::string diffuse = product(ColourMaterial::diffuse, light.diffuse, material_.diffuse, name + "_diffuse");
    const std::string specular =
        product(ColourMaterial::specular, light.specular, material_.specular, name + "_specular");
    const std::string shininess = text_.uniform(side_ + "_shininess", material_.shininess);
    const std::string shine =
        fmt::format("({} > 0.0 ? power(dot({}, {}), {}) : 0.0) * {}", facing, side_normal, half, shininess, specular);
    const std::string scattered = fmt::format("{} + max({}, 0.0) * {}", ambient, facing, diffuse);
    const std::string scaled = factor.empty() ? "" : factor + " * ";
    if (lighting_.separate_specular) {
        text_.statement(fmt::format("{}.rgb += {}({})", lit, scaled, scattered));
        text_.statement(fmt::format("shine_{} += {}({})", side_, scaled, shine));
    } else {
        text_.statement(fmt::format("{}.rgb += {}({} + {})", lit, scaled, scattered, shine));
    }
}

} // namespace

void light_side(const FixedFunctionState& state, bool front, const EyeSpace& eye, ShaderText& text) {
    SideLighting(state, front, eye, text).write();
}

} // namespace traces::fixed_function
