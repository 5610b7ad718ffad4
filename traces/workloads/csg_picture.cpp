#include "traces/workloads/csg_picture.hpp"

#include "pipeline/functional/eye_depth.hpp"

namespace traces {

namespace {

glm::vec3 colour_of(const pipeline::Frame& frame, std::uint32_t draw) {
    return glm::vec3(frame.resources->materials[frame.draws[draw].material].base_colour);
}

} // namespace

// For each entry a bit is turned over and the expression looked up.
models::MakePicture csg_picture(const pipeline::Frame& frame, const CsgExpression& expression) {
    std::vector<glm::vec3> colours;
    for (std::uint32_t draw = 0; draw < frame.draws.size(); ++draw) colours.push_back(colour_of(frame, draw));
    return [expression, colours = std::move(colours)](const models::PictureSetup& setup) {
        SurfaceLook look;
        look.find = [expression, program = setup.program, draws = colours.size(),
                     depth = pipeline::EyeDepth(setup.view.projection)](const float* pixel) {
            CsgWalk walk(expression, draws);
            return csg_of_pixel(*program, pixel, depth, walk, draws);
        };
        look.instructions_to_find = setup.program->k() * 3;
        look.colour = [colours](std::uint32_t draw) { return colours[draw]; };
        return surface_shader(setup, std::move(look));
    };
}

std::vector<float> shaded(const pipeline::Frame& frame, const CsgSurface& surface) {
    const SurfaceImage& image = surface.image;
    std::vector<float> picture;
    picture.reserve(surface.objects.size() * 4);
    for (std::uint32_t y = 0; y < image.height(); ++y)
        for (std::uint32_t x = 0; x < image.width(); ++x) {
            glm::vec3 colour(frame.background);
            if (image.sees(x, y))
                colour =
                    colour_of(frame, surface.objects[picture.size() / 4]) * static_cast<float>(image.lambert(x, y));
            picture.insert(picture.end(), {colour.r, colour.g, colour.b, 1.0F});
        }
    return picture;
}

} // namespace traces
