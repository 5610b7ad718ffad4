// Materials and textures as glTF states them.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/gltf/glb_file.hpp"

#include <cstdint>
#include <map>

namespace traces::gltf {

/// Each material, and each texture that one of them uses, is written when it is first asked for.
class MaterialWriter {
  public:
    MaterialWriter(GlbFile& file, const pipeline::Resources& resources) : file_(file), resources_(resources) {}

    /// The number of a material in the file.
    std::size_t use(std::uint32_t material);

  private:
    std::size_t use_texture(std::int32_t texture);

    GlbFile& file_;
    const pipeline::Resources& resources_;
    std::map<std::uint32_t, std::size_t> materials_;
    std::map<std::int32_t, std::size_t> textures_;
};

} // namespace traces::gltf
