// Pictures of textures over coordinates that are linear, as the own sampler and OpenGL make them.
#pragma once

#include "pipeline/texture_lookup.hpp"
#include "tests/support/mesa_shaders.hpp"

#include <functional>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace tests {

/// Coordinates at (x, y), which run from -1 to 1 over the picture.
struct LinearPlace {
    glm::vec4 base{0.0F}, right{0.0F}, up{0.0F};

    LinearInput input() const; ///< "vec4 place"
    float at(int component, float x, float y) const {
        return base[component] + x * right[component] + y * up[component];
    }
};

/// Colours of MesaShaders::size squared pixels, row 0 first. `complete` changes the lookup of a quad that has its
/// place already.
std::vector<glm::vec4> own_texture_picture(const MesaTexture& texture, pipeline::TextureKind kind, bool arrayed,
                                           const LinearPlace& place,
                                           const std::function<void(pipeline::TextureLookup&)>& complete = {});

/// `expression` of GLSL 4.50 with the texture `t` of type `sampler` and the coordinates `place`.
std::vector<glm::vec4> mesa_texture_picture(MesaShaders& mesa, const MesaTexture& texture, const std::string& sampler,
                                            const std::string& expression, const LinearPlace& place);
std::string texture_shader(const std::string& sampler, const std::string& expression);

struct PictureDifference {
    double worst = 0; ///< of a channel, in 255ths
    int pixels = 0;   ///< whose 8-bit codes differ by more than `codes`
};
PictureDifference difference_of(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b, long codes);

/// Texels of value(level, plane, x, y) in each level, in the surface's format.
void fill(traces::RecordedSurface& surface, std::uint32_t levels,
          const std::function<glm::vec4(std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t)>& value);

} // namespace tests
