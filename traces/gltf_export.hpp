// Scenes as binary glTF 2.0 files (.glb), so that what was prepared can be read again, here and elsewhere.
//
// Written: all draws with their materials (less their maps, which is a note), base colour textures (PNG), instances,
// cameras and lights. Attributes keep
// their formats and stay side by side or apart as they are; KHR_mesh_quantization is required where integers need it.
// What glTF does not know becomes floats (half floats, 32-bit and packed integers), a list (primitive restart), wider
// indices (the largest value of a type) or multiples of 4 bytes (offsets and strides).
#pragma once

#include "traces/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace traces {

/// Writes `scene` to `path`, which appears there only when it is complete. Returns notes, one line each, on what the
/// file says in another way than the scene. Throws sim::InputError with one line: the scene's places are on the screen,
/// the file would be larger than 4 GiB, or it cannot be written.
std::vector<std::string> export_glb(const Scene& scene, const std::filesystem::path& path);

} // namespace traces
