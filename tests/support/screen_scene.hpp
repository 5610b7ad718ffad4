// Triangles placed on the screen, for cases that no generator makes.
#pragma once

#include "traces/generators/screen.hpp"
#include "traces/scene.hpp"

#include <vector>

namespace support {

/// Corners: x and y in pixels from the top left corner of the viewport, z the window depth.
struct ScreenTriangle {
    glm::vec3 a, b, c;
};

/// One draw of these triangles, in this order, each with a colour of its own; not indexed.
inline traces::Scene screen_scene(const std::vector<ScreenTriangle>& triangles) {
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

} // namespace support
