// The operations of the interpreter, by group: functions over the register file, and what the resolver has to know of
// them. A run calls them one after the other; each works on all four lanes.
#pragma once

#include "traces/spirv/program.hpp"
#include "traces/spirv/std450.hpp"

#include <array>
#include <span>
#include <string_view>

namespace traces::spirv {

/// What an operation works on.
struct Run {
    Words* file = nullptr; ///< slot 0
    const Program* program = nullptr;
    const std::uint32_t* uniforms = nullptr;
    ShaderTextures* textures = nullptr;
    Words mask{};       ///< of the lanes that are running
    unsigned lanes = 0; ///< the same as bits
    Words alive{};      ///< lanes that were not discarded
};

/// An instruction that does the same with each component.
struct ComponentWise {
    std::uint32_t number = 0;   ///< Op or Std450
    std::string_view signature; ///< result, operands: r real, i whole or natural, b truth, x any
    std::array<Handler, 4> run; ///< by components
};

std::span<const ComponentWise> real_operations();
std::span<const ComponentWise> whole_operations();
std::span<const ComponentWise> std450_operations();

/// copy: count slots from a. gather: slot i from the i-th of a, b, c, d.
Handler copy_of(std::uint32_t count);
Handler gather_of(std::uint32_t count); ///< 1 to 4

/// Lists for operations whose addresses vary. a: place in Program::lists of {count, base, then slot, stride, bound of
/// each index}. Registers from there on; words of uniforms, with an offset for each scalar behind the indices.
void load_indexed(Run& run, const Operation& operation);
void store_indexed(Run& run, const Operation& operation); ///< from slot b, c of them, in the lanes that run
void load_uniform_indexed(Run& run, const Operation& operation);

void choose_many(Run& run, const Operation& operation);       ///< a of one component ? b : c, count of them
void extract_component(Run& run, const Operation& operation); ///< a: vector of c components, b: index
void insert_component(Run& run, const Operation& operation);  ///< likewise; d: the component
void any_of(Run& run, const Operation& operation);            ///< a: truths, b of them
void all_of(Run& run, const Operation& operation);
void demote(Run& run, const Operation& operation);
void is_helper(Run& run, const Operation& operation);
void to_truth(Run& run, const Operation& operation); ///< a: a word that is not 0

// Matrices lie column by column. c: columns, d: rows.
Handler dot_of(std::uint32_t components);
void scale(Run& run, const Operation& operation); ///< a: count numbers, b: factor
Handler matrix_times_vector(std::uint32_t columns, std::uint32_t rows);
void vector_times_matrix(Run& run, const Operation& operation); ///< a: vector, b: matrix
void matrix_times_matrix(Run& run, const Operation& operation); ///< c: size in the middle, d: rows of the result
void transpose(Run& run, const Operation& operation);           ///< of the operand
void outer_product(Run& run, const Operation& operation);       ///< c: components of b, d: of a
void determinant(Run& run, const Operation& operation);         ///< c: its size
void inverse(Run& run, const Operation& operation);

// Vectors of c components.
void length_of(Run& run, const Operation& operation);
void distance_of(Run& run, const Operation& operation);
void normalize(Run& run, const Operation& operation);
void cross(Run& run, const Operation& operation);
void face_forward(Run& run, const Operation& operation); ///< d: the third operand
void reflect(Run& run, const Operation& operation);
void refract(Run& run, const Operation& operation); ///< d: the ratio of indices

// Two results: c slots each, one behind the other.
void add_carry(Run& run, const Operation& operation);
void subtract_borrow(Run& run, const Operation& operation);
void multiply_extended(Run& run, const Operation& operation); ///< low words, then high words
void multiply_extended_signed(Run& run, const Operation& operation);
void modf_pair(Run& run, const Operation& operation);  ///< fractions, then whole parts
void frexp_pair(Run& run, const Operation& operation); ///< significands, then exponents

// Bit fields of c components; offset b and number of bits d are scalars, of an insertion a list of both at d.
void bit_field_extract(Run& run, const Operation& operation);
void bit_field_extract_signed(Run& run, const Operation& operation);
void bit_field_insert(Run& run, const Operation& operation);

/// Null for what is not a packing.
Handler packing(Std450 function);
std::uint32_t packed_parts(Std450 function); ///< components on the side of floats

/// Value a, its offset b (two components): to first order by differences within the quad; c components.
void interpolate_at_offset(Run& run, const Operation& operation);

} // namespace traces::spirv
