#include "traces/workloads/translucency_picture.hpp"

#include "models/programs/nearest_k.hpp" // empty_depth

#include <algorithm>
#include <cmath>
#include <limits>

namespace traces {

namespace {

double fresnel_transmittance(float cosine) {
    const double grazing = 1.0 - static_cast<double>(cosine);
    return 1.0 - grazing * grazing * grazing * grazing * grazing;
}

/// The surfaces in the entries of a pixel: depth, then, as far as there are any, object and cosine.
void read_entries(const pipeline::ModifyProgram& program, const float* pixel, const ViewRays& rays,
                  std::vector<TranslucentSurface>& surfaces) {
    const std::uint32_t floats = program.floats_per_entry();
    surfaces.clear();
    for (std::uint32_t i = 0; i < program.k(); ++i) {
        const float* entry = pixel + std::size_t{i} * floats;
        if (entry[0] == models::empty_depth) return;
        surfaces.push_back({rays.distance(entry[0]), floats > 1 ? static_cast<std::uint32_t>(entry[1]) : 0,
                            floats > 2 ? entry[2] : 1.0F});
    }
}

} // namespace

TranslucencyPicture::Passage TranslucencyPicture::passage(std::span<const TranslucentSurface> surfaces,
                                                          const ViewRays& rays, std::uint32_t x,
                                                          std::uint32_t y) const {
    constexpr double outside = std::numeric_limits<double>::infinity();
    std::vector<double> entered(sigma_.size(), outside);
    Passage passage;
    double optical_depth = 0.0, transmitted = 1.0;
    for (const TranslucentSurface& surface : surfaces) {
        if (fresnel_) transmitted *= fresnel_transmittance(surface.cosine);
        const std::size_t object = std::min<std::size_t>(surface.draw, sigma_.size() - 1);
        if (entered[object] == outside) {
            entered[object] = surface.distance;
            continue;
        }
        const double length = rays.length(x, y, entered[object], surface.distance);
        passage.inside += length;
        optical_depth += sigma_[object] * length;
        entered[object] = outside;
    }
    passage.transmittance = transmitted * std::exp(-optical_depth);
    return passage;
}

std::vector<float> TranslucencyPicture::picture(const pipeline::Frame& frame,
                                                const pipeline::FinishedSurfaces& finished) const {
    const std::span<const float> kbuffer = finished.kbuffer;
    const ViewRays rays(frame.view);
    const std::size_t floats = frame.program->floats_per_pixel();
    std::vector<TranslucentSurface> surfaces;
    std::vector<float> picture;
    picture.reserve(kbuffer.size() / floats * 4);
    for (std::uint32_t y = 0; y < frame.view.height; ++y)
        for (std::uint32_t x = 0; x < frame.view.width; ++x) {
            read_entries(*frame.program, kbuffer.data() + picture.size() / 4 * floats, rays, surfaces);
            const auto light = static_cast<float>(passage(surfaces, rays, x, y).transmittance);
            const glm::vec3 colour = glm::vec3(frame.background) * light;
            picture.insert(picture.end(), {colour.r, colour.g, colour.b, 1.0F});
        }
    return picture;
}

} // namespace traces
