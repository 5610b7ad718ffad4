// A program as straight code with forward jumps: loops are unrolled, so it is made for one k.
#pragma once

#include <cstdint>
#include <vector>

namespace models::language {

/// Place of a float. While code is generated, it is a bank and a place in it, each bank at a multiple of bank_size;
/// finished code counts the pixel's floats from 0 and those of the run from own_floats: the constants, then its
/// variables.
using Operand = std::uint16_t;

enum class Bank : std::uint8_t { pixel, locals, constants };

inline constexpr std::uint32_t bank_size = 1024;
inline constexpr std::uint32_t most_locals = 256, most_constants = 512;
inline constexpr std::uint32_t own_floats = 1U << 15;

constexpr Operand operand(Bank bank, std::uint32_t place) {
    return static_cast<Operand>(static_cast<std::uint32_t>(bank) * bank_size + place);
}

enum class Opcode : std::uint8_t {
    end,
    move,      ///< a = b, `count` floats
    swap,      ///< a and b, `count` floats
    load,      ///< a = field c of entry b
    store,     ///< field c of entry b = a
    negate,    ///< a = -b
    invert,    ///< a = 1 - b, of truth values
    magnitude, ///< a = |b|
    truncate,  ///< a = b without its fraction, at most 2^24 in size; `count` operations: 0 after one on whole numbers
    add,       ///< a = b + c; and so on
    subtract,
    multiply,
    divide,
    divide_whole, ///< a = b / c without its fraction
    least,
    greatest,
    multiply_add, ///< a = b + c * d, rounded twice; `count` times: a, b and d move on, c stays
    less,         ///< a = b < c
    less_or_equal,
    equal,
    not_equal,
    choose,        ///< a = b ? c : d
    jump,          ///< to d
    jump_if_false, ///< to d unless b
    unless_less,   ///< to d unless b < c
    unless_less_or_equal,
    unless_equal,
    unless_not_equal,
    swap_if_less, ///< a and d, `count` floats, if b < c: the step of every sort
    swap_if_less_or_equal,
};

/// Whether `d` is where to go on.
bool jumps(Opcode code);

struct Instruction {
    Opcode code = Opcode::end;
    std::uint8_t count = 1;
    Operand a = 0, b = 0, c = 0, d = 0;
};

struct Code {
    std::vector<Instruction> instructions;           ///< the last one is the end
    std::vector<float> constants;                    ///< a multiple of four, as an entry behind them is a render target
    std::uint32_t entries = 0, floats_per_entry = 0; ///< for loads and stores
};

/// Operations of the longest way through: one for each arithmetic operation and compare, two where a product is added,
/// one for each float moved, two for each float exchanged; jumps are free, as is what was known before.
std::uint32_t longest_path(const Code& code);

} // namespace models::language
