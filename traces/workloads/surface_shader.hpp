// The picture of the one surface that every pixel of a k-buffer sees, lit from the eye, as the shader of a pass over
// the screen: normals are differences of distances, so a pixel also looks at its four neighbours.
#pragma once

#include "models/programs/picture_shader.hpp"
#include "traces/workloads/surface_image.hpp"

#include <functional>

namespace traces {

struct PixelSurface {
    double distance = SurfaceShape::none; ///< along the view axis; none: the pixel sees none
    std::uint32_t kind = 0;               ///< what surface it is
};

struct SurfaceLook {
    /// The surface of a pixel, from its program's floats, drained.
    std::function<PixelSurface(const float* pixel)> find;
    std::uint32_t instructions_to_find = 0;
    std::function<glm::vec3(std::uint32_t kind)> colour; ///< in full light
    bool silhouettes = false;                            ///< are drawn dark
};

/// Lambert's law with the lamp at the eye; the background where there is no surface. The mean of each pixel's samples.
std::shared_ptr<const pipeline::Shader> surface_shader(const models::PictureSetup& setup, SurfaceLook look);

} // namespace traces
