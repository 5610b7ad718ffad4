// The types of a module. Everything that is computed with consists of 32-bit scalars: a value of n of them fills n
// slots of a register file, in the order in which its members, columns and components are declared.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace traces::spirv {

using Id = std::uint32_t;

/// Bounds of what a module may ask for; a type of this size is one megabyte for a quad.
inline constexpr std::uint32_t largest_type = 1U << 16; ///< scalars
inline constexpr std::uint32_t deepest_type = 32;

enum class Kind : std::uint8_t {
    nothing,
    truth,
    whole,   ///< signed, 32 bits
    natural, ///< unsigned, 32 bits
    real,    ///< 32 bits
    vector,
    matrix,
    array,
    structure,
    pointer,
    image,
    sampler,
    sampled_image,
    function,
};

/// SPIR-V specification 1.6, section 3.7.
enum class Storage : std::uint32_t {
    uniform_constant = 0,
    input = 1,
    uniform = 2,
    output = 3,
    invocation = 6, ///< "Private"
    function = 7,
    push_constant = 9,
};

/// Section 3.8.
enum class ImageDimension : std::uint32_t { d1 = 0, d2 = 1, d3 = 2, cube = 3, rectangle = 4, buffer = 5 };

struct ImageType {
    ImageDimension dimension = ImageDimension::d2;
    bool depth = false, arrayed = false, multisampled = false;
    Kind texel = Kind::real; ///< real, whole or natural
};

/// Components of a place in the image, without layer.
std::uint32_t coordinates_of(ImageDimension dimension);

struct Decorations {
    std::optional<std::uint32_t> location{}, component{}, binding{}, set{}, built_in{}, offset{}, array_stride{},
        matrix_stride{};
    bool row_major = false, flat = false, no_perspective = false, centroid = false, block = false, buffer = false;
};

struct Member {
    Id type = 0;
    std::string name{};
    Decorations decorations{};
    std::uint32_t first = 0; ///< scalars of the members before it
};

struct Type {
    Kind kind = Kind::nothing;
    Id element = 0;          ///< of vectors, matrices (a column), arrays, pointers, sampled images; result of functions
    std::uint32_t count = 1; ///< components, columns or elements
    std::uint32_t scalars = 0;     ///< 32-bit scalars in all; 0: not a value
    std::uint32_t depth = 0;       ///< how deep types are nested
    Storage storage{};             ///< of pointers
    std::uint32_t stride = 0;      ///< bytes from element to element; 0: not laid out
    std::vector<Member> members{}; ///< of structures; parameters of functions
    ImageType image{};
    bool block = false, buffer = false;

    bool scalar() const { return kind == Kind::truth || number(); }
    bool number() const { return kind == Kind::whole || kind == Kind::natural || kind == Kind::real; }
    bool opaque() const { return kind == Kind::image || kind == Kind::sampler || kind == Kind::sampled_image; }
};

} // namespace traces::spirv
