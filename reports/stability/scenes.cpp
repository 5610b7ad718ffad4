#include "reports/stability/scenes.hpp"

#include "reports/pictures.hpp"
#include "traces/generators/screen.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <numeric>

namespace reports::stability {

traces::Scene screen_scene(const std::vector<ScreenTriangle>& triangles) {
    traces::Mesh mesh;
    mesh.name = "triangles";
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        mesh.positions.insert(mesh.positions.end(), {triangles[i].a, triangles[i].b, triangles[i].c});
        mesh.colours.insert(mesh.colours.end(), 3, traces::colour_of(i));
    }
    traces::Scene scene = traces::screen_scene(mesh);
    scene.name = "triangles";
    traces::finish_scene(scene);
    return scene;
}

std::array<ScreenTriangle, 2> rectangle(float x0, float y0, float x1, float y1, float depth) {
    return {{{{x0, y0, depth}, {x0, y1, depth}, {x1, y0, depth}}, {{x1, y0, depth}, {x0, y1, depth}, {x1, y1, depth}}}};
}

traces::Scene layers_of(std::uint32_t width, std::uint32_t height, std::span<const float> depths) {
    std::vector<ScreenTriangle> triangles;
    for (const float depth : depths)
        for (const ScreenTriangle& half :
             rectangle(0.0F, 0.0F, static_cast<float>(width), static_cast<float>(height), depth))
            triangles.push_back(half);
    return screen_scene(triangles);
}

traces::Scene world_scene(const std::vector<glm::vec3>& positions) {
    traces::Mesh mesh;
    mesh.name = "triangles";
    mesh.positions = positions;
    traces::Scene scene = traces::scene_of_material("white", glm::vec4(1.0F));
    scene.resources->materials[0].unlit = true;
    traces::add_draws(scene, mesh, {traces::whole(mesh)}, {}, mesh.name);
    scene.name = mesh.name;
    return scene;
}

pipeline::View pixel_view(std::uint32_t width, std::uint32_t height) {
    pipeline::View view{glm::mat4(1.0F), glm::mat4(1.0F), width, height};
    view.projection[0][0] = 2.0F / static_cast<float>(width);
    view.projection[1][1] = -2.0F / static_cast<float>(height);
    view.projection[2][2] = 2.0F;
    view.projection[3] = glm::vec4(-1.0F, 1.0F, -1.0F, 1.0F);
    return view;
}

pipeline::View perspective_view(std::uint32_t width, std::uint32_t height, double fovy_degrees, double near,
                                double far) {
    const double aspect = static_cast<double>(width) / height, fovy = fovy_degrees * std::numbers::pi / 180.0;
    const glm::dmat4 projection =
        far > 0.0 ? glm::perspectiveRH_NO(fovy, aspect, near, far) : glm::infinitePerspectiveRH(fovy, aspect, near);
    return {glm::mat4(1.0F), glm::mat4(projection), width, height};
}

pipeline::FragmentStream rasterized(traces::Scene& scene, const pipeline::View& view) {
    scene.resources->place();
    scene.resources->validate(scene.name);
    std::vector<std::uint32_t> all(scene.draws.size());
    std::iota(all.begin(), all.end(), 0U);
    pipeline::FrontEndOptions options;
    options.both_faces = true;
    options.threads = 1;
    return pipeline::rasterize(*scene.resources, scene.draws, all, view, options);
}

std::vector<std::uint32_t> coverage(const pipeline::FragmentStream& stream) {
    std::vector<std::uint32_t> counts(std::size_t{stream.width} * stream.height);
    for (const pipeline::Quad& quad : stream.quads)
        for (std::size_t lane = 0; lane < 4; ++lane)
            if (((quad.covered >> lane) & 1U) != 0) ++counts.at((quad.y + lane / 2) * stream.width + quad.x + lane % 2);
    return counts;
}

std::uint32_t most_covered(const pipeline::FragmentStream& stream) {
    const std::vector<std::uint32_t> counts = coverage(stream);
    return counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end());
}

bool all_finite(const pipeline::FragmentStream& stream) {
    for (const auto& depths : stream.depths)
        for (const float depth : depths)
            if (!(depth >= 0.0F && depth <= 1.0F)) return false;
    for (const auto& colours : stream.colours)
        for (const glm::vec4& colour : colours)
            for (int i = 0; i < 4; ++i)
                if (!std::isfinite(colour[i])) return false;
    return true;
}

Picture coverage_picture(const pipeline::FragmentStream& stream) {
    Picture picture(stream.width, stream.height, {60, 60, 70});
    const std::vector<std::uint32_t> counts = coverage(stream);
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (counts[i] > 0) picture.pixels[i] = counts[i] == 1 ? Colour{255, 255, 255} : Colour{220, 40, 30};
    return picture;
}

Picture picture_of(std::uint32_t width, std::uint32_t height, std::span<const float> rgba) {
    return composite_picture({width, height}, rgba);
}

} // namespace reports::stability
