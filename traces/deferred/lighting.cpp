#include "traces/deferred/reflection.hpp"
#include "traces/deferred/shaders.hpp"
#include "traces/deferred/shadow_filter.hpp"
#include "traces/deferred/two_class_surface.hpp"
#include "traces/deferred/world_normals.hpp"
#include "traces/shader_names.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace traces {

namespace {

/// One light, as it falls on points of the picture.
class Lighting {
  public:
    Lighting(const pipeline::View& eye, const SpotLight& light, const LightOptions& options)
        : light_(light),
          options_(options),
          eye_(glm::inverse(glm::dmat4(eye.view))[3]),
          to_world_(glm::inverse(glm::dmat4(eye.projection) * glm::dmat4(eye.view))),
          pixel_(2.0 / eye.width, 2.0 / eye.height) {
        const pipeline::View map = light.view(options.map_size);
        to_map_ = glm::dmat4(map.projection) * glm::dmat4(map.view);
    }

    /// Shadow surfaces that it reads.
    std::uint32_t maps() const {
        if (options_.shadows == Shadows::none) return 0;
        return options_.shadows == Shadows::opaque || options_.maps == ShadowMaps::two_class ? 1 : 2;
    }

    glm::dvec3 place(std::int32_t x, std::int32_t y, float depth) const {
        const glm::dvec4 at = to_world_ * glm::dvec4((x + 0.5) * pixel_.x - 1.0, 1.0 - (y + 0.5) * pixel_.y,
                                                     2.0 * static_cast<double>(depth) - 1.0, 1.0);
        return glm::dvec3(at) / at.w;
    }

    /// Equation 2.1: diffuse light, and specular in alpha. The normal runs from [-1,1] to [0,1].
    glm::vec4 reflected(const glm::dvec3& point, const glm::vec3& normal_code, const glm::vec4& specular,
                        const glm::vec3& light) const {
        const ReflectingPoint from{point, glm::dvec3(normal_code) * 2.0 - 1.0, static_cast<double>(specular.r),
                                   static_cast<double>(specular.g) * 255.0};
        return glm::vec4(traces::reflected(light_, options_.intensity, glm::dvec3(light), from, eye_));
    }

    /// What arrives past the shadows, whose surfaces the shader knows from `first_map` on.
    std::array<glm::vec3, 4> through_shadows(const std::array<glm::dvec3, 4>& points, unsigned pixels,
                                             SurfaceAccess& surfaces, std::uint32_t first_map) const {
        std::array<glm::vec3, 4> light;
        light.fill(glm::vec3(light_.colour));
        if (options_.shadows == Shadows::none) {
            surfaces.issue(slots_opaque - slots_of_projection, pixels);
            return light;
        }
        const MapPlaces at = in_map(points);
        surfaces.issue(options_.shadows == Shadows::opaque ? slots_opaque : slots_transparent, pixels);
        if (options_.shadows == Shadows::opaque)
            filter_opaque(at, pixels, surfaces, first_map, light);
        else if (options_.maps == ShadowMaps::two_class)
            filter_classes(at, pixels, surfaces, first_map, light);
        else
            filter_rows(at, pixels, surfaces, first_map, light);
        return light;
    }

  private:
    using QuadLight = std::array<glm::vec3, 4>;

    static constexpr std::uint32_t slots_opaque = 66, slots_transparent = 82;
    static constexpr std::uint32_t slots_of_projection = 10; // four dots, reciprocal, scale, bias, compare, multiply

    /// Points as a shadow map sees them.
    struct MapPlaces {
        LaneIndices x{}, y{}; ///< texels, outside of the map as well
        std::array<float, 4> depth{};
        unsigned inside = 0; ///< mask of those in the map
    };

    MapPlaces in_map(const std::array<glm::dvec3, 4>& points) const {
        MapPlaces at;
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec3 nearer =
                points[i] + glm::normalize(light_.place - points[i]) * (options_.bias * light_.range);
            const glm::dvec4 seen = to_map_ * glm::dvec4(nearer, 1.0);
            const glm::dvec3 ndc = seen.w > 0.0 ? glm::dvec3(seen) / seen.w : glm::dvec3(2.0);
            const auto size = static_cast<double>(options_.map_size);
            const auto texel = [size](double share) {
                return static_cast<std::int32_t>(std::floor(std::clamp(share, -1.0, 2.0) * size));
            };
            at.x[i] = texel(0.5 + 0.5 * ndc.x);
            at.y[i] = texel(0.5 - 0.5 * ndc.y);
            at.depth[i] = static_cast<float>(0.5 + 0.5 * ndc.z);
            at.inside |= (inside(at.x[i], at.y[i]) ? 1U : 0U) << i;
        }
        return at;
    }

    static void filter_opaque(const MapPlaces& at, unsigned pixels, SurfaceAccess& surfaces, std::uint32_t map,
                              QuadLight& light) {
        const QuadTexels depths = surfaces.fetch(map, at.x, at.y, pixels);
        for (std::size_t i = 0; i < 4; ++i)
            if ((at.inside >> i & 1U) != 0 && depths[i].r < at.depth[i]) light[i] = glm::vec3(0.0F);
    }

    void filter_rows(const MapPlaces& at, unsigned pixels, SurfaceAccess& surfaces, std::uint32_t map,
                     QuadLight& light) const {
        LaneIndices other{};
        for (std::size_t i = 0; i < 4; ++i) // one row is even and one is odd, at the last row, too
            other[i] = at.y[i] + 1 < static_cast<std::int32_t>(options_.map_size) ? at.y[i] + 1 : at.y[i] - 1;
        const QuadTexels here = surfaces.fetch(map, at.x, at.y, pixels);
        const QuadTexels there = surfaces.fetch(map, at.x, other, pixels);
        const QuadTexels colour_here = surfaces.fetch(map + 1, at.x, at.y, pixels);
        const QuadTexels colour_there = surfaces.fetch(map + 1, at.x, other, pixels);
        for (std::size_t i = 0; i < 4; ++i)
            if ((at.inside >> i & 1U) != 0)
                light[i] = light_through<float>({here[i].r, colour_here[i]}, {there[i].r, colour_there[i]}, at.depth[i],
                                                light[i]);
    }

    static void filter_classes(const MapPlaces& at, unsigned pixels, SurfaceAccess& surfaces, std::uint32_t map,
                               QuadLight& light) {
        const TwoClassQuad seen = read_two_class(surfaces, map, at.x, at.y, pixels & at.inside);
        for (std::size_t i = 0; i < 4; ++i)
            light[i] = light_through<float>({seen.transparent[i].depth, seen.transparent[i].colour},
                                            {seen.opaque[i].depth, seen.opaque[i].colour}, at.depth[i], light[i]);
    }

    bool inside(std::int32_t x, std::int32_t y) const {
        const auto size = static_cast<std::int32_t>(options_.map_size);
        return x >= 0 && x < size && y >= 0 && y < size;
    }

    SpotLight light_;
    LightOptions options_;
    glm::dvec3 eye_;
    glm::dmat4 to_world_, to_map_{1.0};
    glm::dvec2 pixel_;
};

class LightShader final : public pipeline::Shader {
  public:
    explicit LightShader(const Lighting& lighting) : lighting_(lighting) {}

    ShaderShape shape() const override { return {.reads = 3 + lighting_.maps(), .registers = 8}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const QuadPlaces at(input);
        const QuadTexels normals = surfaces.fetch(0, at.x, at.y, input.pixels);
        const QuadTexels specular = surfaces.fetch(1, at.x, at.y, input.pixels);
        const QuadTexels depths = surfaces.fetch(2, at.x, at.y, input.pixels);
        std::array<glm::dvec3, 4> points;
        for (std::size_t i = 0; i < 4; ++i) points[i] = lighting_.place(at.x[i], at.y[i], depths[i].r);
        const auto arriving = lighting_.through_shadows(points, input.pixels, surfaces, 3);
        for (std::size_t i = 0; i < 4; ++i)
            if (depths[i].r < 1.0F) // there is a surface
                output.colours[0][i] = lighting_.reflected(points[i], glm::vec3(normals[i]), specular[i], arriving[i]);
    }

  private:
    Lighting lighting_;
};

/// Both surfaces of a pixel at once: those of a k-buffer.
class TwoClassLight final : public pipeline::Shader {
  public:
    explicit TwoClassLight(const Lighting& lighting) : lighting_(lighting) {}

    ShaderShape shape() const override { return {.outputs = 2, .reads = 1 + lighting_.maps(), .registers = 10}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const QuadPlaces at(input);
        const TwoClassQuad seen = read_two_class(surfaces, 0, at.x, at.y, input.pixels);
        output.colours[0] = light_on(seen.transparent, at, input.pixels, surfaces);
        output.colours[1] = light_on(seen.opaque, at, input.pixels, surfaces);
    }

  private:
    QuadTexels light_on(const QuadSurfaces& quad, const QuadPlaces& at, unsigned pixels,
                        SurfaceAccess& surfaces) const {
        std::array<glm::dvec3, 4> points;
        for (std::size_t i = 0; i < 4; ++i) points[i] = lighting_.place(at.x[i], at.y[i], quad[i].depth);
        const auto arriving = lighting_.through_shadows(points, pixels, surfaces, 1);
        QuadTexels light{};
        for (std::size_t i = 0; i < 4; ++i)
            if (quad[i].depth < 1.0F)
                light[i] = lighting_.reflected(points[i], glm::vec3(quad[i].normal), quad[i].specular, arriving[i]);
        return light;
    }

    Lighting lighting_;
};

/// The light on the surface that is drawn, for additive blending.
class ForwardLightShader final : public pipeline::Shader {
  public:
    ForwardLightShader(const pipeline::Frame& frame, SharedMaterials materials, const Lighting& lighting)
        : draws_(deferred_draws(frame)), normals_(frame), materials_(std::move(materials)), lighting_(lighting) {}

    ShaderShape shape() const override {
        return {.reads = lighting_.maps() + materials_->count(),
                .registers = materials_->any() ? 10U : 8U,
                .colour = pipeline::FragmentColour::unlit,
                .normal = true,
                .map_texcoords = materials_->any()};
    }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const DeferredDraw& draw = draws_[input.draw];
        const QuadTexels colours = with_opacity(input.colour, draw);
        output.alive &= ~(transparent_pixels(colours) & even_rows);
        const QuadPlaces at(input);
        std::array<glm::dvec3, 4> points;
        for (std::size_t i = 0; i < 4; ++i) points[i] = lighting_.place(at.x[i], at.y[i], input.depth[i]);
        const auto arriving = lighting_.through_shadows(points, input.pixels, surfaces, 0);
        const MaterialReads::Quad material =
            materials_->read(input, surfaces, lighting_.maps(), MaterialReads::normals | MaterialReads::shine);
        const auto normals = normals_.codes(material.normals, input.front, draw);
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec4 specular(material.shine[i].x, material.shine[i].y / 255.0F, 0.0F, 0.0F);
            const glm::vec4 light = lighting_.reflected(points[i], normals[i], specular, arriving[i]);
            output.colours[0][i] = glm::vec4(glm::vec3(colours[i]) * glm::vec3(light) + light.a, 0.0F);
        }
    }

  private:
    std::vector<DeferredDraw> draws_;
    WorldNormals normals_;
    SharedMaterials materials_;
    Lighting lighting_;
};

} // namespace

std::shared_ptr<const pipeline::Shader> light_shader(const pipeline::View& eye, const SpotLight& light,
                                                     const LightOptions& options) {
    return std::make_shared<const LightShader>(Lighting(eye, light, options));
}

std::shared_ptr<const pipeline::Shader> forward_light_shader(const pipeline::Frame& frame, SharedMaterials materials,
                                                             const SpotLight& light, const LightOptions& options) {
    return std::make_shared<const ForwardLightShader>(frame, std::move(materials),
                                                      Lighting(frame.view, light, options));
}

std::shared_ptr<const pipeline::Shader> two_class_light_shader(const pipeline::View& eye, const SpotLight& light,
                                                               const LightOptions& options) {
    return std::make_shared<const TwoClassLight>(Lighting(eye, light, options));
}

} // namespace traces
