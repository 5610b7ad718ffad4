#include "traces/workloads/isosurface_picture.hpp"

#include "models/programs/isosurface.hpp"
#include "models/programs/nearest_k.hpp" // empty_depth
#include "traces/workloads/surface_shader.hpp"

namespace traces {

namespace {

constexpr std::array<glm::vec3, 6> colours{{{0.85F, 0.55F, 0.2F},
                                            {0.2F, 0.5F, 0.85F},
                                            {0.4F, 0.7F, 0.25F},
                                            {0.8F, 0.25F, 0.25F},
                                            {0.6F, 0.4F, 0.75F},
                                            {0.85F, 0.8F, 0.3F}}};

} // namespace

models::MakePicture isosurface_picture(bool silhouettes) {
    return [silhouettes](const models::PictureSetup& setup) {
        SurfaceLook look;
        look.find = [program = setup.program](const float* pixel) -> PixelSurface {
            const auto state = models::isosurface_state(*program, pixel);
            if (state.distance == models::empty_depth || !(state.iso >= 0.0F)) return {};
            return {static_cast<double>(state.distance), static_cast<std::uint32_t>(state.iso)};
        };
        look.instructions_to_find = 2;
        look.colour = [](std::uint32_t iso) { return colours[iso % colours.size()]; };
        look.silhouettes = silhouettes;
        return surface_shader(setup, std::move(look));
    };
}

} // namespace traces
