// Points as sprites of constant size: isosurfaces of their scalar, or their nearest layers.
//
// Source: Bavoil 2007, section 6.3.1 (specification 004, A15 and section 9.3). Every vertex of the scene is a point.
// The hardware of the time draws points as they are; here the sprite is two triangles, made for each view.
#include "models/programs/isosurface.hpp"
#include "models/programs/nearest_k.hpp"
#include "models/programs/pictures.hpp"
#include "traces/workloads/isosurface_picture.hpp"
#include "traces/workloads/methods.hpp"
#include "traces/workloads/scalar_field.hpp"
#include "traces/workloads/sprites.hpp"

namespace traces {

enum class ParticleMethod : std::uint8_t { isosurface, layers };

} // namespace traces

template <>
struct sim::EnumNames<traces::ParticleMethod> {
    static constexpr std::array<std::string_view, 2> names{"isosurface", "layers"};
};

namespace traces {

namespace {

struct ParticlesParams {
    ParticleMethod method = ParticleMethod::isosurface;
    double size = 4.0;
    std::vector<float> iso;
    std::uint32_t k = 8;
    float opacity = 0.5F;
    bool sorted = true;
    bool silhouettes = false;
    std::array<float, 3> background = {1.0F, 1.0F, 1.0F};
    Composite composite = Composite::free;

    static constexpr auto fields() {
        using P = ParticlesParams;
        return std::tuple(
            sim::field<&P::method>("isosurface: surfaces where the scalar crosses the iso-values between points of one "
                                   "pixel; layers: the nearest points, composited"),
            sim::field<&P::size>("edge of a sprite").unit("px").range(0.1, 1024.0),
            sim::field<&P::iso>("iso-values: a number or a list; none: the middle of the scalars"),
            sim::field<&P::k>("samples sorted, or points kept, per pixel").unit("points").range(1, 64),
            sim::field<&P::opacity>("of each point, for layers").range(0.0F, 1.0F),
            sim::field<&P::sorted>("isosurfaces: points are drawn in the order of their distance, the nearest first"),
            sim::field<&P::silhouettes>("dark lines where an isosurface ends"),
            sim::field<&P::background>("linear RGB behind everything").range(0.0F, 1.0F), composite_field<P>());
    }
};
static_assert(sim::fully_described<ParticlesParams>);

pipeline::Frame isosurface_frame(pipeline::Frame frame, const Scene& scene, const ParticlesParams& params) {
    const ScalarRange range = scalar_range(frame, "workload particles");
    draw_sprites(frame, points_of(frame), params.size, SpriteColour::scalar);
    prepare_scalars(frame, params.sorted);
    models::IsosurfaceSetup setup;
    setup.k = params.k;
    setup.iso_values = iso_values_of(frame, scene, params.iso, range);
    setup.depth = pipeline::EyeDepth(frame.view.projection);
    frame.program = models::make_isosurface(setup);
    return kbuffer_frame(frame, isosurface_picture(params.silhouettes), params.composite);
}

pipeline::Frame layers_frame(pipeline::Frame frame, const ParticlesParams& params) {
    draw_sprites(frame, points_of(frame), params.size, SpriteColour::picture);
    frame.program = models::make_nearest_k(models::EntryKind::rgbz, params.k);
    return kbuffer_frame(frame, models::layers_picture(params.opacity), params.composite);
}

pipeline::Frame build(const Scene& scene, const pipeline::View& view, const ParticlesParams& params) {
    pipeline::Frame frame = frame_of(scene, view);
    frame.background = {params.background[0], params.background[1], params.background[2], 1.0F};
    return params.method == ParticleMethod::isosurface ? isosurface_frame(std::move(frame), scene, params)
                                                       : layers_frame(std::move(frame), params);
}

} // namespace

Workload particles_workload() {
    return taking(make_workload<ParticlesParams>(
                      "particles",
                      "every vertex as a sprite of constant size: isosurfaces of its scalar, or nearest layers", build),
                  as_list, "iso");
}

} // namespace traces
