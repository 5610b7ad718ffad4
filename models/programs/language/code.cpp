#include "models/programs/language/code.hpp"

#include <algorithm>

namespace models::language {

namespace {

std::uint32_t operations(const Instruction& instruction) {
    switch (instruction.code) {
    case Opcode::end:
    case Opcode::jump:
    case Opcode::jump_if_false:
        return 0;
    case Opcode::move:
    case Opcode::truncate:
        return instruction.count;
    case Opcode::swap:
    case Opcode::multiply_add:
        return 2U * instruction.count;
    case Opcode::swap_if_less:
    case Opcode::swap_if_less_or_equal:
        return 1U + 2U * instruction.count;
    default:
        return 1;
    }
}

} // namespace

bool jumps(Opcode code) { return code >= Opcode::jump && code <= Opcode::unless_not_equal; }

std::uint32_t longest_path(const Code& code) {
    std::vector<std::uint32_t> from(code.instructions.size() + 1, 0);
    for (std::size_t i = code.instructions.size(); i-- > 0;) {
        const Instruction& instruction = code.instructions[i];
        std::uint32_t rest = instruction.code == Opcode::jump || instruction.code == Opcode::end ? 0 : from[i + 1];
        if (jumps(instruction.code)) rest = std::max(rest, from[instruction.d]);
        from[i] = operations(instruction) + rest;
    }
    return from.front();
}

} // namespace models::language
