// An entry point of a module, resolved: calls are put in place, operands are places in a register file, and every
// operation is a function that works on the four lanes of a quad. Made once, shared by all threads.
//
// Modelled: functions (no recursion), every control flow that SPIR-V can express, arrays with an index that varies
// (clamped to its bounds), reads of uniforms and textures, discard. Loads of what a run cannot change, and parts of
// composites, take no time here; they count as instructions all the same.
// Bounded: registers, operations, uniforms; see the constants.
#pragma once

#include "traces/spirv/module.hpp"
#include "traces/spirv/registers.hpp"
#include "traces/spirv/textures.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace traces::spirv {

inline constexpr std::uint32_t most_slots = 1U << 17; ///< 2 MiB for a quad
inline constexpr std::uint32_t most_operations = 1U << 18;
inline constexpr std::uint32_t most_uniform_words = 1U << 20;

struct Run;
struct Operation;
using Handler = void (*)(Run&, const Operation&);

struct Operation {
    Handler run = nullptr;
    Slot result = 0;         ///< the first of
    std::uint32_t count = 0; ///< those that it writes in all lanes; others keep what lanes that are not running hold
    Slot a = 0, b = 0, c = 0, d = 0; ///< operands: slots, sizes, or places in Program::lists and texture_calls
};

/// From one block to another: moves into the registers of its phis.
struct Edge {
    std::uint32_t block = 0, first = 0, moves = 0;
};

enum class Ending : std::uint8_t { jump, branch, choice, finish, kill };

struct Block {
    std::uint32_t first = 0, operations = 0;
    std::uint32_t cost = 0;   ///< SPIR-V instructions, but labels, merges, variables, phis and undefined values
    std::uint32_t effort = 0; ///< of the host; at least the cost
    Ending ending = Ending::finish;
    Slot condition = 0;
    std::uint32_t first_edge = 0, edges = 0; ///< of a choice: the default, then one for each literal
    std::uint32_t first_literal = 0;         ///< in Program::lists
};

/// A variable at the border of the shader, or a member of a block there.
struct InterfaceVariable {
    std::string name;
    Decorations decorations; ///< location, built-in, interpolation
    Kind kind{};             ///< of a scalar
    std::uint32_t components = 1, columns = 1, elements = 1;
    Slot slot = 0; ///< component c of column k of element e: (e * columns + k) * components + c slots behind it
};

/// A block of uniforms, or a plain one: where its bytes lie in the words that a draw provides.
struct UniformVariable {
    std::string name; ///< of the variable; of the block where it has none
    Decorations decorations;
    Id type = 0;
    bool block = false; ///< as laid out in the module; else without gaps, matrices by columns
    std::uint32_t first = 0, words = 0;
};

/// Part of a uniform. Element e, column k, component c: first + e * element_stride + k * column_stride + c * stride.
struct UniformPlace {
    std::uint32_t first = 0;
    Kind kind{};
    std::uint32_t components = 1, columns = 1, elements = 1;
    std::uint32_t stride = 1, column_stride = 0, element_stride = 0; ///< words
};

/// A uniform's word that is kept in a register.
struct UniformRegister {
    Slot slot = 0;
    std::uint32_t word = 0;
    bool truth = false;
};

struct TextureCall;

struct Program {
    /// The entry point of this name, or the only one where the name is empty. Throws sim::InputError.
    explicit Program(const Module& module, std::string_view entry = {});
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    /// Where a uniform lies, by GLSL's name for it: "colour", "lights[2].position", "Block.member".
    std::optional<UniformPlace> uniform(const Module& module, std::string_view path) const;
    /// Null when there is none.
    const InterfaceVariable* input(std::string_view name) const;
    const InterfaceVariable* output(std::string_view name) const;
    const InterfaceVariable* built_in(std::uint32_t number) const; ///< SPIR-V specification, section 3.21; inputs first

    EntryPoint entry;
    std::vector<InterfaceVariable> inputs, outputs;
    std::vector<UniformVariable> uniforms;
    std::vector<TextureVariable> textures;
    std::uint32_t uniform_words = 0;
    bool discards = false;

    std::vector<Operation> operations;
    std::vector<Block> blocks; ///< lanes in earlier ones run first, so that they meet again
    std::vector<Edge> edges;
    std::vector<std::uint32_t> lists;
    std::vector<TextureCall> texture_calls;
    std::vector<UniformRegister> uniform_registers;
    std::vector<std::uint32_t> constants; ///< slot -1 - i holds constant i in all lanes, as far as it is no uniform
    std::uint32_t slots = 0;              ///< that a run may change
    std::uint32_t kept_slots = 0;         ///< inputs: the first of them
    std::uint32_t largest_result = 0;     ///< slots that one operation writes
};

} // namespace traces::spirv
