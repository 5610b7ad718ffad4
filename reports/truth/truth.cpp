#include "reports/truth/truth.hpp"

#include "reports/truth/frame_surfaces.hpp"

#include <algorithm>
#include <atomic>

namespace reports {

namespace {

/// Of one piece of work, with counts of what it asked for.
class FrameRays final : public traces::Rays {
  public:
    FrameRays(const pipeline::Frame& frame, const RayScene& scene, const PixelRays& rays, const FrameSurfaces& surfaces)
        : frame_(frame), scene_(scene), rays_(rays), surfaces_(surfaces) {}

    const pipeline::Frame& frame() const override { return frame_; }
    const traces::ViewRays& view_rays() const override { return rays_.in_eye_space(); }
    WorldRay through(std::uint32_t x, std::uint32_t y) const override { return rays_(x, y); }
    glm::dvec3 place(std::uint32_t x, std::uint32_t y, double distance) const override {
        const WorldRay ray = rays_(x, y);
        return ray.origin + rays_.sense() * distance * ray.step;
    }

    void hits(const WorldRay& ray, std::vector<RayHit>& hits) override {
        ++traced_;
        scene_.hits(ray, hits);
    }
    void occluded(std::span<const WorldRay> rays, bool coherent, std::span<std::uint8_t> occluded) override {
        to_light_ += rays.size();
        scene_.occluded(rays, coherent, occluded);
    }
    double clearance() const override { return scene_.clearance(); }
    std::optional<FrameSurface> surface(const RayHit& hit) const override { return surfaces_.along_ray(hit); }
    void surfaces(std::uint32_t x, std::uint32_t y, PixelSurfaces& seen) override {
        hits(rays_(x, y), hits_);
        surfaces_.find(hits_, x, y, seen);
    }

    std::uint64_t traced() const { return traced_; }
    std::uint64_t to_light() const { return to_light_; }

  private:
    const pipeline::Frame& frame_;
    const RayScene& scene_;
    const PixelRays& rays_;
    const FrameSurfaces& surfaces_;
    std::vector<RayHit> hits_;
    std::uint64_t traced_ = 0, to_light_ = 0;
};

void note(Truth& truth, std::size_t pixel, const PixelSurfaces& surfaces) {
    const std::size_t kept = std::min<std::size_t>(truth.layers, surfaces.layers.size());
    for (std::size_t i = 0; i < kept; ++i)
        truth.depths[pixel * truth.layers + i] = static_cast<float>(surfaces.layers[i].distance);
    truth.surfaces[pixel] = static_cast<std::uint32_t>(surfaces.layers.size()) + (surfaces.has_opaque ? 1 : 0);
    truth.marks[pixel] = static_cast<std::uint8_t>((surfaces.doubtful ? Truth::doubtful_mark : 0) |
                                                   (surfaces.has_opaque ? Truth::opaque_mark : 0));
}

Truth blank_truth(const pipeline::Frame& frame, const traces::TruthMethod& method, const TruthPlan& plan) {
    Truth truth;
    truth.width = frame.view.width;
    truth.height = frame.view.height;
    truth.layers = plan.layers;
    truth.surfaces.resize(truth.pixels());
    truth.depths.resize(truth.pixels() * plan.layers);
    truth.marks.resize(truth.pixels());
    truth.colours.resize(truth.pixels() * 4);
    truth.channels = method.channels;
    for (traces::TruthChannel& channel : truth.channels) {
        channel.values.resize(truth.pixels());
        if (!channel.everywhere) channel.known.resize(truth.pixels());
    }
    return truth;
}

void count(Truth& truth) {
    TruthCounts& counts = truth.counts;
    counts.pixel_rays = truth.pixels();
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel) {
        counts.surfaces += truth.surfaces[pixel];
        counts.deepest = std::max<std::uint64_t>(counts.deepest, truth.surfaces[pixel]);
        counts.pixels_seen += truth.surfaces[pixel] > 0 ? 1 : 0;
        counts.pixels_doubtful += truth.doubtful(pixel) ? 1 : 0;
    }
}

void light(const pipeline::Frame& frame, const RayScene& scene, const TruthPlan& plan, const TracingOptions& options,
           Truth& truth) {
    const std::vector<FirstHit> first = first_hits(scene, frame.view, {options.threads, options.stop, {}});
    std::vector<glm::dvec3> points;
    for (const FirstHit& hit : first)
        if (hit.seen()) points.push_back(hit.position);
    const std::vector<float> seen = light_visibility(scene, points, *plan.light, plan.sampling, options);
    const std::uint64_t parts = light_parts(plan.sampling.rays);
    truth.counts.pixel_rays += first.size();
    truth.counts.light_rays += points.size() * parts * parts;
    truth.visibility.assign(truth.pixels(), 1.0F);
    std::size_t point = 0;
    for (std::size_t pixel = 0; pixel < first.size(); ++pixel) {
        if (!first[pixel].seen()) continue;
        truth.visibility[pixel] = seen[point++];
        truth.counts.pixels_lit += truth.visibility[pixel] > 0.0F ? 1 : 0;
    }
}

} // namespace

Truth trace_truth(const pipeline::Frame& frame, const RayScene& scene, const traces::TruthMethod& method,
                  const TruthPlan& plan, const TracingOptions& options) {
    Truth truth = blank_truth(frame, method, plan);
    const PixelRays rays(frame.view);
    const FrameSurfaces frame_surfaces(frame, scene, rays, method.hides);
    const double share = plan.light ? 0.1 : 1.0; // of the work
    TracingOptions here = options;
    if (options.progress) here.progress = [&](double done) { options.progress(share * done); };
    std::atomic<std::uint64_t> traced = 0, to_light = 0; // by the method itself
    trace_pieces(here, truth.height, [&](std::size_t row) {
        const auto y = static_cast<std::uint32_t>(row);
        RowHits hits;
        PixelSurfaces surfaces;
        FrameRays own(frame, scene, rays, frame_surfaces);
        hits.trace(scene, rays, truth.width, y);
        for (std::uint32_t x = 0; x < truth.width; ++x) {
            frame_surfaces.find(hits.of(x), x, y, surfaces);
            note(truth, truth.pixel(x, y), surfaces);
            method.pixel(own, surfaces, x, y, truth);
        }
        traced += own.traced();
        to_light += own.to_light();
    });
    if (method.finish) method.finish(frame, truth);
    count(truth);
    truth.counts.pixel_rays += traced;
    truth.counts.light_rays += to_light;
    if (!plan.light) return truth;
    if (options.progress) here.progress = [&](double done) { options.progress(share + (1.0 - share) * done); };
    light(frame, scene, plan, here, truth);
    return truth;
}

} // namespace reports
