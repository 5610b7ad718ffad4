#include "traces/rays.hpp"

namespace traces {

void TruthPicture::set_colour(std::size_t pixel, const glm::dvec3& colour) {
    for (std::size_t i = 0; i < 3; ++i)
        colours[pixel * 4 + i] = static_cast<float>(colour[static_cast<glm::length_t>(i)]);
    colours[pixel * 4 + 3] = 1.0F;
}

TruthMethod layered_truth(float opacity) {
    TruthMethod method;
    method.pixel = [alpha = static_cast<double>(opacity)](Rays& rays, const PixelSurfaces& surfaces, std::uint32_t x,
                                                          std::uint32_t y, TruthPicture& picture) {
        glm::dvec3 colour(0.0);
        double transmitted = 1.0;
        for (const FrameSurface& layer : surfaces.layers) {
            colour += transmitted * alpha * glm::dvec3(layer.colour);
            transmitted *= 1.0 - alpha;
        }
        colour += transmitted * glm::dvec3(surfaces.has_opaque ? surfaces.opaque.colour : rays.frame().background);
        picture.set_colour(picture.pixel(x, y), colour);
    };
    return method;
}

} // namespace traces
