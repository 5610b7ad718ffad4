#include "tests/support/stage.hpp"

#include "traces/generators/solids.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace support {

Stage::Stage(std::uint32_t columns, std::uint32_t rows) : scene(traces::empty_scene()), width(columns), height(rows) {}

void Stage::add(const Sheet& sheet) {
    const double aspect = static_cast<double>(width) / height;
    traces::Mesh mesh;
    for (const double row : {sheet.top, sheet.bottom})
        for (const double column : {sheet.left, sheet.right})
            mesh.positions.emplace_back((2.0 * column / width - 1.0) * aspect * sheet.distance,
                                        (1.0 - 2.0 * row / height) * sheet.distance, -sheet.distance);
    mesh.normals.assign(4, sheet.normal);
    if (sheet.ramp) mesh.colours = {{0, 0, 0, 255}, {255, 0, 0, 255}, {0, 255, 0, 255}, {255, 255, 0, 255}};
    mesh.indices = {0, 2, 3, 0, 3, 1};
    traces::add_object(scene, std::move(mesh), "sheet " + std::to_string(scene.draws.size()), sheet.colour, "stage");
    if (sheet.colour.a < 1.0F) scene.resources->materials.back().alpha_mode = pipeline::AlphaMode::blend;
}

void Stage::add_whole(double distance, const glm::vec4& colour, const glm::vec3& normal, bool ramp) {
    add({0.0, 0.0, static_cast<double>(width), static_cast<double>(height), distance, colour, normal, ramp});
}

void Stage::add_light(const glm::vec3& place, float range, bool along_z) {
    traces::Light light;
    light.kind = traces::LightKind::spot;
    light.to_world = glm::translate(glm::mat4(1.0F), place);
    if (along_z) light.to_world = glm::rotate(light.to_world, std::numbers::pi_v<float>, glm::vec3(0.0F, 1.0F, 0.0F));
    light.range = range;
    light.outer_cone = std::numbers::pi_v<float> / 4.0F;
    light.inner_cone = light.outer_cone;
    scene.lights.push_back(light);
}

Replay Stage::replay(const std::string& workload, const std::vector<std::string>& settings,
                     const std::string& camera) const {
    traces::Scene drawn = scene;
    drawn.name = "stage";
    traces::finish_scene(drawn);
    ReplayOptions options;
    options.width = width;
    options.height = height;
    options.workload = workload;
    options.camera = camera;
    options.knobs = settings;
    return Replay(std::move(drawn), options);
}

glm::ivec4 codes_at(const std::vector<float>& colours, std::uint32_t width, std::size_t x, std::size_t y) {
    glm::ivec4 codes;
    for (int i = 0; i < 4; ++i)
        codes[i] = static_cast<int>(std::lround(colours[(y * width + x) * 4 + static_cast<std::size_t>(i)] * 255.0F));
    return codes;
}

} // namespace support
