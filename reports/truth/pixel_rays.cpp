#include "reports/truth/pixel_rays.hpp"

#include "pipeline/functional/parallel.hpp"
#include "sim/check.hpp"

#include <mutex>

namespace reports {

void trace_pieces(const TracingOptions& options, std::size_t count, const std::function<void(std::size_t)>& piece) {
    std::mutex mutex;
    std::size_t done = 0;
    pipeline::parallel_for(options.threads, count, [&](std::size_t i) {
        if (options.stop != nullptr && *options.stop) throw sim::Interrupted();
        piece(i);
        if (!options.progress) return;
        const std::lock_guard lock(mutex);
        options.progress(static_cast<double>(++done) / static_cast<double>(count));
    });
}

PixelRays::PixelRays(const pipeline::View& view)
    : rays_(view),
      to_world_(glm::inverse(glm::dmat4(view.view))),
      near_(rays_.distance(0.0F)),
      far_(rays_.distance(1.0F)),
      sense_(far_ < near_ ? -1.0 : 1.0),
      perspective_(view.projection[2][3] != 0.0F) {}

WorldRay PixelRays::operator()(std::uint32_t x, std::uint32_t y) const {
    const glm::dvec3 from = rays_.place(x, y, near_), step = rays_.place(x, y, near_ + sense_) - from;
    WorldRay ray;
    ray.step = glm::dvec3(to_world_ * glm::dvec4(step, 0.0));
    ray.begin = sense_ * near_;
    ray.end = sense_ * far_;
    ray.origin = glm::dvec3(to_world_ * glm::dvec4(from, 1.0)) - ray.begin * ray.step;
    return ray;
}

void RowHits::trace(const RayScene& scene, const PixelRays& rays, std::uint32_t width, std::uint32_t y) {
    hits_.clear();
    first_.assign(1, 0);
    for (std::uint32_t x = 0; x < width; ++x) {
        scene.hits(rays(x, y), pixel_);
        hits_.insert(hits_.end(), pixel_.begin(), pixel_.end());
        first_.push_back(hits_.size());
    }
}

std::vector<FirstHit> first_hits(const RayScene& scene, const pipeline::View& view, const TracingOptions& options) {
    const PixelRays rays(view);
    std::vector<FirstHit> result(std::size_t{view.width} * view.height);
    trace_pieces(options, view.height, [&](std::size_t y) {
        std::vector<RayHit> hits;
        for (std::uint32_t x = 0; x < view.width; ++x) {
            const WorldRay ray = rays(x, static_cast<std::uint32_t>(y));
            scene.hits(ray, hits);
            for (const RayHit& hit : hits) {
                if (!scene.stands(hit)) continue;
                const glm::dvec3 normal = scene.normal(hit);
                if (normal == glm::dvec3(0.0)) continue;
                result[y * view.width + x] = {ray.origin + hit.t * ray.step, hit.front ? normal : -normal, hit.draw,
                                              hit.triangle};
                break;
            }
        }
    });
    return result;
}

} // namespace reports
