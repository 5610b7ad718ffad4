// Opaque and glass balls over a floor, before a wall, some behind a pane: as many triangles of either kind as asked
// for.
#include "sim/check.hpp"
#include "traces/generators/solids.hpp"
#include "traces/generators/table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace traces {

namespace {

struct ShowroomParams {
    std::uint32_t triangles = 59'644;
    std::uint32_t transparent = 20'832;
    float opacity = 0.4F;

    static constexpr auto fields() {
        using P = ShowroomParams;
        return std::tuple(sim::field<&P::triangles>("in all").unit("triangles").range(64, 10'000'000),
                          sim::field<&P::transparent>("of those, of glass").unit("triangles").range(0, 10'000'000),
                          sim::field<&P::opacity>("of the glass").range(0.0F, 1.0F));
    }
};
static_assert(sim::fully_described<ShowroomParams>);

constexpr std::uint32_t segments = 24, of_ball = segments * (segments - 2), of_wall = 12, least_fan = 16;

/// A disc of exactly that many triangles; `axis` is the one that its normal runs along.
Mesh fan(const glm::dvec3& middle, double radius, int axis, std::uint32_t triangles) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Mesh mesh;
    glm::vec3 normal(0.0F);
    normal[axis] = 1.0F;
    mesh.positions.emplace_back(glm::vec3(middle));
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / triangles;
        glm::dvec3 rim = middle;
        rim[u] += radius * std::cos(angle);
        rim[v] += radius * std::sin(angle);
        mesh.positions.emplace_back(glm::vec3(rim));
        mesh.indices.insert(mesh.indices.end(), {0, 1 + i, 1 + (i + 1) % triangles});
    }
    mesh.normals.assign(mesh.positions.size(), normal);
    return mesh;
}

void add(Scene& scene, Mesh mesh, const std::string& name, const glm::vec3& colour, float opacity) {
    add_object(scene, std::move(mesh), name, glm::vec4(colour, opacity), "gen:showroom");
    if (opacity < 1.0F) scene.resources->materials.back().alpha_mode = pipeline::AlphaMode::blend;
}

glm::vec3 hue(std::uint32_t number) {
    glm::vec3 colour;
    for (int i = 0; i < 3; ++i)
        colour[i] =
            static_cast<float>(0.6 + 0.35 * std::cos(2.0 * std::numbers::pi * (number * std::numbers::phi + i / 3.0)));
    return colour;
}

// Balls that leave room for a disc of at least `least_fan` triangles.
std::uint32_t balls_in(std::uint32_t triangles) {
    return triangles < least_fan ? 0 : (triangles - least_fan) / of_ball;
}

Scene build(const ShowroomParams& params) {
    const std::uint32_t wall = params.triangles - std::min(params.transparent, params.triangles);
    if (wall < of_wall + least_fan || (params.transparent != 0 && params.transparent < least_fan))
        throw sim::InputError(
            fmt::format("gen:showroom: transparent: expected 0, or {} to triangles - {}, got {} of {}", least_fan,
                        of_wall + least_fan, params.transparent, params.triangles));
    const std::uint32_t opaque = wall - of_wall, opaque_balls = balls_in(opaque), glass = balls_in(params.transparent);
    const std::uint32_t balls = opaque_balls + glass;
    const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(std::max(balls, 1U))));
    const double half = side / 2.0 + 0.5;
    Scene scene = empty_scene();
    add(scene, fan({0.0, 0.0, 0.0}, 1.6 * half, 1, opaque - opaque_balls * of_ball), "floor", {0.8F, 0.8F, 0.75F},
        1.0F);
    add(scene, box_mesh({-half, 0.0, -half - 0.1}, {half, 0.6 * half, -half}), "wall", {0.7F, 0.55F, 0.4F}, 1.0F);
    for (std::uint32_t i = 0; i < balls; ++i) {
        // Glass at even distances among the others.
        const bool is_glass = std::uint64_t{i + 1} * glass / balls != std::uint64_t{i} * glass / balls;
        const std::uint32_t row = i / side, column = i % side;
        const glm::dvec3 centre(column + 1.0 - half, 0.4, row + 1.0 - half);
        add(scene, sphere_mesh(centre, 0.4, segments), fmt::format("{} {}", is_glass ? "glass" : "ball", i), hue(i),
            is_glass ? params.opacity : 1.0F);
    }
    if (const std::uint32_t left = params.transparent - glass * of_ball; left != 0)
        add(scene, fan({0.0, 0.3 * half, half}, 0.3 * half, 2, left), "pane", {0.5F, 0.9F, 0.7F}, params.opacity);
    return scene;
}

} // namespace

Generator showroom_generator() {
    return make_generator<ShowroomParams>(
        "showroom", "opaque and glass balls over a floor, before a wall and behind a pane, each a draw", build);
}

} // namespace traces
