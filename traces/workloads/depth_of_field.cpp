// Depth of field: the nearest surface in each of three ranges of distance, each range blurred by its circles of
// confusion and laid over the one behind.
//
// Source: Bavoil 2007, section 6.2.1 (specification 004, A14), where the kernel is not stated; discs of a thin lens
// here.
#include "models/programs/depth_partition.hpp"
#include "models/programs/nearest_k.hpp" // empty_depth
#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/sample_planes.hpp"
#include "sim/check.hpp"
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

constexpr std::uint32_t rows_of_group = 16; // the more, the fewer groups find a surface within reach

/// A group is a strip of rows as wide as the picture: it adds up what of the discs falls there.
class LensKernel final : public pipeline::Kernel {
  public:
    LensKernel(const pipeline::Frame& frame, const Lens& lens, double largest_blur)
        : program_(frame.program),
          view_(frame.view),
          depth_(frame.view.projection),
          background_(frame.background),
          lens_(lens),
          largest_blur_(largest_blur),
          discs_(largest_blur) {}

    pipeline::KernelShape shape() const override {
        return {.reads = 1, .groups = {1, (view_.height + rows_of_group - 1) / rows_of_group}};
    }

    void run(const glm::uvec2& group, pipeline::SurfaceAccess& surfaces,
             pipeline::KernelStores& stores) const override {
        const std::uint32_t first = group.y * rows_of_group;
        const Strip strip{first, std::min(rows_of_group, view_.height - first)};
        std::vector<glm::dvec3> sums(std::size_t{view_.width} * strip.rows);
        for (std::uint32_t sample = 0; sample < view_.samples; ++sample) {
            const std::vector<glm::vec3> colours = picture(surfaces, strip, sample);
            for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += glm::dvec3(colours[i]);
        }
        auto sum = sums.begin();
        for (std::uint32_t y = first; y < first + strip.rows; ++y)
            for (std::uint32_t x = 0; x < view_.width; ++x, ++sum)
                stores.store(0, x, y, 0, {glm::vec3(*sum / static_cast<double>(view_.samples)), 1.0F});
    }

  private:
    struct Strip {
        std::uint32_t first = 0, rows = 0;
    };

    // Of one sample of each pixel.
    std::vector<glm::vec3> picture(pipeline::SurfaceAccess& surfaces, const Strip& strip, std::uint32_t sample) const {
        std::vector<DiscAccumulator> slots(program_->k(),
                                           DiscAccumulator(discs_, view_.width, strip.first, strip.rows));
        const std::uint32_t reach = discs_.reach(), end = std::min(strip.first + strip.rows + reach, view_.height);
        for (std::uint32_t y = strip.first - std::min(strip.first, reach); y < end; ++y)
            add_row(surfaces, y, sample, slots);
        std::vector<glm::vec3> colours(std::size_t{view_.width} * strip.rows, background_);
        for (auto slot = slots.rbegin(); slot != slots.rend(); ++slot) {
            const std::vector<glm::vec4> layer = slot->picture();
            for (std::size_t i = 0; i < colours.size(); ++i)
                colours[i] = glm::mix(colours[i], glm::vec3(layer[i]), layer[i].a);
        }
        return colours;
    }

    // Reads four pixels side by side at a time.
    void add_row(pipeline::SurfaceAccess& surfaces, std::uint32_t y, std::uint32_t sample,
                 std::vector<DiscAccumulator>& slots) const {
        pipeline::LaneIndices row;
        row.fill(static_cast<std::int32_t>(sample * pipeline::plane_rows(view_.height, view_.samples) + y));
        for (std::uint32_t x = 0; x < view_.width; x += 4) {
            const auto first = static_cast<std::int32_t>(x);
            const unsigned pixels = 15U >> (4 - std::min(4U, view_.width - x));
            const auto entries =
                surfaces.pixels(0, {first, first + 1, first + 2, first + 3}, row, pixels, 0, program_->targets());
            for (std::uint32_t i = 0; i < 4; ++i)
                if (entries[i] != nullptr) add_pixel(x + i, y, entries[i], slots);
        }
    }

    void add_pixel(std::uint32_t x, std::uint32_t y, const float* entry, std::vector<DiscAccumulator>& slots) const {
        for (DiscAccumulator& slot : slots) {
            if (entry[3] != models::empty_depth) {
                const double blur = lens_.circle_of_confusion(depth_.distance(entry[3]));
                slot.add(x, y, std::min(blur, largest_blur_), {entry[0], entry[1], entry[2]});
            }
            entry += program_->floats_per_entry();
        }
    }

    std::shared_ptr<const pipeline::ModifyProgram> program_;
    pipeline::View view_;
    pipeline::EyeDepth depth_;
    glm::vec3 background_;
    Lens lens_;
    double largest_blur_;
    Discs discs_;
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
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    return kbuffer_frame(frame,
                         std::make_shared<const LensKernel>(frame, lens_of(params, extent, view), params.largest_blur));
}

} // namespace

Workload depth_of_field_workload() {
    return make_workload<DepthOfFieldParams>(
        "depth-of-field", "the nearest surface in each of three ranges, blurred as by a lens", build);
}

} // namespace traces
