// Materials and textures of a glTF file, those that draws use.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/gltf/document.hpp"

#include <cstdint>
#include <map>
#include <tuple>

namespace traces::gltf {

class Materials {
  public:
    /// What draws need is appended to the materials and textures of `resources`.
    Materials(Document& document, pipeline::Resources& resources) : document_(document), resources_(resources) {}

    /// The number of a glTF material among the resources; -1 is the default material.
    std::uint32_t use(int material, std::string_view place);

  private:
    pipeline::Material read(const tinygltf::Material& source, std::string_view place);
    void read_texture(pipeline::Material& material, const tinygltf::TextureInfo& info, std::string_view place);
    template <class Info>
    pipeline::MaterialMap map_of(const Info& info, bool srgb, std::string_view place);
    void read_maps(pipeline::MaterialMaps& maps, const tinygltf::Material& source, std::string_view place);
    /// The number of its image; -1, with a note: it has none that is read.
    int image_of(int texture, std::string_view place);
    /// Name and sampler.
    pipeline::Texture texture_without_texels(int texture, std::string_view place) const;
    std::int32_t use_texture(int texture, std::string_view place);
    std::int32_t use_map(int texture, bool srgb, std::string_view place);

    Document& document_;
    pipeline::Resources& resources_;
    std::map<int, std::uint32_t> materials_;
    std::map<std::tuple<int, int>, std::int32_t> textures_;   ///< by image and sampler
    std::map<std::tuple<int, int, bool>, std::int32_t> maps_; ///< likewise, and whether texels are sRGB-encoded
};

} // namespace traces::gltf
