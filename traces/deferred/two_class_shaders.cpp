// The shaders of deferred shading whose G-buffer or shadow map is a k-buffer of two classes; their lights are in
// lighting.cpp. Source: specification 003, section 5 (KG, KS).
#include "traces/deferred/composition.hpp"
#include "traces/deferred/two_class_surface.hpp"
#include "traces/shader_names.hpp"

#include <utility>

namespace traces {

namespace {

class TwoClassGBuffer final : public pipeline::Shader {
  public:
    TwoClassGBuffer(const pipeline::Frame& frame, SharedMaterials materials)
        : draws_(deferred_draws(frame)), normals_(frame), materials_(std::move(materials)) {}

    ShaderShape shape() const override {
        return {.reads = materials_->count(),
                .registers = materials_->any() ? 8U : 6U,
                .colour = pipeline::FragmentColour::unlit,
                .normal = true,
                .map_texcoords = materials_->any()};
    }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(3 + 1 + 2 + TwoClassSurface::slots_to_pack, input.pixels); // normal, to [0,1], constants
        const DeferredDraw& draw = draws_[input.draw];
        const QuadTexels colours = with_opacity(input.colour, draw);
        const MaterialReads::Quad material = materials_->read(
            input, surfaces, 0, MaterialReads::normals | MaterialReads::shine | MaterialReads::emission);
        if (materials_->glows()) surfaces.issue(slots_to_pack_emission, input.pixels);
        const auto normals = normals_.codes(material.normals, input.front, draw);
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec4 specular(material.shine[i].x, material.shine[i].y / 255.0F, 0.0F, 0.0F);
            output.colours[0][i] =
                TwoClassSurface{colours[i], glm::vec4(normals[i], 0.0F), specular, material.emission[i]}.words();
        }
    }

  private:
    std::vector<DeferredDraw> draws_;
    WorldNormals normals_;
    SharedMaterials materials_;
};

class TwoClassShadow final : public pipeline::Shader {
  public:
    explicit TwoClassShadow(const pipeline::Frame& frame) : draws_(deferred_draws(frame)) {}

    ShaderShape shape() const override { return {.registers = 3, .colour = pipeline::FragmentColour::unlit}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(1 + TwoClassSurface::slots_to_pack, input.pixels);
        const QuadTexels colours = with_opacity(input.colour, draws_[input.draw]);
        for (std::size_t i = 0; i < 4; ++i) output.colours[0][i] = TwoClassSurface{colours[i]}.words();
    }

  private:
    std::vector<DeferredDraw> draws_;
};

class TwoClassComposition final : public Composition {
  public:
    using Composition::Composition;

    ShaderShape shape() const override { return {.reads = 3, .registers = 6}; }

    void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const override {
        surfaces.issue(slots(), input.pixels);
        const QuadPlaces own(input);
        TwoClassQuad seen = read_two_class(surfaces, 0, own.x, own.y, input.pixels);
        const QuadTexels front_light = surfaces.fetch(1, own.x, own.y, input.pixels);
        QuadTexels behind_light = surfaces.fetch(2, own.x, own.y, input.pixels);
        if (refracts()) look_through(own, input.pixels, seen, behind_light, surfaces);
        if (glows()) surfaces.issue(2 * (slots_to_unpack_emission + 1), input.pixels); // and a sum each
        for (std::size_t i = 0; i < 4; ++i) {
            const TwoClassSurface &front = seen.transparent[i], &behind = seen.opaque[i];
            glm::vec3 colour = lit(behind.colour, behind_light[i]) + behind.emission;
            if (is_transparent(front.colour.a))
                colour = laid_over(colour, lit(front.colour, front_light[i]) + front.emission, front.colour.a);
            output.colours[0][i] = glm::vec4(colour, 1.0F);
        }
    }

  private:
    /// The opaque surface aside, unless it lies in front of the pane.
    void look_through(const QuadPlaces& own, unsigned pixels, TwoClassQuad& seen, QuadTexels& behind_light,
                      SurfaceAccess& surfaces) const {
        QuadTexels normals;
        for (std::size_t i = 0; i < 4; ++i) normals[i] = seen.transparent[i].normal;
        const QuadPlaces through = refracted(own, normals);
        const QuadSurfaces aside =
            read_two_class(surfaces, 0, through.x, through.y, pixels, models::opaque_entry, 1).opaque;
        const QuadTexels light = surfaces.fetch(2, through.x, through.y, pixels);
        for (std::size_t i = 0; i < 4; ++i) {
            if (!is_transparent(seen.transparent[i].colour.a) || aside[i].depth < seen.transparent[i].depth) continue;
            seen.opaque[i] = aside[i];
            behind_light[i] = light[i];
        }
    }
};

} // namespace

std::shared_ptr<const pipeline::Shader> two_class_gbuffer_shader(const pipeline::Frame& frame,
                                                                 SharedMaterials materials) {
    return std::make_shared<const TwoClassGBuffer>(frame, std::move(materials));
}

std::shared_ptr<const pipeline::Shader> two_class_shadow_shader(const pipeline::Frame& frame) {
    return std::make_shared<const TwoClassShadow>(frame);
}

std::shared_ptr<const pipeline::Shader> two_class_composition(const pipeline::View& eye,
                                                              const CompositionOptions& options) {
    return std::make_shared<const TwoClassComposition>(eye, options);
}

} // namespace traces
