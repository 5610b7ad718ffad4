// Boxes in a grid, turned and stretched at random: a stand-in for architectural scenes of many parts with high depth
// complexity, such as the power plant of 12.7 M triangles (specification 004, section 9.7).
#include "traces/generators/mesh.hpp"
#include "traces/generators/random_point.hpp"
#include "traces/generators/table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traces {

namespace {

struct GridSoupParams {
    std::uint32_t boxes = 10'000;
    std::uint32_t boxes_per_draw = 1000;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using P = GridSoupParams;
        return std::tuple(sim::field<&P::boxes>("boxes of 8 vertices and 12 triangles").range(1, 10'000'000),
                          sim::field<&P::boxes_per_draw>("boxes drawn with one draw call").range(1, 10'000'000),
                          sim::field<&P::seed>("of sizes and directions"));
    }
};
static_assert(sim::fully_described<GridSoupParams>);

constexpr std::uint32_t vertices_per_box = 8;
constexpr std::uint32_t indices_per_box = 36;

void add_box(Mesh& mesh, const glm::dvec3& centre, sim::Random& random) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double angle = random.uniform() * 0.5 * std::numbers::pi;
    const double c = std::cos(angle), s = std::sin(angle);
    // One long side: beams and pipes rather than cubes.
    glm::dvec3 half = 0.05 + 0.1 * random_in_cube(random);
    half[static_cast<int>(random.below(3))] = 0.4 + 0.5 * random.uniform();
    for (unsigned i = 0; i < vertices_per_box; ++i) {
        const double x = (i & 1U) != 0 ? half.x : -half.x, y = (i & 2U) != 0 ? half.y : -half.y;
        const double z = (i & 4U) != 0 ? half.z : -half.z;
        mesh.positions.emplace_back(centre + glm::dvec3(c * x - s * z, y, s * x + c * z));
    }
    constexpr std::array<std::uint8_t, indices_per_box> faces{0, 4, 2, 2, 4, 6, 1, 3, 5, 5, 3, 7, 0, 1, 4, 4, 1, 5,
                                                              2, 6, 3, 3, 6, 7, 0, 2, 1, 1, 2, 3, 4, 5, 6, 6, 5, 7};
    for (const std::uint8_t corner : faces) mesh.indices.push_back(first + corner);
}

Scene build(const GridSoupParams& params) {
    const auto side = static_cast<std::uint32_t>(std::ceil(std::cbrt(static_cast<double>(params.boxes))));
    sim::Random random(params.seed, "grid soup");
    Mesh mesh;
    mesh.name = "boxes";
    for (std::uint32_t i = 0; i < params.boxes; ++i) {
        const glm::dvec3 cell(i % side, i / side % side, i / side / side);
        add_box(mesh, cell + random_in_cube(random), random);
    }
    const std::uint32_t per_draw = std::min(params.boxes_per_draw, params.boxes);
    Scene scene = scene_of_material("boxes", {0.6F, 0.6F, 0.65F, 1.0F});
    add_draws(scene, mesh, equal_parts(mesh, per_draw * vertices_per_box, per_draw * indices_per_box), {},
              "gen:grid-soup");
    return scene;
}

} // namespace

Generator grid_soup_generator() {
    return make_generator<GridSoupParams>("grid-soup", "boxes of all sizes in a grid, for high depth complexity",
                                          build);
}

} // namespace traces
