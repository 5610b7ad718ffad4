#include "tests/support/texture_pictures.hpp"

#include "pipeline/functional/quad_sampler.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "traces/recording/textures.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tests {

LinearInput LinearPlace::input() const {
    LinearInput input;
    input.declaration = "vec4 place";
    input.type = "vec4";
    input.name = "place";
    input.components = 4;
    for (int i = 0; i < 4; ++i) {
        const auto component = static_cast<std::size_t>(i);
        input.base[component] = base[i];
        input.right[component] = right[i];
        input.up[component] = up[i];
    }
    return input;
}

std::vector<glm::vec4> own_texture_picture(const MesaTexture& texture, pipeline::TextureKind kind, bool arrayed,
                                           const LinearPlace& place,
                                           const std::function<void(pipeline::TextureLookup&)>& complete) {
    constexpr std::uint32_t size = MesaShaders::size;
    const pipeline::SurfaceInfo info = traces::surface_of(texture.surface);
    const pipeline::SurfaceStore store(std::span(&info, 1));
    constexpr std::array<pipeline::SurfaceId, 1> slots{0};
    pipeline::SurfaceAccess access(store, slots);
    const pipeline::TextureView view{.kind = kind,
                                     .arrayed = arrayed,
                                     .base_level = texture.binding.base_level,
                                     .last_level = texture.binding.last_level,
                                     .swizzle = texture.binding.swizzle};
    pipeline::QuadSampler sampler(access, view, texture.sampler);
    std::vector<glm::vec4> picture(std::size_t{size} * size);
    for (std::uint32_t y = 0; y < size; y += 2)
        for (std::uint32_t x = 0; x < size; x += 2) {
            const auto along = [](std::uint32_t pixel) { return 2 * (static_cast<float>(pixel) + 0.5F) / size - 1; };
            pipeline::TextureLookup lookup;
            for (std::uint32_t lane = 0; lane < 4; ++lane)
                for (int i = 0; i < 4; ++i)
                    lookup.place[static_cast<std::size_t>(i)][lane] =
                        place.at(i, along(x + lane % 2), along(y + lane / 2));
            if (complete) complete(lookup);
            const pipeline::QuadTexels texels = sampler.sample(lookup);
            for (std::uint32_t lane = 0; lane < 4; ++lane)
                picture[std::size_t{y + lane / 2} * size + x + lane % 2] = texels[lane];
        }
    return picture;
}

std::string texture_shader(const std::string& sampler, const std::string& expression) {
    return fmt::format("#version 450\nin vec4 place;\nuniform {} t;\nlayout(location = 0) out vec4 colour;\n"
                       "void main() {{ colour = {}; }}\n",
                       sampler, expression);
}

std::vector<glm::vec4> mesa_texture_picture(MesaShaders& mesa, const MesaTexture& texture, const std::string& sampler,
                                            const std::string& expression, const LinearPlace& place) {
    mesa.set_texture(&texture);
    const ShaderPicture picture = mesa.draw(
        texture_shader(sampler, expression), "#version 450", {place.input()},
        [](const ActiveUniform&, std::uint32_t) { return 0.0F; },
        [](const ActiveBlock&, std::uint32_t) { return 0.0F; }, [](const ActiveUniform&) { return 0U; });
    mesa.set_texture(nullptr);
    std::vector<glm::vec4> colours;
    for (const std::array<float, 4>& pixel : picture.colour)
        colours.emplace_back(pixel[0], pixel[1], pixel[2], pixel[3]);
    return colours;
}

PictureDifference difference_of(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b, long codes) {
    PictureDifference difference;
    for (std::size_t i = 0; i < a.size(); ++i) {
        bool differs = false;
        for (int c = 0; c < 4; ++c) {
            const double own = 255.0 * a[i][c], other = 255.0 * b.at(i)[c];
            difference.worst = std::max(difference.worst, std::abs(own - other));
            differs |= std::abs(std::lround(own) - std::lround(other)) > codes;
        }
        difference.pixels += differs ? 1 : 0;
    }
    return difference;
}

void fill(traces::RecordedSurface& surface, std::uint32_t levels,
          const std::function<glm::vec4(std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t)>& value) {
    surface.levels.assign(levels, {});
    const pipeline::SurfaceInfo info = traces::surface_of(surface);
    for (std::uint32_t level = 0; level < levels; ++level) {
        std::vector<std::byte> texels;
        for (std::uint32_t plane = 0; plane < info.planes_of(level); ++plane)
            for (std::uint32_t y = 0; y < info.height_of(level); ++y)
                for (std::uint32_t x = 0; x < info.width_of(level); ++x) {
                    std::array<std::byte, pipeline::largest_texel> texel{};
                    const glm::vec4 colour = value(level, plane, x, y);
                    if (pipeline::has_depth(surface.format))
                        pipeline::pack_depth_stencil(surface.format,
                                                     {pipeline::depth_code(surface.format, colour.r), 0}, texel.data());
                    else if (pipeline::is_integer(surface.format))
                        pipeline::pack_integers(surface.format, glm::uvec4(colour), texel.data());
                    else
                        pipeline::pack_colour(surface.format, colour, texel.data());
                    texels.insert(texels.end(), texel.begin(), texel.begin() + info.texel_bytes());
                }
        surface.levels[level] = std::move(texels);
    }
}

} // namespace tests
