#include "traces/generators/screen.hpp"

namespace traces {

void add_one_quad_triangle(Mesh& mesh, float x, float y, float depth, Colour colour, bool to_left) {
    // Seen from the block's corner: half the height at the centres' columns 0.5, 1.5 and 2.5 is 0.91, 0.55 and 0.18, so
    // the rows 0.5 and 1.5 (half a pixel off the axis) are inside in the first two columns and outside in the third.
    // All coordinates are multiples of a quarter pixel.
    const float base = to_left ? 1.75F : 0.25F;
    const float apex = to_left ? -1.0F : 3.0F;
    mesh.positions.insert(mesh.positions.end(),
                          {{x + base, y, depth}, {x + base, y + 2.0F, depth}, {x + apex, y + 1.0F, depth}});
    mesh.colours.insert(mesh.colours.end(), 3, colour);
}

void add_rectangle(Mesh& mesh, const glm::vec2& corner, const glm::vec2& size, float depth, Colour colour) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::vec2 far = corner + size;
    mesh.positions.insert(
        mesh.positions.end(),
        {{corner.x, corner.y, depth}, {corner.x, far.y, depth}, {far.x, corner.y, depth}, {far.x, far.y, depth}});
    mesh.colours.insert(mesh.colours.end(), 4, colour);
    for (const std::uint32_t corner_index : {0U, 1U, 2U, 2U, 1U, 3U}) mesh.indices.push_back(first + corner_index);
}

Scene screen_scene(const Mesh& mesh) {
    Scene scene = scene_of_material(mesh.name, glm::vec4(1.0F));
    scene.screen_space = true;
    // The colours are the ones to see, whatever the light.
    scene.resources->materials[0].unlit = true;
    add_draws(scene, mesh, {whole(mesh)}, {.layout = VertexLayout::interleaved}, mesh.name);
    return scene;
}

} // namespace traces
