#include "models/programs/language/interpreter.hpp"

#include "models/programs/language/steps.hpp"

#include <algorithm>

namespace models::language {

namespace {

bool in_pixel(Operand place) { return place < own_floats; }

Step step_of(const Code& code, std::size_t at) {
    const Instruction& now = code.instructions[at];
    Step step{nullptr, now.a, now.b, now.c, now.d, now.count};
    std::uint32_t mask = 0;
    for (std::uint32_t bit = 1; Operand* const operand : {&step.a, &step.b, &step.c, &step.d}) {
        if (in_pixel(*operand)) mask |= bit;
        *operand %= own_floats;
        bit *= 2;
    }
    step.run = now.code == Opcode::end ? nullptr : function_of(now, mask);
    if (jumps(now.code)) step.d = static_cast<Operand>(now.d - at); // always forwards
    if (now.code == Opcode::load || now.code == Opcode::store) {
        step.c = now.c;
        step.d = static_cast<Operand>(code.floats_per_entry);
        step.count = static_cast<std::uint16_t>(code.entries - 1);
    }
    return step;
}

} // namespace

Script::Script(const Code& code) : constants_(code.constants) {
    steps_.reserve(code.instructions.size());
    for (std::size_t i = 0; i < code.instructions.size(); ++i) steps_.push_back(step_of(code, i));
}

bool Script::run(float* pixel, std::span<const float> inputs) const {
    Frame frame;
    float* variables = frame.own.data();
    for (auto four = constants_.begin(); four != constants_.end(); four += 4)
        variables = std::copy_n(four, 4, variables);
    if (inputs.size() == 4) // a render target
        std::copy_n(inputs.begin(), 4, variables);
    else
        for (const float input : inputs) *variables++ = input;
    for (const Step* at = steps_.data(); at->run != nullptr;) at = at->run(at, pixel, frame);
    return frame.changed != 0;
}

} // namespace models::language
