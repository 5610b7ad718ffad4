// Isosurfaces of a scalar field on tetrahedra, without extracting them: the faces are drawn, and the modify program
// finds where the scalar crosses an iso-value between two of them.
//
// Source: Bavoil 2007, section 6.3.1 (specification 004, A15).
#include "models/programs/isosurface.hpp"
#include "traces/loads.hpp"
#include "traces/workloads/isosurface_picture.hpp"
#include "traces/workloads/methods.hpp"
#include "traces/workloads/scalar_field.hpp"

namespace traces {

namespace {

struct IsosurfaceParams {
    std::vector<float> iso;
    std::uint32_t k = 8;
    bool sorted = true;
    bool silhouettes = true;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};
    Composite composite = Composite::free;

    static constexpr auto fields() {
        using P = IsosurfaceParams;
        return std::tuple(
            sim::field<&P::iso>("iso-values: a number or a list; none: the middle of the scalars"),
            sim::field<&P::k>("samples sorted per pixel").unit("samples").range(1, 64),
            sim::field<&P::sorted>("triangles are drawn in the order of their centroids, the nearest first"),
            sim::field<&P::silhouettes>("dark lines where a surface ends"),
            sim::field<&P::background>("linear RGB behind everything").range(0.0F, 1.0F), composite_field<P>());
    }
};
static_assert(sim::fully_described<IsosurfaceParams>);

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const IsosurfaceParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    const ScalarRange range = scalar_range(frame, "workload isosurface");
    prepare_scalars(frame, params.sorted);
    models::IsosurfaceSetup setup;
    setup.k = params.k;
    setup.iso_values = iso_values_of(frame, scene, params.iso, range);
    setup.depth = pipeline::EyeDepth(view.projection);
    frame.program = models::make_isosurface(setup);
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    return kbuffer_frame(frame, isosurface_picture(params.silhouettes), params.composite);
}

} // namespace

Workload isosurface_workload() {
    return taking(make_workload<IsosurfaceParams>(
                      "isosurface", "isosurfaces of a scalar field on tetrahedra, found between their faces", build),
                  as_list, "iso");
}

Load crossings_load() { return {"isosurface"}; }

} // namespace traces
