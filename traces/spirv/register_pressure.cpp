#include "traces/spirv/register_pressure.hpp"

#include <algorithm>
#include <map>

namespace traces::spirv {

namespace {

struct Life {
    std::uint32_t begin = 0, end = 0; ///< instructions of the module
    std::uint32_t scalars = 0;
};

/// Loops of a function as ranges of instructions.
std::vector<Life> loops_of(const Function& function) {
    std::vector<Life> loops;
    for (const BasicBlock& block : function.blocks) {
        if (!block.loop) continue;
        const auto merge = std::find_if(function.blocks.begin(), function.blocks.end(),
                                        [&](const BasicBlock& one) { return one.label == block.merge; });
        if (merge != function.blocks.end()) loops.push_back({block.first, merge->first, 0});
    }
    return loops;
}

/// Returns the scalars of its variables.
std::uint32_t add_function(const Module& module, const Function& function, std::map<Id, Life>& lives) {
    std::uint32_t variables = 0;
    for (const BasicBlock& block : function.blocks)
        for (std::uint32_t i = block.first; i < block.last; ++i) {
            const Instruction& instruction = module.instruction(i);
            if (instruction.op == Op::variable)
                variables += module.type(module.type(instruction.type).element).scalars;
            else if (instruction.id != 0 && instruction.type != 0)
                lives[instruction.id] = {i, i, module.type(instruction.type).scalars};
            // Numbers in operands may be those of values, too; then a value lives a little longer than it has to.
            for (std::uint32_t k = 0; k < instruction.operands; ++k)
                if (const auto used = lives.find(module.operand(instruction, k)); used != lives.end())
                    used->second.end = i;
        }
    for (const Life& loop : loops_of(function))
        for (auto& [id, life] : lives)
            if (life.begin < loop.begin && life.end >= loop.begin) life.end = std::max(life.end, loop.end);
    return variables;
}

} // namespace

std::uint32_t register_pressure(const Module& module) {
    std::map<Id, Life> lives;
    std::uint32_t always = 0;
    for (const Variable& variable : module.variables())
        if (variable.storage == Storage::output || variable.storage == Storage::invocation)
            always += module.type(variable.type).scalars;
    for (const Function& function : module.functions()) always += add_function(module, function, lives);
    std::map<std::uint32_t, std::int64_t> changes;
    for (const auto& [id, life] : lives) {
        changes[life.begin] += life.scalars;
        changes[life.end + 1] -= life.scalars;
    }
    std::int64_t live = 0, most = 0;
    for (const auto& [at, change] : changes) most = std::max(most, live += change);
    return std::max(1U, (always + static_cast<std::uint32_t>(most) + 3) / 4);
}

} // namespace traces::spirv
