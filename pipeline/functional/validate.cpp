// Resources::validate: every index, offset and length is in range, so that nothing behind it has to ask again.
#include "pipeline/draw.hpp"
#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"

#include <cmath>
#include <fmt/format.h>
#include <string_view>

namespace pipeline {

namespace {

constexpr std::uint32_t largest_texture = 65536; ///< texels along one side

/// Throws for one part of the resources: "<where>: <part>: expected <what>".
class Complaint {
  public:
    Complaint(const std::string& where, std::string part) : where_(where), part_(std::move(part)) {}

    template <class... Arguments>
    void require(bool good, fmt::format_string<Arguments...> expected, Arguments&&... arguments) const {
        if (good) return;
        throw sim::InputError(fmt::format("{}: {}: expected {}", where_, part_,
                                          fmt::format(expected, std::forward<Arguments>(arguments)...)));
    }

  private:
    const std::string& where_;
    std::string part_;
};

std::string part_name(std::string_view kind, std::size_t index, const std::string& name) {
    return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} \"{}\"", kind, index, name);
}

/// True when `count` elements of `size` bytes, `stride` bytes apart, lie within `available` bytes from `offset` on.
bool fits(std::uint64_t offset, std::uint64_t count, std::uint64_t stride, std::uint64_t size,
          std::uint64_t available) {
    if (count == 0) return true;
    if (offset > available || size > available - offset) return false;
    return (available - offset - size) / stride >= count - 1;
}

void validate_attribute(const Resources& resources, const Geometry& geometry, const VertexAttribute& attribute,
                        const Complaint& complain) {
    const auto number = static_cast<unsigned>(attribute.semantic);
    complain.require(number < semantics, "a known semantic, not {}", number);
    const std::string_view name = sim::enum_name(attribute.semantic);
    complain.require(attribute.type <= last_component_type, "a known component type, not {}",
                     static_cast<unsigned>(attribute.type));
    complain.require(attribute.components >= 1 && attribute.components <= 4, "1 to 4 components in {}, not {}", name,
                     attribute.components);
    complain.require(!is_packed(attribute.type) || attribute.components == 4, "4 components of {} in {}, not {}",
                     sim::enum_name(attribute.type), name, attribute.components);
    complain.require(attribute.buffer < resources.buffers.size(), "{} to name one of {} buffers, not {}", name,
                     resources.buffers.size(), attribute.buffer);
    const std::uint32_t size = attribute.bytes();
    complain.require(attribute.stride >= size, "a stride of at least {} bytes in {}, not {}", size, name,
                     attribute.stride);
    const std::uint64_t available = resources.buffers[attribute.buffer].bytes.size();
    const std::uint32_t elements = attribute.divisor == 0 ? geometry.vertex_count : 1;
    complain.require(fits(attribute.offset, elements, attribute.stride, size, available),
                     "{} ({} elements of {} bytes, stride {}, from offset {}) within {} bytes", name, elements, size,
                     attribute.stride, attribute.offset, available);
}

void validate_indices(const Resources& resources, const Geometry& geometry, const Complaint& complain) {
    complain.require(static_cast<unsigned>(geometry.index_type) <= static_cast<unsigned>(IndexType::u32),
                     "a known index type, not {}", static_cast<unsigned>(geometry.index_type));
    if (geometry.index_type == IndexType::none) {
        complain.require(geometry.index_count <= geometry.vertex_count, "at most {} vertices to be drawn, not {}",
                         geometry.vertex_count, geometry.index_count);
        return;
    }
    complain.require(geometry.index_buffer < resources.buffers.size(), "an index buffer below {}, not {}",
                     resources.buffers.size(), geometry.index_buffer);
    const std::uint64_t available = resources.buffers[geometry.index_buffer].bytes.size();
    const std::uint32_t size = bytes_of(geometry.index_type);
    complain.require(fits(geometry.index_offset, geometry.index_count, size, size, available),
                     "{} indices of {} bytes from offset {} within {} bytes", geometry.index_count, size,
                     geometry.index_offset, available);
    const IndexReader index(resources, geometry);
    for (std::uint32_t i = 0; i < geometry.index_count; ++i) {
        if (geometry.primitive_restart && index(i) == restart_index(geometry.index_type)) continue;
        complain.require(index(i) < geometry.vertex_count, "index {} below the vertex count {}, not {}", i,
                         geometry.vertex_count, index(i));
    }
}

void validate_runs(const Resources& resources, const Geometry& geometry, const Complaint& complain) {
    if (!geometry.primitive_restart) {
        complain.require(geometry.runs.empty(), "no runs of indices without primitive restart");
        return;
    }
    complain.require(geometry.index_type != IndexType::none, "indices where primitives are restarted");
    complain.require(geometry.runs == index_runs(resources, geometry), "the runs between the restarts of its indices");
}

bool indices_fit(const Resources& resources, const Geometry& geometry) {
    const std::uint32_t size = bytes_of(geometry.index_type);
    return geometry.index_buffer < resources.buffers.size() &&
           fits(geometry.index_offset, geometry.index_count, size, size,
                resources.buffers[geometry.index_buffer].bytes.size());
}

void validate_geometry(const Resources& resources, const Geometry& geometry, Positions positions,
                       const Complaint& complain) {
    complain.require(geometry.topology <= last_topology, "a known topology, not {}",
                     static_cast<unsigned>(geometry.topology));
    complain.require(positions == Positions::computed || geometry.find(Semantic::position) != nullptr,
                     "a position attribute");
    for (const VertexAttribute& attribute : geometry.attributes) {
        complain.require(geometry.find(attribute.semantic) == &attribute, "each semantic once");
        validate_attribute(resources, geometry, attribute, complain);
    }
    validate_indices(resources, geometry, complain);
    validate_runs(resources, geometry, complain);
}

void validate_texture(const Texture& texture, const Complaint& complain) {
    complain.require(!texture.levels.empty(), "at least one level");
    for (std::size_t i = 0; i < texture.levels.size(); ++i) {
        const Texture::Level& level = texture.levels[i];
        complain.require(
            level.width >= 1 && level.height >= 1 && level.width <= largest_texture && level.height <= largest_texture,
            "level {} to be 1 to {} texels wide and high, not {}x{}", i, largest_texture, level.width, level.height);
        complain.require(texture.decode || level.rgba.size() == std::uint64_t{level.width} * level.height * 4,
                         "{} bytes for {}x{} texels in level {}, not {}", std::uint64_t{level.width} * level.height * 4,
                         level.width, level.height, i, level.rgba.size());
        if (i == 0) continue;
        const Texture::Level& larger = texture.levels[i - 1];
        complain.require(
            level.width == std::max(1U, larger.width / 2) && level.height == std::max(1U, larger.height / 2),
            "level {} to be half of {}x{}, not {}x{}", i, larger.width, larger.height, level.width, level.height);
    }
}

bool is_finite(const glm::mat3& matrix) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return true;
}

void validate_material(const Resources& resources, const Material& material, const Complaint& complain) {
    const auto textures = static_cast<std::int64_t>(resources.textures.size());
    complain.require(material.base_texture >= -1 && material.base_texture < textures,
                     "a base texture of -1 to {}, not {}", textures - 1, material.base_texture);
    complain.require(material.texcoord < texcoord_sets, "texture coordinates 0 to 7, not {}", material.texcoord);
    bool finite = std::isfinite(material.alpha_cutoff) && std::isfinite(material.transmission);
    for (int i = 0; i < 4; ++i) finite = finite && std::isfinite(material.base_colour[i]);
    finite = finite && is_finite(material.uv_transform);
    const MaterialMaps& maps = material.maps;
    const auto last = static_cast<std::int64_t>(resources.maps.size()) - 1;
    for (const MaterialMap* map : maps.all()) {
        complain.require(map->texture >= -1 && map->texture <= last, "maps of -1 to {}, not {}", last, map->texture);
        complain.require(map->texcoord < 2, "maps at texture coordinates 0 or 1, not {}", map->texcoord);
        finite = finite && is_finite(map->uv_transform);
    }
    for (const float factor : {maps.normal_scale, maps.metallic_factor, maps.roughness_factor, maps.specular_factor,
                               maps.emissive_factor.r, maps.emissive_factor.g, maps.emissive_factor.b})
        finite = finite && std::isfinite(factor);
    complain.require(finite, "finite numbers");
}

} // namespace

void Resources::find_runs() {
    for (Geometry& geometry : geometries) {
        geometry.runs.clear();
        const bool indexed = geometry.index_type != IndexType::none && geometry.index_type <= IndexType::u32;
        if (geometry.primitive_restart && indexed && indices_fit(*this, geometry))
            geometry.runs = index_runs(*this, geometry);
    }
}

void Resources::validate(const std::string& where, Positions positions) const {
    for (std::size_t i = 0; i < geometries.size(); ++i)
        validate_geometry(*this, geometries[i], positions,
                          Complaint(where, part_name("geometry", i, geometries[i].name)));
    for (std::size_t i = 0; i < textures.size(); ++i)
        validate_texture(textures[i], Complaint(where, part_name("texture", i, textures[i].name)));
    for (std::size_t i = 0; i < maps.size(); ++i)
        if (!maps[i].make)
            validate_texture(maps[i].texture, Complaint(where, part_name("map", i, maps[i].texture.name)));
    for (std::size_t i = 0; i < materials.size(); ++i)
        validate_material(*this, materials[i], Complaint(where, part_name("material", i, materials[i].name)));
}

} // namespace pipeline
