#include "traces/deferred/shaders.hpp"

#include "traces/deferred/shadow_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace traces {

namespace {

using pipeline::LaneIndices;
using pipeline::QuadTexels;
using pipeline::ShaderInput;
using pipeline::ShaderOutput;
using pipeline::ShaderShape;
using pipeline::SurfaceAccess;

constexpr unsigned even_rows = 0b0011; ///< of a quad
constexpr float behind_eps = 1e-6F;    ///< equal depths of two passes are one surface

struct Places {
    LaneIndices x{}, y{};

    explicit Places(const ShaderInput& input) {
        for (std::size_t i = 0; i < 4; ++i) {
            x[i] = static_cast<std::int32_t>(input.x + i % 2);
            y[i] = static_cast<std::int32_t>(input.y + i / 2);
        }
    }
};

/// As eight bits keep it.
bool is_transparent(float opacity) { return std::lround(std::clamp(opacity, 0.0F, 1.0F) * 255.0F) < 255; }

unsigned transparent_pixels(const QuadTexels& colours) {
    unsigned pixels = 0;
    for (std::size_t i = 0; i < 4; ++i) pixels |= (is_transparent(colours[i].a) ? 1U : 0U) << i;
    return pixels;
}

QuadTexels with_opacity(QuadTexels colours, const DeferredDraw& draw) {
    for (glm::vec4& colour : colours) colour.a *= draw.opacity;
    return colours;
}

class GBufferShader final : public pipeline::Shader {
  public:
    GBufferShader(const pipeline::Frame& frame, const GBufferOptions& options)
        : draws_(deferred_draws(frame)), to_world_(glm::transpose(glm::mat3(frame.view.view))), options_(options) {}

    ShaderShape shape() const override {
        return {.outputs = 4,
                .reads = options_.layer == Layer::behind ? 1U : 0U,
                .registers = 6,
                .colour = pipeline::FragmentColour::unlit,
                .normal = true};
    }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const DeferredDraw& draw = draws_[input.draw];
        surfaces.issue(2 + 3 + 1 + 2, input.pixels); // test of opacity, normal to the world, to [0,1], constants
        output.colours[0] = with_opacity(input.colour, draw);
        const unsigned transparent = transparent_pixels(output.colours[0]);
        if (options_.layer == Layer::interlaced) output.alive &= ~(transparent & even_rows);
        if (options_.layer == Layer::behind) keep_behind(input, transparent, surfaces, output);
        const bool back = draw.double_sided && input.front == draw.mirrored;
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec3 normal = to_world_ * glm::vec3(input.normal[i]) * (back ? -1.0F : 1.0F);
            output.colours[1][i] = glm::vec4(normal * 0.5F + 0.5F, 0.0F);
            output.colours[2][i] = {options_.specular, options_.specular_power / 255.0F, 0.0F, 0.0F};
            output.colours[3][i].r = input.depth[i];
        }
    }

  private:
    static void keep_behind(const ShaderInput& input, unsigned transparent, SurfaceAccess& surfaces,
                            ShaderOutput& output) {
        const Places at(input);
        const QuadTexels nearest = surfaces.fetch(0, at.x, at.y, input.pixels);
        surfaces.issue(2, input.pixels); // add and compare
        output.alive &= ~transparent;
        for (std::size_t i = 0; i < 4; ++i)
            if (input.depth[i] <= nearest[i].r + behind_eps) output.alive &= ~(1U << i);
    }

    std::vector<DeferredDraw> draws_;
    glm::mat3 to_world_;
    GBufferOptions options_;
};

class ShadowShader final : public pipeline::Shader {
  public:
    ShadowShader(const pipeline::Frame& frame, Shadows shadows) : draws_(deferred_draws(frame)), shadows_(shadows) {}

    ShaderShape shape() const override {
        if (shadows_ == Shadows::opaque) return {.registers = 2};
        return {.outputs = 2, .registers = 3, .colour = pipeline::FragmentColour::unlit};
    }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(1, input.pixels);
        for (std::size_t i = 0; i < 4; ++i) output.colours[0][i].r = input.depth[i];
        if (shadows_ == Shadows::opaque) return;
        surfaces.issue(2, input.pixels); // test of opacity
        output.colours[1] = with_opacity(input.colour, draws_[input.draw]);
        output.alive &= ~(transparent_pixels(output.colours[1]) & even_rows);
    }

  private:
    std::vector<DeferredDraw> draws_;
    Shadows shadows_;
};

class LightShader final : public pipeline::Shader {
  public:
    LightShader(const pipeline::View& eye, const SpotLight& light, const LightOptions& options)
        : light_(light),
          options_(options),
          eye_(glm::inverse(glm::dmat4(eye.view))[3]),
          to_world_(glm::inverse(glm::dmat4(eye.projection) * glm::dmat4(eye.view))),
          pixel_(2.0 / eye.width, 2.0 / eye.height) {
        const pipeline::View map = light.view(options.map_size);
        to_map_ = glm::dmat4(map.projection) * glm::dmat4(map.view);
    }

    ShaderShape shape() const override {
        const std::uint32_t maps = options_.shadows == Shadows::none ? 0 : options_.shadows == Shadows::opaque ? 1 : 2;
        return {.reads = 3 + maps, .registers = 8};
    }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const Places at(input);
        const QuadTexels normals = surfaces.fetch(0, at.x, at.y, input.pixels);
        const QuadTexels specular = surfaces.fetch(1, at.x, at.y, input.pixels);
        const QuadTexels depths = surfaces.fetch(2, at.x, at.y, input.pixels);
        std::array<glm::dvec3, 4> points;
        for (std::size_t i = 0; i < 4; ++i) points[i] = place(at.x[i], at.y[i], depths[i].r);
        const auto arriving = through_shadows(points, input.pixels, surfaces);
        for (std::size_t i = 0; i < 4; ++i)
            if (depths[i].r < 1.0F) // there is a surface
                output.colours[0][i] = reflected(points[i], glm::vec3(normals[i]), specular[i], arriving[i]);
    }

  private:
    glm::dvec3 place(std::int32_t x, std::int32_t y, float depth) const {
        const glm::dvec4 at = to_world_ * glm::dvec4((x + 0.5) * pixel_.x - 1.0, 1.0 - (y + 0.5) * pixel_.y,
                                                     2.0 * static_cast<double>(depth) - 1.0, 1.0);
        return glm::dvec3(at) / at.w;
    }

    /// Equation 2.1 for one light.
    glm::vec4 reflected(const glm::dvec3& point, const glm::vec3& normal_code, const glm::vec4& specular,
                        const glm::vec3& light) const {
        const glm::dvec3 normal = glm::dvec3(normal_code) * 2.0 - 1.0;
        const glm::dvec3 to_light = glm::normalize(light_.place - point);
        const double facing = glm::dot(normal, to_light);
        if (!(facing > 0.0)) return glm::vec4(0.0F);
        const glm::dvec3 mirrored = 2.0 * facing * normal - to_light;
        const double along = std::max(glm::dot(mirrored, glm::normalize(eye_ - point)), 0.0);
        const double shine = static_cast<double>(specular.r) * std::pow(along, static_cast<double>(specular.g) * 255.0);
        const double share = options_.intensity * light_.arrives(point);
        const glm::dvec3 diffuse = glm::dvec3(light) * (facing * share);
        return glm::vec4(diffuse, shine * share * std::max({light.r, light.g, light.b}));
    }

    std::array<glm::vec3, 4> through_shadows(const std::array<glm::dvec3, 4>& points, unsigned pixels,
                                             SurfaceAccess& surfaces) const {
        constexpr std::uint32_t slots_opaque = 66, slots_transparent = 82;
        constexpr std::uint32_t slots_of_projection = 10; // four dots, reciprocal, scale and bias, compare, multiply
        std::array<glm::vec3, 4> light;
        light.fill(glm::vec3(light_.colour));
        if (options_.shadows == Shadows::none) {
            surfaces.issue(slots_opaque - slots_of_projection, pixels);
            return light;
        }
        LaneIndices x{}, y{}, other{};
        std::array<float, 4> depth{};
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec3 nearer =
                points[i] + glm::normalize(light_.place - points[i]) * (options_.bias * light_.range);
            const glm::dvec4 seen = to_map_ * glm::dvec4(nearer, 1.0);
            const glm::dvec3 ndc = seen.w > 0.0 ? glm::dvec3(seen) / seen.w : glm::dvec3(2.0);
            const auto size = static_cast<double>(options_.map_size);
            const auto texel = [size](double at) {
                return static_cast<std::int32_t>(std::floor(std::clamp(at, -1.0, 2.0) * size));
            };
            x[i] = texel(0.5 + 0.5 * ndc.x);
            y[i] = texel(0.5 - 0.5 * ndc.y);
            // One row is even and one is odd, at the last row, too.
            other[i] = y[i] + 1 < static_cast<std::int32_t>(options_.map_size) ? y[i] + 1 : y[i] - 1;
            depth[i] = static_cast<float>(0.5 + 0.5 * ndc.z);
        }
        const QuadTexels here = surfaces.fetch(3, x, y, pixels);
        if (options_.shadows == Shadows::opaque) {
            surfaces.issue(slots_opaque, pixels);
            for (std::size_t i = 0; i < 4; ++i)
                if (inside(x[i], y[i]) && here[i].r < depth[i]) light[i] = glm::vec3(0.0F);
            return light;
        }
        const QuadTexels there = surfaces.fetch(3, x, other, pixels);
        const QuadTexels colour_here = surfaces.fetch(4, x, y, pixels);
        const QuadTexels colour_there = surfaces.fetch(4, x, other, pixels);
        surfaces.issue(slots_transparent, pixels);
        for (std::size_t i = 0; i < 4; ++i)
            if (inside(x[i], y[i]))
                light[i] =
                    light_through({here[i].r, colour_here[i]}, {there[i].r, colour_there[i]}, depth[i], light[i]);
        return light;
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

/// What compositions share: a surface in the light that it got, and where one looks through it.
class Composition : public pipeline::Shader {
  public:
    Composition(const pipeline::View& eye, const CompositionOptions& options)
        : options_(options),
          to_eye_(eye.view),
          width_(static_cast<std::int32_t>(eye.width)),
          height_(static_cast<std::int32_t>(eye.height)) {}

  protected:
    /// Specular light is white.
    static glm::vec3 lit(const glm::vec4& colour, const glm::vec4& light) {
        return glm::vec3(colour) * glm::vec3(light) + light.a;
    }
    /// Where one sees through a pane with these normals, on the screen.
    Places refracted(const Places& at, const QuadTexels& normals) const {
        Places through = at;
        const auto pixels = static_cast<float>(options_.coefficient * height_);
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec3 normal = to_eye_ * (glm::vec3(normals[i]) * 2.0F - 1.0F);
            const auto along = [pixels](float part) { return static_cast<std::int32_t>(std::lround(pixels * part)); };
            through.x[i] = std::clamp(at.x[i] + along(normal.x), 0, width_ - 1);
            through.y[i] = std::clamp(at.y[i] - along(normal.y), 0, height_ - 1);
        }
        return through;
    }
    bool refracts() const { return options_.refraction; }
    static constexpr std::uint32_t slots_plain = 14, slots_refracting = 27;

  private:
    CompositionOptions options_;
    glm::mat3 to_eye_;
    std::int32_t width_, height_;
};

class InterlacedComposition final : public Composition {
  public:
    using Composition::Composition;

    ShaderShape shape() const override { return {.reads = refracts() ? 4U : 2U, .registers = 6}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(refracts() ? slots_refracting : slots_plain, input.pixels);
        const Places own(input), above = one_above(own);
        const QuadTexels here = surfaces.fetch(0, own.x, own.y, input.pixels);
        const QuadTexels there = surfaces.fetch(0, above.x, above.y, input.pixels);
        Places front = own, behind = own;
        for (std::size_t i = 0; i < 4; ++i) {
            (there[i].a < here[i].a ? front : behind).y[i] = above.y[i];
            if (here[i].a == there[i].a) front.y[i] = behind.y[i] = own.y[i];
        }
        QuadTexels front_colour = here, behind_colour = there;
        for (std::size_t i = 0; i < 4; ++i)
            if (there[i].a < here[i].a) std::swap(front_colour[i], behind_colour[i]);
        if (refracts()) look_through(input.pixels, front, behind, behind_colour, surfaces);
        const QuadTexels front_light = surfaces.fetch(1, front.x, front.y, input.pixels);
        const QuadTexels behind_light = surfaces.fetch(1, behind.x, behind.y, input.pixels);
        for (std::size_t i = 0; i < 4; ++i) {
            glm::vec3 colour = lit(front_colour[i], front_light[i]);
            if (here[i].a != there[i].a)
                colour = laid_over(lit(behind_colour[i], behind_light[i]), colour, front_colour[i].a);
            output.colours[0][i] = glm::vec4(colour, 1.0F);
        }
    }

  private:
    static Places one_above(Places places) {
        for (std::int32_t& y : places.y) y = std::max(y - 1, 0);
        return places;
    }

    /// Another opaque surface than the one right behind, unless that lies in front of the pane.
    void look_through(unsigned pixels, const Places& front, Places& behind, QuadTexels& behind_colour,
                      SurfaceAccess& surfaces) const {
        const QuadTexels normals = surfaces.fetch(2, front.x, front.y, pixels);
        Places through = refracted(front, normals);
        const QuadTexels first = surfaces.fetch(0, through.x, through.y, pixels);
        const Places above = one_above(through);
        const QuadTexels second = surfaces.fetch(0, above.x, above.y, pixels);
        QuadTexels seen = first;
        for (std::size_t i = 0; i < 4; ++i)
            if (is_transparent(first[i].a)) {
                through.y[i] = above.y[i];
                seen[i] = second[i];
            }
        const QuadTexels pane = surfaces.fetch(3, front.x, front.y, pixels);
        const QuadTexels depth = surfaces.fetch(3, through.x, through.y, pixels);
        for (std::size_t i = 0; i < 4; ++i) {
            if (depth[i].r < pane[i].r) continue;
            behind.x[i] = through.x[i];
            behind.y[i] = through.y[i];
            behind_colour[i] = seen[i];
        }
    }
};

class PeeledComposition final : public Composition {
  public:
    using Composition::Composition;

    ShaderShape shape() const override { return {.reads = 7, .registers = 6}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(refracts() ? slots_refracting : slots_plain, input.pixels);
        const Places own(input);
        const QuadTexels front = surfaces.fetch(0, own.x, own.y, input.pixels);
        const QuadTexels front_light = surfaces.fetch(1, own.x, own.y, input.pixels);
        QuadTexels behind = surfaces.fetch(4, own.x, own.y, input.pixels);
        QuadTexels behind_light = surfaces.fetch(5, own.x, own.y, input.pixels);
        if (refracts()) look_through(own, input.pixels, behind, behind_light, surfaces);
        for (std::size_t i = 0; i < 4; ++i) {
            glm::vec3 colour = lit(front[i], front_light[i]);
            if (is_transparent(front[i].a)) colour = laid_over(lit(behind[i], behind_light[i]), colour, front[i].a);
            output.colours[0][i] = glm::vec4(colour, 1.0F);
        }
    }

  private:
    void look_through(const Places& own, unsigned pixels, QuadTexels& behind, QuadTexels& behind_light,
                      SurfaceAccess& surfaces) const {
        const Places through = refracted(own, surfaces.fetch(2, own.x, own.y, pixels));
        const auto at = [&](std::uint32_t slot) { return surfaces.fetch(slot, through.x, through.y, pixels); };
        const QuadTexels pane = surfaces.fetch(3, own.x, own.y, pixels);
        const QuadTexels nearest = at(0), nearest_light = at(1), nearest_depth = at(3);
        const QuadTexels second = at(4), second_light = at(5), second_depth = at(6);
        for (std::size_t i = 0; i < 4; ++i) {
            const bool opaque = !is_transparent(nearest[i].a);
            if ((opaque ? nearest_depth : second_depth)[i].r < pane[i].r) continue;
            behind[i] = (opaque ? nearest : second)[i];
            behind_light[i] = (opaque ? nearest_light : second_light)[i];
        }
    }
};

} // namespace

std::vector<DeferredDraw> deferred_draws(const pipeline::Frame& frame) {
    std::vector<DeferredDraw> draws;
    for (const pipeline::Draw& draw : frame.draws) {
        const pipeline::Material& material = frame.resources->materials[draw.material];
        draws.push_back({1.0F - std::clamp(material.transmission, 0.0F, 1.0F), material.double_sided,
                         glm::determinant(glm::mat3(draw.instances.front())) < 0.0F});
    }
    return draws;
}

std::shared_ptr<const pipeline::Shader> gbuffer_shader(const pipeline::Frame& frame, const GBufferOptions& options) {
    return std::make_shared<const GBufferShader>(frame, options);
}

std::shared_ptr<const pipeline::Shader> shadow_shader(const pipeline::Frame& frame, Shadows shadows) {
    return std::make_shared<const ShadowShader>(frame, shadows);
}

std::shared_ptr<const pipeline::Shader> light_shader(const pipeline::View& eye, const SpotLight& light,
                                                     const LightOptions& options) {
    return std::make_shared<const LightShader>(eye, light, options);
}

std::shared_ptr<const pipeline::Shader> interlaced_composition(const pipeline::View& eye,
                                                               const CompositionOptions& options) {
    return std::make_shared<const InterlacedComposition>(eye, options);
}

std::shared_ptr<const pipeline::Shader> peeled_composition(const pipeline::View& eye,
                                                           const CompositionOptions& options) {
    return std::make_shared<const PeeledComposition>(eye, options);
}

} // namespace traces
