#include "traces/workloads/translucency_picture.hpp"

#include "models/programs/nearest_k.hpp" // empty_depth
#include "pipeline/functional/sample_pattern.hpp"

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

Translucency::Passage Translucency::passage(std::span<const TranslucentSurface> surfaces, const ViewRays& rays,
                                            std::uint32_t x, std::uint32_t y) const {
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

// For each entry its distance and that of its partner, their length, an exponential, and five products of Fresnel.
models::MakePicture translucency_picture(const Translucency& objects) {
    return [objects](const models::PictureSetup& setup) {
        std::vector<ViewRays> rays;
        for (std::uint32_t sample = 0; sample < setup.view.samples; ++sample)
            rays.emplace_back(setup.view.samples == 1 ? setup.view : view_of_sample(setup.view, sample));
        return models::picture_shader(
            setup, setup.program->k() * 16 + 2,
            [objects, rays = std::move(rays), program = setup.program](const models::PicturePlace& at,
                                                                       const float* pixel, const glm::vec3& behind) {
                std::vector<TranslucentSurface> surfaces;
                read_entries(*program, pixel, rays[at.sample], surfaces);
                return behind *
                       static_cast<float>(objects.passage(surfaces, rays[at.sample], at.x, at.y).transmittance);
            });
    };
}

} // namespace traces
