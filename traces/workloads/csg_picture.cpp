#include "traces/workloads/csg_picture.hpp"

namespace traces {

std::vector<float> CsgPicture::picture(const pipeline::Frame& frame, const pipeline::FinishedSurfaces& surfaces) const {
    return shaded(frame, csg_surface(frame, surfaces.kbuffer, expression_));
}

std::vector<float> CsgPicture::shaded(const pipeline::Frame& frame, const CsgSurface& surface) {
    const SurfaceImage& image = surface.image;
    std::vector<float> picture;
    picture.reserve(surface.objects.size() * 4);
    for (std::uint32_t y = 0; y < image.height(); ++y)
        for (std::uint32_t x = 0; x < image.width(); ++x) {
            glm::vec3 colour(frame.background);
            if (image.sees(x, y)) {
                const pipeline::Draw& draw = frame.draws[surface.objects[picture.size() / 4]];
                colour = glm::vec3(frame.resources->materials[draw.material].base_colour) *
                         static_cast<float>(image.lambert(x, y));
            }
            picture.insert(picture.end(), {colour.r, colour.g, colour.b, 1.0F});
        }
    return picture;
}

} // namespace traces
