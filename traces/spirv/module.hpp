// A SPIR-V module, read into tables and checked: every index is that of something that exists, every length was
// compared with the words that are there, types are complete, constants are evaluated.
//
// Modelled: shaders of 32-bit scalars, GLSL.std.450. Specialisation constants have their default.
// Not modelled, and an error: other widths, storage buffers and images, runtime arrays, atomics, pointers in memory.
// Source: Khronos SPIR-V specification 1.6. A version of 0, which glslang writes when it is not asked for a version,
// counts as 1.0.
#pragma once

#include "traces/spirv/opcodes.hpp"
#include "traces/spirv/types.hpp"

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traces::spirv {

struct Instruction {
    Op op{};
    std::uint32_t word = 0;     ///< where in the module it begins
    Id type = 0, id = 0;        ///< of the result; 0: none
    std::uint32_t first = 0;    ///< its first operand behind type and result, as a word of the module
    std::uint32_t operands = 0; ///< their number
};

/// Throws the sim::InputError "SPIR-V, word 123 (OpLoad): ...".
[[noreturn]] void fail(const Instruction& instruction, std::string_view problem);

struct Constant {
    Id type = 0;
    std::vector<std::uint32_t> scalars; ///< truths are 0 and 0xFFFFFFFF
};

/// What an id names.
enum class Names : std::uint8_t { nothing, type, constant, variable, function, label, instruction_set, value, other };

struct Variable {
    Id id = 0, type = 0; ///< of what it holds
    Id pointer = 0;      ///< type of the pointer to it
    Storage storage{};
    Id initial = 0; ///< constant; 0: none
    std::uint32_t word = 0;
};

/// Instructions [first, last), of which the last one ends the block; without label and merges.
struct BasicBlock {
    Id label = 0;
    std::uint32_t first = 0, last = 0;
    Id merge = 0; ///< block in which the construct that begins here ends; 0: none
    bool loop = false;
};

struct Function {
    Id id = 0, type = 0;
    std::vector<Id> parameters;
    std::vector<BasicBlock> blocks;
    std::uint32_t word = 0;
};

struct EntryPoint {
    std::uint32_t model = 0; ///< SPIR-V specification, section 3.3: 0 vertex, 4 fragment
    Id function = 0;
    std::string name;
    std::vector<Id> interface;
    bool origin_upper_left = false, sets_depth = false, early_tests = false;
};

class Module {
  public:
    /// Reads and checks it. Throws sim::InputError for the first thing that is wrong.
    explicit Module(std::span<const std::uint32_t> words);

    std::uint32_t bound() const { return static_cast<std::uint32_t>(names_.size()); }
    std::uint32_t operand(const Instruction& instruction, std::uint32_t i) const; ///< throws when there are fewer
    const Instruction& instruction(std::uint32_t i) const { return instructions_[i]; }

    Names names(Id id) const { return id < names_.size() ? names_[id].what : Names::nothing; }
    /// These throw for ids that name something else.
    const Type& type(Id id, const Instruction& user) const;
    const Constant& constant(Id id, const Instruction& user) const;
    const Function& function(Id id, const Instruction& user) const;
    /// Of ids that are known to be types.
    const Type& type(Id id) const { return types_[names_[id].index]; }

    const std::vector<Variable>& variables() const { return variables_; }
    const std::vector<Function>& functions() const { return functions_; }
    const std::vector<EntryPoint>& entry_points() const { return entry_points_; }
    const Decorations& decorations(Id id) const;
    std::string name(Id id) const; ///< OpName, else ""
    bool is_std450(Id set) const { return std450_ != 0 && set == std450_; }
    bool is_ignored_set(Id set) const; ///< its instructions compute nothing

  private:
    friend class ModuleReader;
    struct Named {
        Names what = Names::nothing;
        std::uint32_t index = 0; ///< in the table of its kind
    };

    std::vector<std::uint32_t> words_;
    std::vector<Instruction> instructions_;
    std::vector<Named> names_;
    std::vector<Type> types_;
    std::vector<Constant> constants_;
    std::vector<Variable> variables_;
    std::vector<Function> functions_;
    std::vector<EntryPoint> entry_points_;
    std::map<Id, Decorations> decorations_;
    std::map<Id, std::string> texts_;
    std::vector<Id> ignored_sets_;
    Id std450_ = 0;
};

} // namespace traces::spirv
