#include "traces/workloads/csg_surface.hpp"

#include "models/programs/nearest_k.hpp" // empty_depth

namespace traces {

CsgSurface csg_surface(const pipeline::Frame& frame, std::span<const float> kbuffer, const CsgExpression& expression) {
    const std::size_t pixels = std::size_t{frame.view.width} * frame.view.height, draws = frame.draws.size();
    const pipeline::EyeDepth depth(frame.view.projection);
    CsgSurface surface{SurfaceImage(frame.view), std::vector<std::uint32_t>(pixels)};
    CsgWalk walk(expression, draws);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const float* entry = kbuffer.data() + pixel * frame.program->floats_per_pixel();
        walk.begin();
        for (std::uint32_t i = 0; i < frame.program->k() && entry[0] != models::empty_depth; ++i) {
            const auto object =
                static_cast<std::uint32_t>(std::min<std::size_t>(static_cast<std::size_t>(entry[1]), draws - 1));
            if (walk.cross(object)) {
                surface.image.set_distance(pixel, depth.distance(entry[0]));
                surface.objects[pixel] = object;
                break;
            }
            entry += frame.program->floats_per_entry();
        }
    }
    return surface;
}

} // namespace traces
