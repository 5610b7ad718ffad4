#include "traces/deferred/shaders.hpp"

#include "traces/deferred/composition.hpp"
#include "traces/deferred/shadow_filter.hpp"
#include "traces/shader_names.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace traces {

namespace {

constexpr float behind_eps = 1e-6F; ///< equal depths of two passes are one surface

class GBufferShader final : public pipeline::Shader {
  public:
    GBufferShader(const pipeline::Frame& frame, SharedMaterials materials, Layer layer)
        : draws_(deferred_draws(frame)), normals_(frame), materials_(std::move(materials)), layer_(layer) {}

    ShaderShape shape() const override {
        return {.outputs = 4,
                .reads = first_map() + materials_->count(),
                .registers = materials_->any() ? 8U : 6U,
                .colour = pipeline::FragmentColour::unlit,
                .normal = true,
                .map_texcoords = materials_->any()};
    }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        const DeferredDraw& draw = draws_[input.draw];
        surfaces.issue(2 + 3 + 1 + 2, input.pixels); // test of opacity, normal to the world, to [0,1], constants
        output.colours[0] = with_opacity(input.colour, draw);
        const unsigned transparent = transparent_pixels(output.colours[0]);
        if (layer_ == Layer::interlaced) output.alive &= ~(transparent & even_rows);
        if (layer_ == Layer::behind) keep_behind(input, transparent, surfaces, output);
        const MaterialReads::Quad material = materials_->read(
            input, surfaces, first_map(), MaterialReads::normals | MaterialReads::shine | MaterialReads::emission);
        if (materials_->glows()) surfaces.issue(slots_to_pack_emission, input.pixels);
        const auto normals = normals_.codes(material.normals, input.front, draw);
        for (std::size_t i = 0; i < 4; ++i) {
            output.colours[1][i] = glm::vec4(normals[i], 0.0F);
            const glm::vec2 glow = emission_channels(material.emission[i]);
            output.colours[2][i] = {material.shine[i].x, material.shine[i].y / 255.0F, glow.x, glow.y};
            output.colours[3][i].r = input.depth[i];
        }
    }

  private:
    std::uint32_t first_map() const { return layer_ == Layer::behind ? 1 : 0; }

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
    SharedMaterials materials_;
    Layer layer_;
};

/// What forward rendering begins with: the ambient share of the colours and what surfaces send out, normals and, if
/// asked for, depths.
class AmbientShader final : public pipeline::Shader {
  public:
    AmbientShader(const pipeline::Frame& frame, SharedMaterials materials, float ambient, bool depths)
        : draws_(deferred_draws(frame)),
          normals_(frame),
          materials_(std::move(materials)),
          ambient_(ambient),
          depths_(depths) {}

    ShaderShape shape() const override {
        return {.outputs = depths_ ? 3U : 2U,
                .reads = materials_->count(),
                .registers = materials_->any() ? 7U : 5U,
                .colour = pipeline::FragmentColour::unlit,
                .normal = true,
                .map_texcoords = materials_->any()};
    }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(2 + 1 + 3 + 1, input.pixels); // test of opacity, ambient, normal to the world, to [0,1]
        const DeferredDraw& draw = draws_[input.draw];
        const QuadTexels colours = with_opacity(input.colour, draw);
        output.alive &= ~(transparent_pixels(colours) & even_rows);
        const MaterialReads::Quad material =
            materials_->read(input, surfaces, 0, MaterialReads::normals | MaterialReads::emission);
        if (materials_->glows()) surfaces.issue(1, input.pixels);
        const auto normals = normals_.codes(material.normals, input.front, draw);
        for (std::size_t i = 0; i < 4; ++i) {
            output.colours[0][i] = glm::vec4(glm::vec3(colours[i]) * ambient_ + material.emission[i], colours[i].a);
            output.colours[1][i] = glm::vec4(normals[i], 0.0F);
            output.colours[2][i].r = input.depth[i];
        }
    }

  private:
    std::vector<DeferredDraw> draws_;
    WorldNormals normals_;
    SharedMaterials materials_;
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

    ShaderShape shape() const override { return {.reads = specular() + (glows() ? 1U : 0U), .registers = 6}; }

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
        const QuadColours front_glow = glow_at(specular(), front, input.pixels, surfaces);
        const QuadColours behind_glow = glow_at(specular(), behind, input.pixels, surfaces);
        for (std::size_t i = 0; i < 4; ++i) {
            glm::vec3 colour = lit(front_colour[i], front_light[i]) + front_glow[i];
            if (here[i].a != there[i].a)
                colour = laid_over(lit(behind_colour[i], behind_light[i]) + behind_glow[i], colour, front_colour[i].a);
            output.colours[0][i] = glm::vec4(colour, 1.0F);
        }
    }

  private:
    /// The slot behind all others.
    std::uint32_t specular() const {
        const std::uint32_t refracting = what_ == Interlaced::forward ? 1 : 2;
        return normals_ + (refracts() ? refracting : 0);
    }

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

    ShaderShape shape() const override { return {.reads = glows() ? 9U : 7U, .registers = 6}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(slots(), input.pixels);
        const QuadPlaces own(input);
        const QuadTexels front = surfaces.fetch(0, own.x, own.y, input.pixels);
        const QuadTexels front_light = surfaces.fetch(1, own.x, own.y, input.pixels);
        const QuadColours front_glow = glow_at(7, own, input.pixels, surfaces);
        Behind behind{surfaces.fetch(4, own.x, own.y, input.pixels), surfaces.fetch(5, own.x, own.y, input.pixels),
                      glow_at(8, own, input.pixels, surfaces)};
        if (refracts()) look_through(own, input.pixels, behind, surfaces);
        for (std::size_t i = 0; i < 4; ++i) {
            glm::vec3 colour = lit(front[i], front_light[i]) + front_glow[i];
            if (is_transparent(front[i].a))
                colour = laid_over(lit(behind.colour[i], behind.light[i]) + behind.glow[i], colour, front[i].a);
            output.colours[0][i] = glm::vec4(colour, 1.0F);
        }
    }

  private:
    struct Behind {
        QuadTexels colour, light;
        QuadColours glow;
    };

    void look_through(const QuadPlaces& own, unsigned pixels, Behind& behind, SurfaceAccess& surfaces) const {
        const QuadPlaces through = refracted(own, surfaces.fetch(2, own.x, own.y, pixels));
        const auto at = [&](std::uint32_t slot) { return surfaces.fetch(slot, through.x, through.y, pixels); };
        const QuadTexels pane = surfaces.fetch(3, own.x, own.y, pixels);
        const QuadTexels nearest = at(0), nearest_light = at(1), nearest_depth = at(3);
        const QuadTexels second = at(4), second_light = at(5), second_depth = at(6);
        const QuadColours nearest_glow = glow_at(7, through, pixels, surfaces);
        const QuadColours second_glow = glow_at(8, through, pixels, surfaces);
        for (std::size_t i = 0; i < 4; ++i) {
            const bool opaque = !is_transparent(nearest[i].a);
            if ((opaque ? nearest_depth : second_depth)[i].r < pane[i].r) continue;
            behind.colour[i] = (opaque ? nearest : second)[i];
            behind.light[i] = (opaque ? nearest_light : second_light)[i];
            behind.glow[i] = (opaque ? nearest_glow : second_glow)[i];
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

std::shared_ptr<const pipeline::Shader> gbuffer_shader(const pipeline::Frame& frame, SharedMaterials materials,
                                                       Layer layer) {
    return std::make_shared<const GBufferShader>(frame, std::move(materials), layer);
}

std::shared_ptr<const pipeline::Shader> ambient_shader(const pipeline::Frame& frame, SharedMaterials materials,
                                                       float ambient, bool depths) {
    return std::make_shared<const AmbientShader>(frame, std::move(materials), ambient, depths);
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
