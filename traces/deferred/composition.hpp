// What the compositions of deferred shading share: a surface in the light that it got, and where one looks through it.
// Source: Aladağlı 2015, section 3.3 (specification 003, B8).
#pragma once

#include "traces/deferred/emission.hpp"
#include "traces/deferred/shadow_filter.hpp"
#include "traces/deferred/world_normals.hpp"

namespace traces {

class Composition : public pipeline::Shader {
  public:
    Composition(const pipeline::View& eye, const CompositionOptions& options)
        : options_(options),
          to_eye_(eye.view),
          width_(static_cast<std::int32_t>(eye.width)),
          height_(static_cast<std::int32_t>(eye.height)) {}

  protected:
    using QuadColours = std::array<glm::vec3, 4>;

    static glm::vec3 lit(const glm::vec4& colour, const glm::vec4& light) { return lit_by(light, glm::vec3(colour)); }
    /// Where one sees through a pane with these normals, on the screen.
    pipeline::QuadPlaces refracted(const pipeline::QuadPlaces& at, const pipeline::QuadTexels& normals) const {
        pipeline::QuadPlaces through = at;
        const auto pixels = static_cast<float>(options_.coefficient * height_);
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec3 normal = to_eye_ * (glm::vec3(normals[i]) * 2.0F - 1.0F);
            const glm::ivec2 to = seen_through({at.x[i], at.y[i]}, normal, pixels, {width_, height_});
            through.x[i] = to.x;
            through.y[i] = to.y;
        }
        return through;
    }
    bool glows() const { return options_.glowing; }
    /// Light that the surfaces at these places send out, of the specular target that the shader knows as `slot`.
    QuadColours glow_at(std::uint32_t slot, const pipeline::QuadPlaces& at, unsigned pixels,
                        pipeline::SurfaceAccess& surfaces) const {
        QuadColours light{};
        if (!glows()) return light;
        const pipeline::QuadTexels texels = surfaces.fetch(slot, at.x, at.y, pixels);
        surfaces.issue(slots_to_unpack_emission + 1, pixels); // and a sum
        for (std::size_t i = 0; i < 4; ++i) light[i] = emission_of_channels({texels[i].b, texels[i].a});
        return light;
    }
    bool refracts() const { return options_.refraction; }
    std::uint32_t slots() const { return refracts() ? slots_refracting : slots_plain; }

  private:
    static constexpr std::uint32_t slots_plain = 14, slots_refracting = 27;

    CompositionOptions options_;
    glm::mat3 to_eye_;
    std::int32_t width_, height_;
};

} // namespace traces
