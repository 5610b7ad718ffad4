// What the compositions of deferred shading share: a surface in the light that it got, and where one looks through it.
// Source: Aladağlı 2015, section 3.3 (specification 003, B8).
#pragma once

#include "traces/deferred/world_normals.hpp"

#include <algorithm>
#include <cmath>

namespace traces {

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
    pipeline::QuadPlaces refracted(const pipeline::QuadPlaces& at, const pipeline::QuadTexels& normals) const {
        pipeline::QuadPlaces through = at;
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
    std::uint32_t slots() const { return refracts() ? slots_refracting : slots_plain; }

  private:
    static constexpr std::uint32_t slots_plain = 14, slots_refracting = 27;

    CompositionOptions options_;
    glm::mat3 to_eye_;
    std::int32_t width_, height_;
};

} // namespace traces
