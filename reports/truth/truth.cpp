#include "reports/truth/truth.hpp"

#include "reports/truth/frame_surfaces.hpp"
#include "sim/check.hpp"
#include "traces/workloads/csg_picture.hpp"
#include "traces/workloads/translucency_picture.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reports {

namespace {

constexpr std::array<std::string_view, 4> known_workloads{"transparency", "translucency", "csg", "opaque"};
constexpr std::array<std::string_view, 3> compositing_programs{"nearest-k", "order-and-blend", "mlab"};

/// Makes the picture of a workload from the surfaces of its pixels.
class Composition {
  public:
    Composition(const pipeline::Frame& frame, const PixelRays& rays, Truth& truth)
        : frame_(frame),
          rays_(rays),
          truth_(truth),
          translucency_(dynamic_cast<const traces::TranslucencyPicture*>(frame.resolve.get())),
          csg_(dynamic_cast<const traces::CsgPicture*>(frame.resolve.get())),
          solid_{traces::SurfaceImage(frame.view), {}} {
        if (csg_ != nullptr) solid_.objects.resize(truth.pixels());
        if (csg_ != nullptr) truth.solid.resize(truth.pixels());
        if (translucency_ != nullptr) truth.inside.resize(truth.pixels());
        truth.colours.resize(truth.pixels() * 4);
    }

    void take(std::uint32_t x, std::uint32_t y, const PixelSurfaces& surfaces) {
        const std::size_t pixel = std::size_t{y} * truth_.width + x;
        if (csg_ != nullptr)
            find_solid(pixel, surfaces);
        else
            set(pixel, translucency_ != nullptr ? attenuated(x, y, pixel, surfaces) : layered(surfaces));
    }

    /// After the last pixel.
    void finish() {
        if (csg_ != nullptr) truth_.colours = traces::CsgPicture::shaded(frame_, solid_);
    }

  private:
    void set(std::size_t pixel, const glm::dvec3& colour) {
        for (std::size_t i = 0; i < 3; ++i)
            truth_.colours[pixel * 4 + i] = static_cast<float>(colour[static_cast<glm::length_t>(i)]);
        truth_.colours[pixel * 4 + 3] = 1.0F;
    }

    glm::dvec3 layered(const PixelSurfaces& surfaces) const {
        const auto opacity = static_cast<double>(frame_.opacity);
        glm::dvec3 colour(0.0);
        double transmitted = 1.0;
        for (const FrameSurface& layer : surfaces.layers) {
            colour += transmitted * opacity * glm::dvec3(layer.colour);
            transmitted *= 1.0 - opacity;
        }
        return colour +
               transmitted * glm::dvec3(surfaces.has_opaque ? surfaces.opaque.colour : glm::vec3(frame_.background));
    }

    glm::dvec3 attenuated(std::uint32_t x, std::uint32_t y, std::size_t pixel, const PixelSurfaces& surfaces) {
        std::vector<traces::TranslucentSurface> crossed;
        for (const FrameSurface& layer : surfaces.layers)
            crossed.push_back({layer.distance, layer.draw, layer.colour.r}); // the shader gives cosines as colours
        const auto passage = translucency_->passage(crossed, rays_.in_eye_space(), x, y);
        truth_.inside[pixel] = static_cast<float>(passage.inside);
        return glm::dvec3(glm::vec3(frame_.background)) * passage.transmittance;
    }

    void find_solid(std::size_t pixel, const PixelSurfaces& surfaces) {
        traces::CsgWalk walk(csg_->expression(), frame_.draws.size());
        for (const FrameSurface& layer : surfaces.layers) {
            if (!walk.cross(layer.draw)) continue;
            truth_.solid[pixel] = static_cast<float>(layer.distance);
            truth_.marks[pixel] |= Truth::solid_mark;
            solid_.image.set_distance(pixel, layer.distance);
            solid_.objects[pixel] = layer.draw;
            return;
        }
    }

    const pipeline::Frame& frame_;
    const PixelRays& rays_;
    Truth& truth_;
    const traces::TranslucencyPicture* translucency_;
    const traces::CsgPicture* csg_;
    traces::CsgSurface solid_;
};

void note(Truth& truth, std::size_t pixel, const PixelSurfaces& surfaces) {
    const std::size_t kept = std::min<std::size_t>(truth.layers, surfaces.layers.size());
    for (std::size_t i = 0; i < kept; ++i)
        truth.depths[pixel * truth.layers + i] = static_cast<float>(surfaces.layers[i].distance);
    truth.surfaces[pixel] = static_cast<std::uint32_t>(surfaces.layers.size()) + (surfaces.has_opaque ? 1 : 0);
    truth.marks[pixel] = static_cast<std::uint8_t>((surfaces.doubtful ? Truth::doubtful_mark : 0) |
                                                   (surfaces.has_opaque ? Truth::opaque_mark : 0));
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
    truth.counts.light_rays = points.size() * parts * parts;
    truth.visibility.assign(truth.pixels(), 1.0F);
    std::size_t point = 0;
    for (std::size_t pixel = 0; pixel < first.size(); ++pixel) {
        if (!first[pixel].seen()) continue;
        truth.visibility[pixel] = seen[point++];
        truth.counts.pixels_lit += truth.visibility[pixel] > 0.0F ? 1 : 0;
    }
}

} // namespace

void check_truth(const pipeline::Frame& frame) {
    if (std::find(known_workloads.begin(), known_workloads.end(), frame.workload) == known_workloads.end())
        throw sim::InputError(
            fmt::format("truth: expected a workload of {}, got {}", fmt::join(known_workloads, ", "), frame.workload));
    if (frame.workload != "transparency" || frame.program == nullptr) return;
    if (std::find(compositing_programs.begin(), compositing_programs.end(), frame.program->id()) ==
        compositing_programs.end())
        throw sim::InputError(fmt::format("truth: workload transparency: program: expected one of {}, got {}",
                                          fmt::join(compositing_programs, ", "), frame.program->id()));
    if (!frame.needs.colours)
        throw sim::InputError("truth: workload transparency: entry: expected rgbz, the one that has colours");
}

Truth trace_truth(const pipeline::Frame& frame, const RayScene& scene, const TruthPlan& plan,
                  const TracingOptions& options) {
    check_truth(frame);
    Truth truth;
    truth.width = frame.view.width;
    truth.height = frame.view.height;
    truth.layers = plan.layers;
    truth.surfaces.resize(truth.pixels());
    truth.depths.resize(truth.pixels() * plan.layers);
    truth.marks.resize(truth.pixels());

    const PixelRays rays(frame.view);
    const FrameSurfaces frame_surfaces(frame, scene, rays);
    Composition composition(frame, rays, truth);
    const double share = plan.light ? 0.1 : 1.0; // of the work
    TracingOptions here = options;
    if (options.progress) here.progress = [&](double done) { options.progress(share * done); };
    trace_pieces(here, truth.height, [&](std::size_t row) {
        const auto y = static_cast<std::uint32_t>(row);
        RowHits hits;
        PixelSurfaces surfaces;
        hits.trace(scene, rays, truth.width, y);
        for (std::uint32_t x = 0; x < truth.width; ++x) {
            frame_surfaces.find(hits.of(x), x, y, surfaces);
            note(truth, row * truth.width + x, surfaces);
            composition.take(x, y, surfaces);
        }
    });
    composition.finish();
    count(truth);
    if (!plan.light) return truth;
    if (options.progress) here.progress = [&](double done) { options.progress(share + (1.0 - share) * done); };
    light(frame, scene, plan, here, truth);
    return truth;
}

} // namespace reports
