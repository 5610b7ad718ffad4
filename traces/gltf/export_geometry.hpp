// Geometries as glTF primitives.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/gltf/glb_file.hpp"

#include <optional>

namespace traces::gltf {

/// A primitive without its material, or nothing for a geometry without triangles.
std::optional<nlohmann::ordered_json> export_geometry(GlbFile& file, const pipeline::Resources& resources,
                                                      const pipeline::Geometry& geometry);

/// An accessor of floats: "VEC3" or "VEC4" by `components`.
std::size_t export_floats(GlbFile& file, std::span<const float> values, std::uint32_t components);

} // namespace traces::gltf
