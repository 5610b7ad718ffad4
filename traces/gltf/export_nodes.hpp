// Draws, cameras and lights as the nodes of a glTF scene.
#pragma once

#include "traces/gltf/glb_file.hpp"
#include "traces/scene.hpp"

#include <cstddef>

namespace traces::gltf {

/// A node with the mesh for each instance of a draw; many instances become one node with EXT_mesh_gpu_instancing where
/// translation, rotation and scale say what their matrices do.
void export_draw(GlbFile& file, const pipeline::Draw& draw, std::size_t mesh);

void export_camera(GlbFile& file, const Camera& camera);
void export_light(GlbFile& file, const Light& light);

} // namespace traces::gltf
