#include "traces/ground.hpp"

#include "sim/check.hpp"
#include "traces/generators/solids.hpp"
#include "traces/hash.hpp"

#include <fmt/format.h>

namespace traces {

void add_ground(Scene& scene) {
    if (scene.screen_space)
        throw sim::InputError(
            fmt::format("{}+ground: expected a scene with a bottom, these places are on the screen", scene.name));
    const glm::vec3 middle = (scene.lo + scene.hi) / 2.0F;
    const float half = 1.5F * (scene.radius > 0.0F ? scene.radius : 1.0F);
    Mesh mesh;
    mesh.name = "ground";
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1)}) {
        mesh.positions.emplace_back(middle.x + corner.x * half, scene.lo.y, middle.z + corner.y * half);
        mesh.normals.emplace_back(0.0F, 1.0F, 0.0F);
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    add_object(scene, mesh, "ground", {0.8F, 0.8F, 0.8F, 1.0F}, scene.name);
    scene.triangles += 2;
    scene.name += "+ground";
    ContentHash hash;
    hash.add_values(std::span<const char>(scene.hash));
    hash.add_values(std::span<const char>("+ground", 7));
    scene.hash = hash.hex();
    finish_scene(scene);
}

} // namespace traces
