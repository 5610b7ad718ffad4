// A scene whose geometries are replaced, one by one.
#pragma once

#include "traces/preparation/triangle_mesh.hpp"
#include "traces/scene.hpp"

#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace traces {

/// What a geometry became: a mesh, and the matrix that takes its positions back to those of the geometry.
struct PreparedPart {
    TriangleMesh mesh;
    glm::dmat4 restore{1.0};
};

using MakeParts = std::function<std::vector<PreparedPart>(TriangleMesh mesh)>;

/// Every drawn geometry as `make` returns it: a draw becomes one draw per part, in the order of the parts, and draws
/// that shared a geometry share its parts. Geometries and buffers that nobody draws are gone. Throws sim::InputError as
/// finish_scene() does.
Scene rebuild_scene(Scene scene, TopologyWanted topology, const MakeParts& make);

/// The same for one part per geometry.
Scene change_meshes(Scene scene, TopologyWanted topology, const std::function<void(TriangleMesh&)>& change);

} // namespace traces
