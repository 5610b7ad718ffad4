// Closed solids for scenes of several objects, each a draw with a material of its own.
#pragma once

#include "traces/generators/mesh.hpp"

#include <string>

namespace traces {

/// A sphere of `segments` meridians and half as many parallels; its vertices lie on the sphere, its normals are exact.
Mesh sphere_mesh(const glm::dvec3& centre, double radius, std::uint32_t segments);

/// A box with a normal for each side.
Mesh box_mesh(const glm::dvec3& lo, const glm::dvec3& hi);

/// Adds the mesh as a draw with a double-sided material of this colour.
void add_object(Scene& scene, Mesh mesh, std::string name, const glm::vec4& colour, std::string_view place);

/// A scene without draws.
Scene empty_scene();

} // namespace traces
