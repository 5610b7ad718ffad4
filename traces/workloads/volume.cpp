// Volume rendering of a scalar field on tetrahedra: the faces are drawn, and the modify program composites the gaps
// between them from a pre-integrated table.
//
// Source: Bavoil 2007, section 6.3.2 (specification 004, A16). Gaps are measured along the view axis. What lies between
// two faces counts as inside the mesh, so the hollows of a mesh that is not convex are filled.
#include "models/programs/volume.hpp"
#include "traces/loads.hpp"
#include "traces/workloads/methods.hpp"
#include "traces/workloads/scalar_field.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace traces {

enum class Transfer : std::uint8_t { ramp, uniform };

} // namespace traces

template <>
struct sim::EnumNames<traces::Transfer> {
    static constexpr std::array<std::string_view, 2> names{"ramp", "uniform"};
};

namespace traces {

namespace {

struct VolumeParams {
    Transfer transfer = Transfer::ramp;
    double extinction = -1.0;
    std::vector<float> range;
    std::uint32_t k = 8;
    bool sorted = true;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};
    Composite composite = Composite::free;

    static constexpr auto fields() {
        using P = VolumeParams;
        return std::tuple(
            sim::field<&P::transfer>(
                "extinction of a scalar: ramp, none at the low end of the range and all at the high "
                "one; uniform, all everywhere"),
            sim::field<&P::extinction>(
                "at the high end of the range, in 1 / scene unit; less than 0: 12 divided by the "
                "radius of the scene")
                .at_most(1e30),
            sim::field<&P::range>("scalars where the colours begin and end; none: the least and the largest"),
            sim::field<&P::k>("samples sorted per pixel").unit("samples").range(1, 64),
            sim::field<&P::sorted>("triangles are drawn in the order of their centroids, the nearest first"),
            sim::field<&P::background>("linear RGB behind everything").range(0.0F, 1.0F), composite_field<P>());
    }
};
static_assert(sim::fully_described<VolumeParams>);

ScalarRange range_of(pipeline::Frame& frame, const Scene& scene, const VolumeParams& params) {
    const ScalarRange all = scalar_range(frame, "workload volume");
    if (params.range.empty()) return all;
    if (params.range.size() != 2 || !(params.range[0] < params.range[1]))
        throw sim::InputError("workload volume: range: expected two numbers, the lower one first");
    const ScalarRange range{fragment_scalar(scene, params.range[0]), fragment_scalar(scene, params.range[1])};
    if (range.hi < all.lo || range.lo > all.hi)
        frame.notes.push_back(fmt::format("range {} to {}: the scalars are {} to {}", params.range[0], params.range[1],
                                          std::ldexp(all.lo, scene.scalar_exponent),
                                          std::ldexp(all.hi, scene.scalar_exponent)));
    return range;
}

models::TransferFunction transfer_of(const VolumeParams& params, ScalarRange range, float extinction) {
    constexpr int points = 9; // straight pieces of a colour scale that bends in the middle
    models::TransferFunction transfer;
    // A field that is the same everywhere has one colour; where it lies in the table is of no account.
    const float step = (range.hi - range.lo) / (points - 1);
    const bool constant = !(range.lo + step > range.lo && range.hi - step < range.hi);
    if (constant) range.hi = range.lo + std::max(1.0F, std::abs(range.lo));
    for (int i = 0; i < points; ++i) {
        const float share = static_cast<float>(i) / (points - 1);
        const bool full = constant || params.transfer == Transfer::uniform;
        transfer.push_back({range.lo + share * (range.hi - range.lo), colour_of_share(constant ? 1.0 : share),
                            full ? extinction : share * extinction});
    }
    return transfer;
}

std::shared_ptr<const pipeline::Shader> volume_picture(const models::PictureSetup& setup) {
    const std::size_t state = std::size_t{setup.program->k()} * setup.program->floats_per_entry();
    return models::picture_shader(setup, 2,
                                  [state](const models::PicturePlace&, const float* pixel, const glm::vec3& behind) {
                                      const float* colour = pixel + state;
                                      return glm::vec3(colour[0], colour[1], colour[2]) + (1.0F - colour[3]) * behind;
                                  });
}

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const VolumeParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    const ScalarRange range = range_of(frame, scene, params);
    prepare_scalars(frame, params.sorted);
    const double radius = std::max(static_cast<double>(scene.radius), 1e-30);
    const double extinction = params.extinction < 0.0 ? 12.0 / radius : params.extinction;
    models::VolumeSetup setup;
    setup.k = params.k;
    setup.transfer = transfer_of(params, range, static_cast<float>(extinction));
    setup.longest_gap = std::max(longest_edge(frame), 1e-30F);
    setup.depth = pipeline::EyeDepth(view.projection);
    frame.program = models::make_volume(setup);
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    return kbuffer_frame(frame, volume_picture, params.composite);
}

} // namespace

Workload volume_workload() {
    return make_workload<VolumeParams>(
        "volume", "a scalar field on tetrahedra as a cloud, composited between their faces", build);
}

Load ray_integral_load() { return {"volume"}; }

} // namespace traces
