// A field of grass: the geometry benchmark of Bavoil 2007, section 3.2 (specification 004, section 1.2 and G1).
//
// A blade is an indexed ribbon: 7 vertices, 5 triangles, 15 indices. No vertex is shared between blades.
#include "traces/generators/mesh.hpp"
#include "traces/generators/random_point.hpp"
#include "traces/generators/table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traces {

namespace {

struct GrassParams {
    std::uint32_t blades = 300'000;
    std::uint32_t blades_per_draw = 0;
    VertexLayout layout = VertexLayout::separate;
    PositionFormat position = PositionFormat::f32;
    std::string attributes = "normal:3f32";
    IndexWidth index = IndexWidth::automatic;
    std::uint32_t align = 4;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using P = GrassParams;
        return std::tuple(
            sim::field<&P::blades>("blades").range(1, 20'000'000),
            sim::field<&P::blades_per_draw>("blades drawn with one draw call; 0 = all").at_least(0),
            sim::field<&P::layout>(MeshFormatTexts::layout), sim::field<&P::position>(MeshFormatTexts::position),
            sim::field<&P::attributes>(MeshFormatTexts::attributes), sim::field<&P::index>(MeshFormatTexts::index),
            sim::field<&P::align>(MeshFormatTexts::align).unit("bytes").range(1, 4),
            sim::field<&P::seed>("of places and shapes"));
    }
};
static_assert(sim::fully_described<GrassParams>);

constexpr std::uint32_t vertices_per_blade = 7;
constexpr std::uint32_t indices_per_blade = 15;
constexpr double blades_per_metre = 50.0; ///< along one side

struct Blade {
    glm::dvec2 root;
    double direction, height, bend, width; ///< radians; metres
};

Blade random_blade(sim::Random& random, const glm::dvec2& cell) {
    Blade blade;
    blade.root = (cell + random_in_square(random)) / blades_per_metre;
    blade.direction = random.uniform() * 2.0 * std::numbers::pi;
    blade.height = 0.2 + 0.25 * random.uniform();
    blade.bend = blade.height * (0.2 + 0.6 * random.uniform());
    blade.width = 0.008 + 0.008 * random.uniform();
    return blade;
}

void add_blade(Mesh& mesh, const Blade& blade) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::dvec3 lean(std::cos(blade.direction), 0.0, std::sin(blade.direction));
    const glm::dvec3 side(-lean.z, 0.0, lean.x);
    for (std::uint32_t i = 0; i < vertices_per_blade; ++i) {
        const std::uint32_t third = i / 2; // of the height: two vertices each, then the tip
        const double t = third / 3.0;
        const double half = 0.5 * blade.width * (1.0 - t);
        const glm::dvec3 along = lean * (2.0 * blade.bend * t) + glm::dvec3(0.0, blade.height, 0.0);
        const glm::dvec3 middle =
            glm::dvec3(blade.root.x, blade.height * t, blade.root.y) + lean * (blade.bend * t * t);
        mesh.positions.emplace_back(middle + side * (i % 2 == 0 ? -half : half));
        mesh.normals.emplace_back(glm::normalize(glm::cross(side, along)));
    }
    for (std::uint32_t i = 0; i < 5; ++i) // every second triangle of the ribbon winds the other way
        for (const std::uint32_t corner : {i, i + 1 + i % 2, i + 2 - i % 2}) mesh.indices.push_back(first + corner);
}

Camera camera_on(double side) {
    // From the edge of the field, a little above the tips, down to its middle.
    const double down = std::atan2(0.5, side / 2.0 + 0.5);
    const glm::dvec3 back(0.0, std::sin(down), std::cos(down));
    Camera camera;
    camera.name = "edge of the field";
    camera.to_world[1] = glm::vec4(glm::cross(back, glm::dvec3(1.0, 0.0, 0.0)), 0.0);
    camera.to_world[2] = glm::vec4(back, 0.0);
    camera.to_world[3] = glm::vec4(0.0, 0.75, side / 2.0 + 0.5, 1.0);
    camera.fovy = std::numbers::pi_v<float> / 4.0F;
    camera.near = 0.1F;
    camera.far = static_cast<float>(1.5 * side + 2.0);
    return camera;
}

Scene build(const GrassParams& params) {
    const MeshFormat format = format_of(params, "gen:grass");
    const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(params.blades))));
    const double side = columns / blades_per_metre;
    sim::Random random(params.seed, "grass");
    Mesh mesh;
    mesh.name = "grass";
    mesh.positions.reserve(std::size_t{params.blades} * vertices_per_blade);
    mesh.normals.reserve(std::size_t{params.blades} * vertices_per_blade);
    mesh.indices.reserve(std::size_t{params.blades} * indices_per_blade);
    for (std::uint32_t i = 0; i < params.blades; ++i) {
        Blade blade = random_blade(random, glm::dvec2(i % columns, i / columns));
        blade.root -= glm::dvec2(side / 2.0);
        add_blade(mesh, blade);
    }
    const std::uint32_t per_draw =
        params.blades_per_draw == 0 ? params.blades : std::min(params.blades_per_draw, params.blades);
    Scene scene = scene_of_material("grass", {0.12F, 0.35F, 0.05F, 1.0F});
    const auto parts = equal_parts(mesh, per_draw * vertices_per_blade, per_draw * indices_per_blade);
    add_draws(scene, mesh, parts, format, "gen:grass");
    scene.cameras.push_back(camera_on(side));
    return scene;
}

} // namespace

Generator grass_generator() {
    return make_generator<GrassParams>("grass", "a field of grass: 7 vertices, 5 triangles, 15 indices per blade",
                                       build);
}

} // namespace traces
