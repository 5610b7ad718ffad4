// A cube of tetrahedra with a known scalar field: for isosurfaces and volumes whose picture can be computed.
#include "traces/generators/table.hpp"
#include "traces/tetrahedra/tetrahedral_mesh.hpp"

#include <cmath>

namespace traces {

/// Of the place (x, y, z) in [0,1]^3: x; the distance from the middle, 0 to 1 at the corners; 1.
enum class ScalarField : std::uint8_t { linear, radial, constant };

} // namespace traces

template <>
struct sim::EnumNames<traces::ScalarField> {
    static constexpr std::array<std::string_view, 3> names{"linear", "radial", "constant"};
};

namespace traces {

namespace {

struct TetrahedraParams {
    std::uint32_t n = 8;
    ScalarField field = ScalarField::radial;

    static constexpr auto fields() {
        using P = TetrahedraParams;
        return std::tuple(
            sim::field<&P::n>("cells along each side of the cube, each cut into six tetrahedra").range(1, 128),
            sim::field<&P::field>("scalar: x from 0 to 1, distance from the middle from 0 to 1, or 1 everywhere"));
    }
};
static_assert(sim::fully_described<TetrahedraParams>);

float scalar_at(const glm::dvec3& place, ScalarField field) {
    if (field == ScalarField::constant) return 1.0F;
    if (field == ScalarField::linear) return static_cast<float>(place.x);
    return static_cast<float>(glm::length(place - 0.5) / std::sqrt(0.75));
}

void add_points(TetrahedralMesh& mesh, const TetrahedraParams& params) {
    for (std::uint32_t z = 0; z <= params.n; ++z)
        for (std::uint32_t y = 0; y <= params.n; ++y)
            for (std::uint32_t x = 0; x <= params.n; ++x) {
                const glm::dvec3 place = glm::dvec3(x, y, z) / static_cast<double>(params.n);
                mesh.positions.emplace_back(glm::vec3(place - 0.5));
                mesh.scalars.push_back(scalar_at(place, params.field));
            }
}

// Kuhn's subdivision: one tetrahedron for each way to go from the first to the last corner along three edges. All cells
// are cut alike, so their faces match.
void add_cell(TetrahedralMesh& mesh, std::uint32_t first, const std::array<std::uint32_t, 3>& steps) {
    constexpr std::array<std::array<std::size_t, 3>, 6> ways{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (std::size_t way = 0; way < ways.size(); ++way) {
        const std::uint32_t a = first + steps[ways[way][0]];
        const std::uint32_t b = a + steps[ways[way][1]];
        const std::uint32_t last = b + steps[ways[way][2]];
        const bool even = way < 3; // odd ways turn the other way round
        mesh.tetrahedra.push_back({first, even ? a : b, even ? b : a, last});
    }
}

Scene build(const TetrahedraParams& params) {
    TetrahedralMesh mesh;
    mesh.name = "tetrahedra";
    add_points(mesh, params);
    const std::uint32_t side = params.n + 1;
    for (std::uint32_t z = 0; z < params.n; ++z)
        for (std::uint32_t y = 0; y < params.n; ++y)
            for (std::uint32_t x = 0; x < params.n; ++x)
                add_cell(mesh, (z * side + y) * side + x, {1, side, side * side});
    return scene_of(std::move(mesh));
}

} // namespace

Generator tetrahedra_generator() {
    return make_generator<TetrahedraParams>("tetrahedra", "a cube of tetrahedra with a scalar field", build);
}

} // namespace traces
