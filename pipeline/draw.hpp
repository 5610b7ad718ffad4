// What an application hands to the GPU: buffers, vertex layouts, textures, materials, draws.
//
// Plain data. Indices into the vectors of `Resources` link the parts; whoever fills them (scene import, generators)
// guarantees that every index, offset and length is in range (validate() checks it).
#pragma once

#include "pipeline/material.hpp"
#include "pipeline/sample_planes.hpp"
#include "pipeline/topology.hpp"
#include "sim/field.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

namespace pipeline {

/// Of vertex attributes. The last two are packed: x, y and z of 10 bits and w of 2, x in the low bits of 4 bytes
/// (GL_INT_2_10_10_10_REV and its unsigned twin).
enum class ComponentType : std::uint8_t { f32, f16, s8, u8, s16, u16, u32, s10_10_10_2, u10_10_10_2 };
inline constexpr ComponentType last_component_type = ComponentType::u10_10_10_2;
constexpr bool is_packed(ComponentType type) { return type >= ComponentType::s10_10_10_2; }

/// Bytes of one element; packed types have 4 components.
constexpr std::uint32_t element_bytes(ComponentType type, std::uint32_t components) {
    constexpr std::array<std::uint32_t, 7> sizes{4, 2, 1, 1, 2, 2, 4};
    return is_packed(type) ? 4 : sizes[static_cast<std::size_t>(type)] * components;
}

/// What an attribute is to the vertex shader (specification 004, section 2.1).
enum class Semantic : std::uint8_t {
    position,
    normal,
    colour,
    secondary_colour,
    texcoord0,
    texcoord1,
    texcoord2,
    texcoord3,
    texcoord4,
    texcoord5,
    texcoord6,
    texcoord7,
    generic, ///< number 0; nothing in hardware tells them apart
    generic1,
    generic2,
    generic3,
    generic4,
    generic5,
    generic6,
    generic7,
    generic8,
    generic9,
    generic10,
    generic11,
    generic12,
    generic13,
    generic14,
    generic15
};
inline constexpr std::uint32_t semantics = 28;
inline constexpr std::uint32_t texcoord_sets = 8;
/// Texture coordinates of set 0 to 7.
constexpr Semantic texcoord(std::uint32_t set) {
    return static_cast<Semantic>(static_cast<std::uint32_t>(Semantic::texcoord0) + set);
}
/// The bit of a semantic in a mask of attributes.
constexpr std::uint32_t mask_of(Semantic semantic) { return 1U << static_cast<std::uint32_t>(semantic); }

/// Which kind of hardware input an attribute takes; the costs of formats differ by it.
enum class Slot : std::uint8_t { position, normal, colour, texcoord, generic };
constexpr Slot slot_of(Semantic semantic) {
    if (semantic >= Semantic::texcoord0 && semantic <= Semantic::texcoord7) return Slot::texcoord;
    switch (semantic) {
    case Semantic::position:
        return Slot::position;
    case Semantic::normal:
        return Slot::normal;
    case Semantic::colour:
    case Semantic::secondary_colour:
        return Slot::colour;
    default:
        return Slot::generic;
    }
}

/// Bytes in GPU memory. `address` is where they lie; assigned by Resources::place().
struct Buffer {
    std::string name;
    std::vector<std::byte> bytes;
    std::uint64_t address = 0;
};

/// Where one vertex attribute lies: element i starts at offset + i * stride of `buffer`.
struct VertexAttribute {
    Semantic semantic = Semantic::position;
    ComponentType type = ComponentType::f32;
    std::uint8_t components = 3; ///< 1 to 4; 4 of packed types
    bool normalized = false;
    std::uint32_t buffer = 0;
    std::uint64_t offset = 0;
    std::uint32_t stride = 12; ///< bytes; tightly packed data states its real element size here
    /// 0: element i is vertex i's. Else all vertices of instance i have element i / divisor.
    std::uint32_t divisor = 0;

    std::uint32_t bytes() const { return element_bytes(type, components); } ///< of one element
};

/// The vertex input of a draw.
struct Geometry {
    std::string name;
    Topology topology = Topology::triangles;
    std::vector<VertexAttribute> attributes;
    std::uint32_t vertex_count = 0;
    IndexType index_type = IndexType::none;
    std::uint32_t index_buffer = 0;
    std::uint64_t index_offset = 0;
    std::uint32_t index_count = 0; ///< number of indices, or of vertices when not indexed
    /// An index of restart_index() ends a strip, a fan, a loop or a begun primitive of a list; it counts in
    /// index_count.
    bool primitive_restart = false;
    /// With primitive restart: where primitives begin, and behind them {index_count, all primitives}. Filled by
    /// Resources::find_runs().
    std::vector<IndexRun> runs;

    const VertexAttribute* find(Semantic semantic) const;
    /// Primitives the topology makes of the indices, degenerate ones included.
    std::uint32_t primitive_count() const;
    /// The same where they are triangles, else 0.
    std::uint32_t triangle_count() const { return corners_of(topology) == 3 ? primitive_count() : 0; }
};

enum class Wrap : std::uint8_t { repeat, clamp, mirror, border };
enum class Filter : std::uint8_t {
    nearest,
    linear,
    nearest_mip_nearest,
    linear_mip_nearest,
    nearest_mip_linear,
    linear_mip_linear
};

/// An RGBA8 image with its mip levels (level 0 first, each half the size of the one before, down to 1x1). Where
/// `decode` is set, levels have their sizes but no texels yet.
struct Texture {
    struct Level {
        std::uint32_t width = 0, height = 0;
        std::vector<std::uint8_t> rgba; ///< width * height * 4, row 0 is the top row
        std::uint64_t address = 0;      ///< in GPU memory, 4x4-texel tiles of 64 bytes in row order
    };
    std::string name;
    std::vector<Level> levels;
    std::function<std::vector<std::uint8_t>()> decode; ///< the texels of level 0; throws sim::InputError
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    glm::vec4 border{0.0F}; ///< what Wrap::border reads beyond the image, linear
    Filter min_filter = Filter::linear_mip_nearest, mag_filter = Filter::linear;
    bool srgb = true; ///< texels are sRGB-encoded and decoded to linear on read

    /// Builds levels 1.. from level 0 by a 2x2 box filter (in linear light when srgb).
    void make_mips();
    /// One empty level for each size from this one down to 1x1.
    void make_empty_levels(std::uint32_t width, std::uint32_t height);
};

/// A texture that is made when somebody asks for it: most frames read none of them.
struct LateTexture {
    Texture texture;                 ///< without levels until then
    std::function<Texture()> make{}; ///< with all levels and texels; throws sim::InputError
};

class VertexProgram;

/// One draw call: a geometry with a material, once per model matrix.
struct Draw {
    std::string name;
    std::uint32_t geometry = 0;
    std::uint32_t material = 0;
    std::vector<glm::mat4> instances; ///< model-to-world matrices, at least one
    /// Makes positions and varyings of all attributes of the geometry, in place of the matrices; null: none.
    std::shared_ptr<const VertexProgram> program{};
};

/// Where the positions of vertices come from: of attributes, or a vertex program makes them of anything.
enum class Positions : std::uint8_t { attribute, computed };

struct Resources {
    std::vector<Buffer> buffers;
    std::vector<Geometry> geometries;
    mutable std::vector<Texture> textures; ///< mutable for read_textures() alone, which changes no value that is seen
    std::vector<Material> materials;
    mutable std::vector<LateTexture> maps; ///< of materials, beside their colours; mutable for read_map() alone

    /// Gives every buffer and texture level an address in GPU memory, 256-byte aligned, in order.
    void place();
    /// Decodes the textures that are not yet. To be called by whoever is going to read texels, before; by one thread.
    /// Throws sim::InputError for an image that cannot be decoded, and for more than 2 GiB of texels.
    void read_textures() const;
    /// maps[number] with its texels, which are made if they are not yet; by one thread. Throws as read_textures() does.
    const Texture& read_map(std::uint32_t number) const;
    /// Fills Geometry::runs where primitive restart is on. Index buffers that are too short leave no runs behind, which
    /// validate() refuses.
    void find_runs();
    /// Throws sim::InputError naming `where` when an index, offset or length is out of range, when an index value of
    /// an index buffer is >= vertex_count (the restart index aside), or when runs are not those of the indices.
    void validate(const std::string& where, Positions positions = Positions::attribute) const;
};

/// From where, and onto how many pixels, the scene is drawn.
struct View {
    glm::mat4 view{1.0F};
    glm::mat4 projection{1.0F}; ///< to clip space with -w <= z <= w mapped to window depth [0,1] by (z/w+1)/2
    std::uint32_t width = 512, height = 512; ///< pixels, 1 to 16384
    std::uint32_t samples = 1;               ///< of each pixel: 1, 4 or 8

    std::size_t pixels() const { return std::size_t{width} * height; }
    /// Rows of its surfaces, those of all samples.
    std::uint32_t rows() const { return samples * plane_rows(height, samples); }
    std::size_t places() const { return std::size_t{width} * rows(); }
    std::uint64_t samples_drawn() const { return std::uint64_t{pixels()} * samples; }
};

} // namespace pipeline

template <>
struct sim::EnumNames<pipeline::ComponentType> {
    static constexpr std::array<std::string_view, 9> names{"f32", "f16", "s8",          "u8",         "s16",
                                                           "u16", "u32", "s10_10_10_2", "u10_10_10_2"};
};

template <>
struct sim::EnumNames<pipeline::Semantic> {
    static constexpr std::array<std::string_view, pipeline::semantics> names{
        "position",  "normal",    "colour",    "secondary_colour", "texcoord0", "texcoord1", "texcoord2",
        "texcoord3", "texcoord4", "texcoord5", "texcoord6",        "texcoord7", "generic",   "generic1",
        "generic2",  "generic3",  "generic4",  "generic5",         "generic6",  "generic7",  "generic8",
        "generic9",  "generic10", "generic11", "generic12",        "generic13", "generic14", "generic15"};
};
