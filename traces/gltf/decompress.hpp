// Compressed parts of a glTF file: EXT_meshopt_compression and KHR_draco_mesh_compression.
#pragma once

#include "traces/gltf/document.hpp"

namespace traces::gltf {

/// Decodes every compressed bufferView and primitive of `model`, whose bufferViews and accessors then lie in buffers of
/// their own. Each is decoded in a child process by a module that is loaded only for it. Throws sim::InputError that
/// names the part for data that cannot be decoded or are not what the file says of them, and for a module that is
/// missing.
void decompress(const Document& document, tinygltf::Model& model);

} // namespace traces::gltf
