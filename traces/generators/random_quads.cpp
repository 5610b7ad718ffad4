// Fragments that have nothing to do with each other: the case for which the hazard rate is known in closed form,
// 1 - (1 - 4/A)^H (specification 004, section 7.1 and K4).
#include "sim/check.hpp"
#include "traces/generators/screen.hpp"
#include "traces/generators/table.hpp"

#include <cmath>

namespace traces {

namespace {

struct RandomQuadsParams {
    std::uint32_t n = 1'000'000;
    std::uint32_t area = 262'144;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using P = RandomQuadsParams;
        return std::tuple(
            sim::field<&P::n>("fragments of 2x2 pixels").range(1, 20'000'000),
            sim::field<&P::area>("pixels they fall on: a square from the top left corner, its last row of "
                                 "quads perhaps not full; a multiple of 4")
                .unit("px")
                .range(4, 16384 * 16384),
            sim::field<&P::seed>("of positions and depths"));
    }
};
static_assert(sim::fully_described<RandomQuadsParams>);

Scene build(const RandomQuadsParams& params) {
    if (params.area % 4 != 0)
        throw sim::InputError(fmt::format("gen:random-quads: area: expected a multiple of 4, got {}", params.area));
    const std::uint32_t blocks = params.area / 4;
    const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(blocks))));
    sim::Random random(params.seed, "random quads");
    Mesh mesh;
    mesh.name = "random quads";
    mesh.positions.reserve(std::size_t{params.n} * 3);
    mesh.colours.reserve(std::size_t{params.n} * 3);
    for (std::uint32_t i = 0; i < params.n; ++i) {
        const auto block = static_cast<std::uint32_t>(random.below(blocks));
        const auto column = block % columns, row = block / columns;
        // Strictly between the near and the far plane, in steps that a float between 0 and 1 can hold.
        const float depth = static_cast<float>((static_cast<double>(random.below(0x7ffffe)) + 1.0) * 0x1.0p-23);
        // In the last column the tip points to the left, so that it stays on the screen.
        add_one_quad_triangle(mesh, static_cast<float>(column * 2), static_cast<float>(row * 2), depth, colour_of(i),
                              column > 0 && column + 1 == columns);
    }
    return screen_scene(mesh);
}

} // namespace

Generator random_quads_generator() {
    return make_generator<RandomQuadsParams>(
        "random-quads", "n fragments of one quad each at random places of an area, at random depths", build);
}

} // namespace traces
