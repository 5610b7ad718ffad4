#include "reports/truth/silhouettes.hpp"

#include "reports/truth/frame_surfaces.hpp"
#include "reports/truth/pixel_rays.hpp"

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

namespace reports {

namespace {

/// What the rays of a frame see when all of them are moved by some pixels.
class MovedRays {
  public:
    MovedRays(const pipeline::Frame& frame, const RayScene& scene, const traces::TruthMethod& method, double x,
              double y)
        : frame_(moved(frame, x, y)),
          scene_(scene),
          rays_(frame_.view),
          surfaces_(frame_, scene, rays_, method.hides) {}

    void find(std::uint32_t x, std::uint32_t y, PixelSurfaces& found) {
        scene_.hits(rays_(x, y), hits_);
        surfaces_.find(hits_, x, y, found);
    }

  private:
    static pipeline::Frame moved(pipeline::Frame frame, double x, double y) {
        const glm::dvec3 by(-2.0 * x / frame.view.width, 2.0 * y / frame.view.height, 0.0);
        frame.view.projection = glm::mat4(glm::translate(glm::dmat4(1.0), by) * glm::dmat4(frame.view.projection));
        return frame;
    }

    pipeline::Frame frame_;
    const RayScene& scene_;
    PixelRays rays_;
    FrameSurfaces surfaces_;
    std::vector<RayHit> hits_;
};

bool coplanar(const PixelSurfaces& surfaces) {
    const auto near = [](const FrameSurface& a, const FrameSurface& b) {
        return std::fabs(a.distance - b.distance) <= coplanar_share * std::fabs(a.distance);
    };
    for (std::size_t i = 0; i + 1 < surfaces.layers.size(); ++i)
        if (near(surfaces.layers[i], surfaces.layers[i + 1])) return true;
    return surfaces.has_opaque && !surfaces.layers.empty() && near(surfaces.layers.back(), surfaces.opaque);
}

} // namespace

void mark_uncertain(Truth& truth, const pipeline::Frame& frame, const RayScene& scene,
                    const traces::TruthMethod& method, std::span<const std::uint32_t> pixels) {
    std::vector<std::size_t> seen(pixels.size());
    const auto number = [](const PixelSurfaces& surfaces) {
        return 2 * surfaces.layers.size() + (surfaces.has_opaque ? 1 : 0);
    };
    PixelSurfaces surfaces;
    constexpr std::array<std::pair<int, int>, 5> steps{{{0, 0}, {-1, -1}, {-1, 1}, {1, -1}, {1, 1}}};
    for (const auto& [x, y] : steps) {
        MovedRays rays(frame, scene, method, x * silhouette_grid, y * silhouette_grid);
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            rays.find(pixels[i] % truth.width, pixels[i] / truth.width, surfaces);
            const bool centre = x == 0;
            if (centre) seen[i] = number(surfaces);
            if (centre ? coplanar(surfaces) : number(surfaces) != seen[i])
                truth.marks[pixels[i]] |= Truth::doubtful_mark;
        }
    }
}

} // namespace reports
