// glTF 2.0 scenes (.gltf with its files, .glb) through tinygltf.
//
// Read: all primitive modes that make triangles; every index width and component type, normalised, interleaved, sparse;
// node hierarchies; morph targets with their default weights and skins in the rest pose; base colour, its texture and
// transform, alpha modes; normal, metallic-roughness, specular and emissive maps with their factors, whose images are
// read when somebody asks for their texels; cameras; EXT_mesh_gpu_instancing, EXT_meshopt_compression,
// EXT_texture_webp, KHR_draco_mesh_compression, KHR_lights_punctual, KHR_materials_specular (less its colour),
// KHR_materials_transmission, KHR_materials_unlit,
// KHR_mesh_quantization, KHR_node_visibility, KHR_texture_transform. Vertex and index data stay in the layout of the
// file (each bufferView is a buffer), except where they have to be computed.
//
// Not read, with a note in Scene::notes: points and lines, animations, other material properties, other optional
// extensions. A required extension that is not in the list above is an error.
#pragma once

#include "traces/scene.hpp"

#include <filesystem>
#include <string>

namespace traces {

/// @param which number of the glTF scene, "" for the file's default scene
/// Throws sim::InputError "file: place: what was expected" for anything that is not as glTF 2.0 demands.
Scene import_gltf(const std::filesystem::path& path, const std::string& which = {});

} // namespace traces
