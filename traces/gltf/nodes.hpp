// The node hierarchy of a glTF file, and what hangs on its nodes besides meshes.
#pragma once

#include "traces/gltf/accessors.hpp"
#include "traces/gltf/document.hpp"
#include "traces/scene.hpp"

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace traces::gltf {

struct Hierarchy {
    std::vector<glm::dmat4> world;     ///< node to world, for every node of the file
    std::vector<bool> hidden;          ///< of every node: it or one above it is not visible (KHR_node_visibility)
    std::vector<std::size_t> in_scene; ///< nodes of the chosen scene, parents first, in the order of the file's lists
};

/// @param which number of a scene, "" for the default scene (the first where the file names none)
/// Throws sim::InputError for nodes with two parents and for cycles.
Hierarchy read_hierarchy(const Document& document, const std::string& which);

/// Translation, rotation and scale as a matrix; the rotation is a quaternion (x, y, z, w) of any length but 0.
glm::dmat4 transform(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale);

/// The matrices of the instances of a node (EXT_mesh_gpu_instancing), or its own world matrix alone.
std::vector<glm::mat4> instances_of(const Document& document, const Accessors& accessors, std::size_t node,
                                    const glm::dmat4& world);

/// Cameras of the scene in the order of the file's list of cameras.
std::vector<Camera> read_cameras(const Document& document, const Hierarchy& hierarchy);
std::vector<Light> read_lights(const Document& document, const Hierarchy& hierarchy);

} // namespace traces::gltf
