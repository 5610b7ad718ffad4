// Reads the words of a module one instruction after the other; private to module*.cpp.
#pragma once

#include "traces/spirv/module.hpp"

#include <utility>

namespace traces::spirv {

class ModuleReader {
  public:
    explicit ModuleReader(Module& module) : module_(module) {}
    void read();

  private:
    struct Text {
        std::string text;
        std::uint32_t next = 0; ///< operand behind it
    };

    void header();
    Instruction next(std::uint32_t& at);
    void global(const Instruction& instruction);
    void in_function(const Instruction& instruction);
    void finish_decorations();

    void name(const Instruction& instruction);
    void decorate(const Instruction& instruction, std::uint32_t first, Decorations& decorations);
    void entry_point(const Instruction& instruction);
    void execution_mode(const Instruction& instruction);
    void import(const Instruction& instruction);
    void variable(const Instruction& instruction);
    bool debug_or_annotation(const Instruction& instruction);

    // module_types.cpp
    bool type_or_constant(const Instruction& instruction);
    Type scalar_type(const Instruction& instruction);
    Type composite_type(const Instruction& instruction);
    Type structure_type(const Instruction& instruction);
    Type image_type(const Instruction& instruction);
    Type other_type(const Instruction& instruction);
    void constant(const Instruction& instruction);
    std::vector<std::uint32_t> composite(const Instruction& instruction, const Type& type);

    void begin_function(const Instruction& instruction);
    void end_function(const Instruction& instruction);
    void add_to_block(const Instruction& instruction);

    std::uint32_t operand(const Instruction& instruction, std::uint32_t i) const {
        return module_.operand(instruction, i);
    }
    Id id_operand(const Instruction& instruction, std::uint32_t i) const; ///< within bounds
    Text text(const Instruction& instruction, std::uint32_t first) const;
    void define(const Instruction& instruction, Names what, std::size_t index);
    const Type& member_type(const Instruction& instruction, std::uint32_t i) const; ///< of an operand that is a value's

    Module& module_;
    Function* function_ = nullptr; ///< that is being read
    bool in_block_ = false, has_body_ = false;
    std::uint32_t scalars_ = 0; ///< of all constants
    std::map<std::pair<Id, std::uint32_t>, Decorations> member_decorations_;
    std::map<std::pair<Id, std::uint32_t>, std::string> member_names_;
};

} // namespace traces::spirv
