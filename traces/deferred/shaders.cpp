#include "traces/deferred/shaders.hpp"

#include "traces/deferred/composition.hpp"
#include "traces/deferred/shadow_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace traces {

namespace {

using pipeline::QuadPlaces;
using pipeline::QuadTexels;
using pipeline::ShaderInput;
using pipeline::ShaderOutput;
using pipeline::ShaderShape;
using pipeline::SurfaceAccess;

constexpr float behind_eps = 1e-6F; ///< equal depths of two passes are one surface

class GBufferShader final : public pipeline::Shader {
  public:
    GBufferShader(const pipeline::Frame& frame, const GBufferOptions& options)
        : draws_(deferred_draws(frame)), normals_(frame), options_(options) {}

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
        const auto normals = normals_.codes(input, draw);
        for (std::size_t i = 0; i < 4; ++i) {
            output.colours[1][i] = glm::vec4(normals[i], 0.0F);
            output.colours[2][i] = {options_.specular, options_.specular_power / 255.0F, 0.0F, 0.0F};
            output.colours[3][i].r = input.depth[i];
        }
    }

  private:
    static void keep_behind(const ShaderInput& input, unsigned transparent, SurfaceAccess& surfaces,
                            ShaderOutput& output) {
        const QuadPlaces at(input);
        const QuadTexels nearest = surfaces.fetch(0, at.x, at.y, input.pixels);
        surfaces.issue(2, input.pixels); // add and compare
        output.alive &= ~transparent;
        for (std::size_t i = 0; i < 4; ++i)
            if (input.depth[i] <= nearest[i].r + behind_eps) output.alive &= ~(1U << i);
    }

    std::vector<DeferredDraw> draws_;
    WorldNormals normals_;
    GBufferOptions options_;
};

/// What forward rendering begins with: the ambient share of the colours, normals and, if asked for, depths.
class AmbientShader final : public pipeline::Shader {
  public:
    AmbientShader(const pipeline::Frame& frame, float ambient, bool depths)
        : draws_(deferred_draws(frame)), normals_(frame), ambient_(ambient), depths_(depths) {}

    ShaderShape shape() const override {
        return {
            .outputs = depths_ ? 3U : 2U, .registers = 5, .colour = pipeline::FragmentColour::unlit, .normal = true};
    }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(2 + 1 + 3 + 1, input.pixels); // test of opacity, ambient, normal to the world, to [0,1]
        const DeferredDraw& draw = draws_[input.draw];
        const QuadTexels colours = with_opacity(input.colour, draw);
        output.alive &= ~(transparent_pixels(colours) & even_rows);
        const auto normals = normals_.codes(input, draw);
        for (std::size_t i = 0; i < 4; ++i) {
            output.colours[0][i] = glm::vec4(glm::vec3(colours[i]) * ambient_, colours[i].a);
            output.colours[1][i] = glm::vec4(normals[i], 0.0F);
            output.colours[2][i].r = input.depth[i];
        }
    }

  private:
    std::vector<DeferredDraw> draws_;
    WorldNormals normals_;
    float ambient_;
    bool depths_;
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

class InterlacedComposition final : public Composition {
  public:
    InterlacedComposition(const pipeline::View& eye, const CompositionOptions& options, Interlaced what)
        : Composition(eye, options), what_(what), normals_(what == Interlaced::deferred ? 2 : 1) {}

    ShaderShape shape() const override {
        const std::uint32_t refracting = what_ == Interlaced::forward ? 1 : 2;
        return {.reads = normals_ + (refracts() ? refracting : 0), .registers = 6};
    }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(slots(), input.pixels);
        const QuadPlaces own(input), above = one_above(own);
        const QuadTexels here = surfaces.fetch(0, own.x, own.y, input.pixels);
        const QuadTexels there = surfaces.fetch(0, above.x, above.y, input.pixels);
        QuadPlaces front = own, behind = own;
        for (std::size_t i = 0; i < 4; ++i) {
            (there[i].a < here[i].a ? front : behind).y[i] = above.y[i];
            if (here[i].a == there[i].a) front.y[i] = behind.y[i] = own.y[i];
        }
        QuadTexels front_colour = here, behind_colour = there;
        for (std::size_t i = 0; i < 4; ++i)
            if (there[i].a < here[i].a) std::swap(front_colour[i], behind_colour[i]);
        if (refracts()) look_through(own, input.pixels, front, behind, behind_colour, surfaces);
        QuadTexels front_light, behind_light;
        front_light.fill(already_lit);
        behind_light.fill(already_lit);
        if (what_ == Interlaced::deferred) {
            front_light = surfaces.fetch(1, front.x, front.y, input.pixels);
            behind_light = surfaces.fetch(1, behind.x, behind.y, input.pixels);
        }
        for (std::size_t i = 0; i < 4; ++i) {
            glm::vec3 colour = lit(front_colour[i], front_light[i]);
            if (here[i].a != there[i].a)
                colour = laid_over(lit(behind_colour[i], behind_light[i]), colour, front_colour[i].a);
            output.colours[0][i] = glm::vec4(colour, 1.0F);
        }
    }

  private:
    static QuadPlaces one_above(QuadPlaces places) {
        for (std::int32_t& y : places.y) y = std::max(y - 1, 0);
        return places;
    }

    /// Another opaque surface than the one right behind, unless that lies in front of the pane; without depths, unless
    /// no pane is there (B9).
    void look_through(const QuadPlaces& own, unsigned pixels, const QuadPlaces& front, QuadPlaces& behind,
                      QuadTexels& behind_colour, SurfaceAccess& surfaces) const {
        const QuadTexels normals = surfaces.fetch(normals_, front.x, front.y, pixels);
        QuadPlaces through = refracted(own, normals);
        const QuadTexels first = surfaces.fetch(0, through.x, through.y, pixels);
        const QuadPlaces above = one_above(through);
        const QuadTexels second = surfaces.fetch(0, above.x, above.y, pixels);
        QuadTexels seen = first;
        for (std::size_t i = 0; i < 4; ++i)
            if (is_transparent(first[i].a)) {
                through.y[i] = above.y[i];
                seen[i] = second[i];
            }
        unsigned accepted = transparent_pixels(first) | transparent_pixels(second);
        if (what_ != Interlaced::forward) {
            const QuadTexels pane = surfaces.fetch(normals_ + 1, front.x, front.y, pixels);
            const QuadTexels depth = surfaces.fetch(normals_ + 1, through.x, through.y, pixels);
            for (std::size_t i = 0; i < 4; ++i)
                accepted = depth[i].r < pane[i].r ? accepted & ~(1U << i) : accepted | 1U << i;
        }
        for (std::size_t i = 0; i < 4; ++i) {
            if ((accepted >> i & 1U) == 0) continue;
            behind.x[i] = through.x[i];
            behind.y[i] = through.y[i];
            behind_colour[i] = seen[i];
        }
    }

    static constexpr glm::vec4 already_lit{1.0F, 1.0F, 1.0F, 0.0F};
    Interlaced what_;
    std::uint32_t normals_; ///< the slot of normals, behind which depths are
};

class PeeledComposition final : public Composition {
  public:
    using Composition::Composition;

    ShaderShape shape() const override { return {.reads = 7, .registers = 6}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(slots(), input.pixels);
        const QuadPlaces own(input);
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
    void look_through(const QuadPlaces& own, unsigned pixels, QuadTexels& behind, QuadTexels& behind_light,
                      SurfaceAccess& surfaces) const {
        const QuadPlaces through = refracted(own, surfaces.fetch(2, own.x, own.y, pixels));
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

std::shared_ptr<const pipeline::Shader> ambient_shader(const pipeline::Frame& frame, float ambient, bool depths) {
    return std::make_shared<const AmbientShader>(frame, ambient, depths);
}

std::shared_ptr<const pipeline::Shader> shadow_shader(const pipeline::Frame& frame, Shadows shadows) {
    return std::make_shared<const ShadowShader>(frame, shadows);
}

std::shared_ptr<const pipeline::Shader> interlaced_composition(const pipeline::View& eye,
                                                               const CompositionOptions& options, Interlaced what) {
    return std::make_shared<const InterlacedComposition>(eye, options, what);
}

std::shared_ptr<const pipeline::Shader> peeled_composition(const pipeline::View& eye,
                                                           const CompositionOptions& options) {
    return std::make_shared<const PeeledComposition>(eye, options);
}

} // namespace traces
