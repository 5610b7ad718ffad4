// Three chequered planes at known distances from a camera, side by side in its view: for depth of field.
#include "traces/generators/mesh.hpp"
#include "traces/generators/table.hpp"

#include <cmath>
#include <numbers>

namespace traces {

namespace {

struct PlanesParams {
    std::array<double, 3> distances = {4.0, 7.0, 12.0};
    std::uint32_t checks = 4;
    double fovy = 40.0;

    static constexpr auto fields() {
        using P = PlanesParams;
        return std::tuple(
            sim::field<&P::distances>("of the left, the middle and the right plane from the camera").range(0.1, 1e4),
            sim::field<&P::checks>("squares across a plane").range(1, 64),
            sim::field<&P::fovy>("full vertical angle of the camera").unit("degrees").range(1.0, 120.0));
    }
};
static_assert(sim::fully_described<PlanesParams>);

// A third of a square view is filled: each plane is as wide as that, and as high, less a margin.
constexpr double share_of_view = 0.3;

void add_plane(Mesh& mesh, const PlanesParams& params, std::size_t number) {
    const double distance = params.distances[number];
    const double height = 2.0 * distance * std::tan(params.fovy * std::numbers::pi / 360.0);
    const double step = share_of_view * height / params.checks;
    const double left = (static_cast<double>(number) - 1.0) * height / 3.0 - share_of_view * height / 2.0;
    const std::array<Colour, 3> colours{Colour{230, 70, 50, 255}, Colour{60, 180, 75, 255}, Colour{50, 90, 220, 255}};
    constexpr Colour light{245, 240, 225, 255};
    for (std::uint32_t y = 0; y < params.checks; ++y)
        for (std::uint32_t x = 0; x < params.checks; ++x) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const std::uint32_t corner : {0U, 1U, 2U, 3U}) {
                const std::uint32_t column = x + corner % 2, row = y + corner / 2;
                mesh.positions.emplace_back(
                    glm::vec3(glm::dvec3(left + column * step, row * step - share_of_view * height / 2.0, -distance)));
                mesh.colours.push_back((x + y) % 2 == 0 ? colours[number] : light);
            }
            for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) mesh.indices.push_back(first + corner);
        }
}

Camera camera_of(const PlanesParams& params) {
    Camera camera;
    camera.name = "eye";
    camera.fovy = static_cast<float>(params.fovy * std::numbers::pi / 180.0);
    const auto [nearest, farthest] = std::minmax_element(params.distances.begin(), params.distances.end());
    camera.near = static_cast<float>(*nearest / 2.0);
    camera.far = static_cast<float>(*farthest * 1.5);
    return camera;
}

Scene build(const PlanesParams& params) {
    Mesh mesh;
    mesh.name = "planes";
    for (std::size_t number = 0; number < 3; ++number) add_plane(mesh, params, number);
    Scene scene = scene_of_material(mesh.name, glm::vec4(1.0F));
    scene.resources->materials[0].unlit = true;
    add_draws(scene, mesh, {whole(mesh)}, {}, "gen:planes");
    scene.cameras.push_back(camera_of(params));
    return scene;
}

} // namespace

Generator planes_generator() {
    return make_generator<PlanesParams>(
        "planes", "three chequered planes at known distances from the camera at the origin, side by side", build);
}

} // namespace traces
