// Where the scalars of a uniform lie among the words that a draw provides.
#pragma once

#include "traces/spirv/module.hpp"

#include <cstdint>
#include <vector>

namespace traces::spirv {

/// What a type's place adds to the type. Strides and offsets count words.
struct Layout {
    bool declared = false; ///< by decorations (blocks); else one word behind the other
    std::uint32_t matrix_stride = 0;
    bool row_major = false;
};

/// Words from one part to the next.
std::uint32_t element_stride(const Module& module, const Type& array, const Layout& layout);
std::uint32_t column_stride(const Type& matrix, const Layout& layout);
std::uint32_t component_stride(const Layout& layout); ///< of a matrix' column

/// Where member i begins; makes `layout` that of the member.
std::uint32_t member_offset(const Type& structure, std::uint32_t i, Layout& layout);

/// Words from the first to behind the last scalar. Throws when they are more than `most_uniform_words`, or a part has
/// no place in whole words.
std::uint32_t extent(const Module& module, const Type& type, const Layout& layout, const Instruction& user);

struct PlacedScalar {
    std::uint32_t word = 0;
    bool truth = false;
};
/// Of all scalars of a type, in the order of registers, with `base` added.
void place_scalars(const Module& module, const Type& type, const Layout& layout, std::uint32_t base,
                   std::vector<PlacedScalar>& places);

} // namespace traces::spirv
