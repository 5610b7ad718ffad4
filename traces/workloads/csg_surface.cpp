#include "traces/workloads/csg_surface.hpp"

#include "models/programs/nearest_k.hpp" // empty_depth

namespace traces {

PixelSurface csg_of_pixel(const pipeline::ModifyProgram& program, const float* pixel, const pipeline::EyeDepth& depth,
                          CsgWalk& walk, std::size_t draws) {
    walk.begin();
    const float* entry = pixel;
    for (std::uint32_t i = 0; i < program.k() && entry[0] != models::empty_depth; ++i) {
        const auto object =
            static_cast<std::uint32_t>(std::min<std::size_t>(static_cast<std::size_t>(entry[1]), draws - 1));
        if (walk.cross(object)) return {depth.distance(entry[0]), object};
        entry += program.floats_per_entry();
    }
    return {};
}

CsgSurface csg_surface(const pipeline::Frame& frame, std::span<const float> kbuffer, const CsgExpression& expression) {
    const std::size_t draws = frame.draws.size();
    const pipeline::EyeDepth depth(frame.view.projection);
    CsgSurface surface{SurfaceImage(frame.view), std::vector<std::uint32_t>(frame.view.pixels())};
    CsgWalk walk(expression, draws);
    for (std::size_t pixel = 0; pixel < surface.objects.size(); ++pixel) {
        const float* entries = kbuffer.data() + pixel * frame.program->floats_per_pixel();
        const PixelSurface found = csg_of_pixel(*frame.program, entries, depth, walk, draws);
        surface.image.set_distance(pixel, found.distance);
        surface.objects[pixel] = found.kind;
    }
    return surface;
}

} // namespace traces
