// A sphere and a cube: the two objects of constructive solid geometry (specification 004, A13).
#include "traces/generators/solids.hpp"
#include "traces/generators/table.hpp"

namespace traces {

namespace {

struct CsgParams {
    double radius = 1.0;
    double half_edge = 0.6;
    std::array<double, 3> offset = {0.5, 0.4, 0.5};
    std::uint32_t segments = 96;

    static constexpr auto fields() {
        using P = CsgParams;
        return std::tuple(
            sim::field<&P::radius>("radius of the sphere, object A, whose middle is the origin").range(1e-3, 1e3),
            sim::field<&P::half_edge>("half the edge of the cube, object B").range(1e-3, 1e3),
            sim::field<&P::offset>("middle of the cube").range(-1e3, 1e3),
            sim::field<&P::segments>("meridians of the sphere").range(3, 4096));
    }
};
static_assert(sim::fully_described<CsgParams>);

Scene build(const CsgParams& params) {
    const glm::dvec3 middle(params.offset[0], params.offset[1], params.offset[2]);
    Scene scene = empty_scene();
    add_object(scene, sphere_mesh(glm::dvec3(0.0), params.radius, params.segments), "sphere", {0.8F, 0.25F, 0.2F, 1.0F},
               "gen:csg");
    add_object(scene, box_mesh(middle - params.half_edge, middle + params.half_edge), "cube",
               {0.25F, 0.45F, 0.8F, 1.0F}, "gen:csg");
    return scene;
}

} // namespace

Generator csg_generator() {
    return make_generator<CsgParams>("csg", "a sphere and a cube that overlap, each a draw", build);
}

} // namespace traces
