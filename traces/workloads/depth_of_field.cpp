// Depth of field: the nearest surface in each of three ranges of distance, each range blurred by its circles of
// confusion and laid over the one behind.
//
// Source: Bavoil 2007, section 6.2.1 (specification 004, A14), where the kernel is not stated; discs of a thin lens
// here.
#include "models/programs/depth_partition.hpp"
#include "models/programs/nearest_k.hpp" // empty_depth
#include "sim/check.hpp"
#include "traces/view_rays.hpp"
#include "traces/workloads/lens_blur.hpp"
#include "traces/workloads/methods.hpp"

#include <cmath>

namespace traces {

namespace {

constexpr const char* option_owner = "workload depth-of-field";

struct DepthOfFieldParams {
    double focus = 0.0;
    double aperture = 0.0;
    double focal_length = 0.0;
    std::array<double, 2> range = {0.0, 0.0};
    double largest_blur = 64.0;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};

    static constexpr auto fields() {
        using P = DepthOfFieldParams;
        return std::tuple(
            sim::field<&P::focus>("distance along the view axis that is sharp; 0 = the middle of the scene")
                .range(0.0, 1e30),
            sim::field<&P::aperture>("diameter of the lens in scene units; 0 = a twentieth of the focus distance")
                .range(0.0, 1e30),
            sim::field<&P::focal_length>(
                "of the lens in scene units, less than the focus distance; 0 = a fiftieth of it")
                .range(0.0, 1e30),
            sim::field<&P::range>(
                "distances where the middle range begins and ends; 0 = at a third and at two thirds of "
                "the scene's depth")
                .range(0.0, 1e30),
            sim::field<&P::largest_blur>("bound of the circle of confusion").unit("px").range(1.0, 512.0),
            sim::field<&P::background>("linear RGB behind everything").range(0.0F, 1.0F));
    }
};
static_assert(sim::fully_described<DepthOfFieldParams>);

class DepthOfFieldPicture final : public pipeline::Resolve {
  public:
    DepthOfFieldPicture(const Lens& lens, double largest_blur) : lens_(lens), largest_blur_(largest_blur) {}

    std::vector<float> picture(const pipeline::Frame& frame,
                               const pipeline::FinishedSurfaces& surfaces) const override {
        const std::span<const float> kbuffer = surfaces.kbuffer;
        std::vector<glm::vec3> colours(kbuffer.size() / frame.program->floats_per_pixel(), glm::vec3(frame.background));
        for (std::uint32_t slot = frame.program->k(); slot-- > 0;) {
            const std::vector<glm::vec4> layer = blurred(frame, kbuffer, slot);
            for (std::size_t i = 0; i < colours.size(); ++i)
                colours[i] = glm::mix(colours[i], glm::vec3(layer[i]), layer[i].a);
        }
        std::vector<float> picture;
        picture.reserve(colours.size() * 4);
        for (const glm::vec3& colour : colours) picture.insert(picture.end(), {colour.r, colour.g, colour.b, 1.0F});
        return picture;
    }

  private:
    std::vector<glm::vec4> blurred(const pipeline::Frame& frame, std::span<const float> kbuffer,
                                   std::uint32_t slot) const {
        const ViewRays rays(frame.view);
        DiscAccumulator discs(frame.view.width, frame.view.height);
        const float* entry = kbuffer.data() + std::size_t{slot} * frame.program->floats_per_entry();
        for (std::uint32_t y = 0; y < frame.view.height; ++y)
            for (std::uint32_t x = 0; x < frame.view.width; ++x, entry += frame.program->floats_per_pixel()) {
                if (entry[3] == models::empty_depth) continue;
                const double blur = lens_.circle_of_confusion(rays.distance(entry[3]));
                discs.add(x, y, std::min(blur, largest_blur_), {entry[0], entry[1], entry[2]});
            }
        return discs.picture();
    }

    Lens lens_;
    double largest_blur_;
};

struct Extent {
    double nearest = 0, farthest = 0;
};

// Of the scene's box along the view axis, between the planes of the view, and never of no depth.
Extent extent_of(const Scene& scene, const pipeline::View& view) {
    const pipeline::EyeDepth depth(view.projection);
    Extent extent{INFINITY, 0.0};
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1) != 0 ? scene.hi.x : scene.lo.x, (i & 2) != 0 ? scene.hi.y : scene.lo.y,
                                (i & 4) != 0 ? scene.hi.z : scene.lo.z);
        const double distance = -(glm::dmat4(view.view) * glm::dvec4(corner, 1.0)).z;
        extent.nearest = std::min(extent.nearest, distance);
        extent.farthest = std::max(extent.farthest, distance);
    }
    extent.nearest = std::max(extent.nearest, depth.distance(0.0F));
    extent.farthest = std::min(std::max(extent.farthest, extent.nearest), depth.distance(1.0F));
    if (extent.farthest > 1.001 * extent.nearest) return extent;
    return {0.97 * extent.nearest, 1.03 * extent.nearest};
}

Lens lens_of(const DepthOfFieldParams& params, const Extent& extent, const pipeline::View& view) {
    Lens lens;
    lens.focus = params.focus > 0.0 ? params.focus : (extent.nearest + extent.farthest) / 2.0;
    lens.aperture = params.aperture > 0.0 ? params.aperture : lens.focus / 20.0;
    lens.focal_length = params.focal_length > 0.0 ? params.focal_length : lens.focus / 50.0;
    lens.pixels_per_slope = static_cast<double>(view.projection[1][1]) * view.height / 2.0;
    if (!(lens.focal_length < lens.focus))
        throw sim::InputError(fmt::format("{}: focal_length: expected less than the focus distance {}, got {}",
                                          option_owner, lens.focus, lens.focal_length));
    return lens;
}

std::vector<float> bounds_of(const DepthOfFieldParams& params, const Extent& extent, const pipeline::View& view) {
    const pipeline::EyeDepth depth(view.projection);
    const double third = (extent.farthest - extent.nearest) / 3.0;
    const double begin = params.range[0] > 0.0 ? params.range[0] : extent.nearest + third;
    const double end = params.range[1] > 0.0 ? params.range[1] : extent.farthest - third;
    // Beyond the far plane, which belongs to the last range.
    std::vector<float> bounds{0.0F, depth.window(begin), depth.window(end), std::nextafter(1.0F, 2.0F)};
    for (std::size_t i = 1; i < bounds.size(); ++i)
        if (!(bounds[i - 1] < bounds[i]))
            throw sim::InputError(fmt::format("{}: range: expected two distances between those of the near and the far "
                                              "plane, {} and {}, the smaller one first, got {} and {}",
                                              option_owner, depth.distance(0.0F), depth.distance(1.0F), begin, end));
    return bounds;
}

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const DepthOfFieldParams& params) {
    if (!pipeline::EyeDepth(view.projection).perspective())
        throw sim::InputError(
            fmt::format("{}: expected a perspective camera, got a parallel projection", option_owner));
    const Extent extent = extent_of(scene, view);
    pipeline::Frame frame = frame_of(scene, view);
    frame.program = models::make_depth_partition(bounds_of(params, extent, view));
    frame.resolve = std::make_shared<const DepthOfFieldPicture>(lens_of(params, extent, view), params.largest_blur);
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    return resolved_frame(frame);
}

} // namespace

Workload depth_of_field_workload() {
    return make_workload<DepthOfFieldParams>(
        "depth-of-field", "the nearest surface in each of three ranges, blurred as by a lens", build);
}

} // namespace traces
