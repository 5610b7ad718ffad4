// Two parallel slabs of known thickness, across the z axis: path lengths through them can be computed.
#include "traces/generators/solids.hpp"
#include "traces/generators/table.hpp"

namespace traces {

namespace {

struct SlabsParams {
    std::array<double, 2> thickness = {0.5, 0.25};
    double gap = 0.5;
    double side = 2.0;

    static constexpr auto fields() {
        using P = SlabsParams;
        return std::tuple(sim::field<&P::thickness>("extent along z of the front slab, draw 0, and of the back slab, "
                                                    "draw 1")
                              .range(1e-6, 1e3),
                          sim::field<&P::gap>("between the slabs; less than 0: they overlap").range(-1e3, 1e3),
                          sim::field<&P::side>("extent along x and y").range(1e-3, 1e3));
    }
};
static_assert(sim::fully_described<SlabsParams>);

Scene build(const SlabsParams& params) {
    const double half = params.side / 2.0, back = -params.thickness[0] - params.gap;
    Scene scene = empty_scene();
    add_object(scene, box_mesh({-half, -half, -params.thickness[0]}, {half, half, 0.0}), "front slab",
               {0.9F, 0.6F, 0.2F, 1.0F}, "gen:slabs");
    add_object(scene, box_mesh({-half, -half, back - params.thickness[1]}, {half, half, back}), "back slab",
               {0.2F, 0.6F, 0.9F, 1.0F}, "gen:slabs");
    return scene;
}

} // namespace

Generator slabs_generator() {
    return make_generator<SlabsParams>(
        "slabs", "two parallel slabs across the z axis, the front side of the first at z = 0, each a draw", build);
}

} // namespace traces
