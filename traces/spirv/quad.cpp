#include "traces/spirv/quad.hpp"

#include "sim/check.hpp"
#include "traces/spirv/operations.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <utility>

namespace traces::spirv {

namespace {

constexpr std::uint32_t helper_invocation = 23; ///< SPIR-V specification 1.6, section 3.21

} // namespace

Quad::Quad(const Program& program, std::uint64_t budget)
    : program_(program),
      budget_(budget),
      registers_(program.constants.size() + program.slots),
      kept_(program.largest_result),
      file_(registers_.data() + program.constants.size()),
      helper_(program.built_in(helper_invocation)) {
    for (std::size_t i = 0; i < program.constants.size(); ++i)
        file_[-1 - static_cast<std::ptrdiff_t>(i)] = same(program.constants[i]);
}

void Quad::set_uniforms(std::span<const std::uint32_t> uniforms) {
    CHECK(uniforms.size() >= program_.uniform_words);
    uniforms_ = uniforms;
    for (const UniformRegister& uniform : program_.uniform_registers) {
        const std::uint32_t word = uniforms[uniform.word];
        file_[uniform.slot] = same(uniform.truth ? (word != 0 ? ~0U : 0U) : word);
    }
}

void Quad::set(const InterfaceVariable& input, std::uint32_t i, const pipeline::Lanes& lanes) {
    std::memcpy(file_ + input.slot + i, lanes.data(), sizeof lanes);
}
void Quad::set_words(const InterfaceVariable& input, std::uint32_t i, const LaneWords& lanes) {
    std::memcpy(file_ + input.slot + i, lanes.data(), sizeof lanes);
}
pipeline::Lanes Quad::get(const InterfaceVariable& output, std::uint32_t i) const {
    pipeline::Lanes lanes{};
    std::memcpy(lanes.data(), file_ + output.slot + i, sizeof lanes);
    return lanes;
}
LaneWords Quad::get_words(const InterfaceVariable& output, std::uint32_t i) const {
    LaneWords lanes{};
    std::memcpy(lanes.data(), file_ + output.slot + i, sizeof lanes);
    return lanes;
}

std::uint32_t Quad::longest(unsigned lanes) const {
    std::uint32_t longest = 0;
    for (unsigned lane = 0; lane < 4; ++lane)
        if ((lanes >> lane & 1U) != 0) longest = std::max(longest, instructions_[lane]);
    return longest;
}

void Quad::execute(Run& run, std::uint32_t first, std::uint32_t count) {
    if (run.lanes != 15) return execute_masked(run, first, count);
    const Operation* operation = program_.operations.data() + first;
    for (const Operation* end = operation + count; operation != end; ++operation) operation->run(run, *operation);
}

/// Lanes that are not running keep their values: they may have left a loop with them.
void Quad::execute_masked(Run& run, std::uint32_t first, std::uint32_t count) {
    const Operation* operation = program_.operations.data() + first;
    for (const Operation* end = operation + count; operation != end; ++operation) {
        Words* result = file_ + operation->result;
        std::copy_n(result, operation->count, kept_.data());
        operation->run(run, *operation);
        for (std::uint32_t i = 0; i < operation->count; ++i) result[i] = pick(run.mask, result[i], kept_[i]);
    }
}

void Quad::go(Run& run, const Edge& edge, unsigned lanes) {
    if (edge.moves != 0) {
        const unsigned before = std::exchange(run.lanes, lanes);
        run.mask = mask_of(lanes);
        execute(run, edge.first, edge.moves);
        run.lanes = before;
        run.mask = mask_of(before);
    }
    // Helpers that discarded do not go round loops on their own: what ends these may be wrong for them.
    const bool over = edge.block <= block_ && lanes_of(run.mask & run.alive & mask_of(lanes)) == 0;
    for (unsigned lane = 0; lane < 4; ++lane)
        if ((lanes >> lane & 1U) != 0) at_[lane] = over ? finished : edge.block;
}

void Quad::choose(Run& run, const Block& block) {
    const Words selector = file_[block.condition];
    const Edge* edges = program_.edges.data() + block.first_edge;
    const std::uint32_t* literals = program_.lists.data() + block.first_literal;
    unsigned left = run.lanes;
    for (std::uint32_t i = 1; i < block.edges && left != 0; ++i) {
        const unsigned lanes = lanes_of(words(selector == same(literals[i - 1]))) & left;
        if (lanes != 0) go(run, edges[i], lanes);
        left &= ~lanes;
    }
    if (left != 0) go(run, edges[0], left);
}

void Quad::leave(Run& run, const Block& block) {
    const Edge* edges = program_.edges.data() + block.first_edge;
    const auto finish = [&] {
        for (unsigned lane = 0; lane < 4; ++lane)
            if ((run.lanes >> lane & 1U) != 0) at_[lane] = finished;
    };
    switch (block.ending) {
    case Ending::jump:
        return go(run, edges[0], run.lanes);
    case Ending::branch: {
        const unsigned yes = lanes_of(file_[block.condition]) & run.lanes, no = run.lanes & ~yes;
        if (yes != 0) go(run, edges[0], yes);
        if (no != 0) go(run, edges[1], no);
        return;
    }
    case Ending::choice:
        return choose(run, block);
    case Ending::finish:
        return finish();
    case Ending::kill:
        run.alive &= ~run.mask;
        if (lanes_of(run.alive) == 0) at_.fill(finished);
        if (block.edges == 0 || lanes_of(run.alive) == 0) return finish();
        return go(run, edges[0], run.lanes);
    }
}

/// The lanes at the earliest block; false when all have finished.
bool Quad::schedule(Run& run) {
    block_ = std::min(std::min(at_[0], at_[1]), std::min(at_[2], at_[3]));
    if (block_ == finished) return false;
    run.lanes = 0;
    for (unsigned lane = 0; lane < 4; ++lane) run.lanes |= at_[lane] == block_ ? 1U << lane : 0U;
    run.mask = mask_of(run.lanes);
    return true;
}

void Quad::run(ShaderTextures& textures, unsigned covered) {
    CHECK(uniforms_.size() >= program_.uniform_words);
    if (helper_ != nullptr)
        set_words(*helper_, 0, [&] {
            LaneWords lanes{};
            for (unsigned lane = 0; lane < 4; ++lane) lanes[lane] = (covered >> lane & 1U) != 0 ? 0U : ~0U;
            return lanes;
        }());
    std::fill(file_ + program_.kept_slots, file_ + program_.slots, Words{});
    Run run{file_, &program_, uniforms_.data(), &textures, mask_of(15), 15, mask_of(15)};
    at_.fill(0);
    Words instructions{};
    for (std::uint64_t effort = 0; schedule(run);) {
        const Block& block = program_.blocks[block_];
        effort += block.effort;
        if (effort > budget_)
            throw sim::InputError(
                fmt::format("SPIR-V: entry point '{}' needs more than {} instructions", program_.entry.name, budget_));
        instructions += run.mask & run.alive & same(block.cost);
        execute(run, block.first, block.operations);
        leave(run, block);
    }
    std::memcpy(instructions_.data(), &instructions, sizeof instructions);
    alive_ = lanes_of(run.alive);
}

} // namespace traces::spirv
