// The picture of translucent objects (specification 004, A12): light of the background, absorbed along the ray of each
// pixel.
//
// Each object is homogeneous with a closed surface. Its surfaces, from front to back, are by turns where the ray enters
// it and where it leaves; the lengths between, along the ray, are attenuated by exp(-sigma * length). A surface without
// a partner (of an open mesh, or because the exit did not fit into k entries) begins no length. Each surface also
// transmits 1 - (1 - cos)^5 of the light, Schlick's Fresnel term without reflection at normal incidence.
#pragma once

#include "models/programs/picture_shader.hpp"
#include "traces/view_rays.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace traces {

/// A surface that the ray of a pixel crosses.
struct TranslucentSurface {
    double distance = 0.0; ///< along the view axis
    std::uint32_t draw = 0;
    float cosine = 1.0F; ///< between ray and normal; with Fresnel only
};

class Translucency {
  public:
    /// `sigma`: extinction of each draw, or of the one object that all draws are the surface of.
    Translucency(std::vector<double> sigma, bool fresnel) : sigma_(std::move(sigma)), fresnel_(fresnel) {}

    struct Passage {
        double transmittance = 1.0;
        double inside = 0.0; ///< length within all objects, each counted on its own
    };
    /// Through any number of surfaces, from front to back, on the ray of pixel (x, y).
    Passage passage(std::span<const TranslucentSurface> surfaces, const ViewRays& rays, std::uint32_t x,
                    std::uint32_t y) const;

  private:
    std::vector<double> sigma_;
    bool fresnel_;
};

/// Entries are depth, then, as far as there are any, object and cosine.
models::MakePicture translucency_picture(const Translucency& objects);

} // namespace traces
