// Functions, blocks and the ways between them.
#include "sim/check.hpp"
#include "traces/spirv/resolver.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace traces::spirv {

namespace {

constexpr std::uint32_t deepest_call = 64;

std::uint32_t effort_of(const Operation& operation) { return 1 + operation.count / 4; }

} // namespace

Program::~Program() = default;

Program::Program(const Module& module, std::string_view name) {
    const std::vector<EntryPoint>& entries = module.entry_points();
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&](const EntryPoint& e) { return name.empty() || e.name == name; });
    if (found == entries.end()) throw sim::InputError(fmt::format("SPIR-V: expected an entry point '{}'", name));
    if (name.empty() && entries.size() > 1)
        throw sim::InputError(fmt::format("SPIR-V: expected one entry point, got {}", entries.size()));
    entry = *found;
    Resolver(module, *this).resolve();
}

void Resolver::resolve() {
    const Instruction user{Op::entry_point, 0, 0, 0, 0, 0};
    const Function& main = module_.function(program_.entry.function, user);
    require(main.parameters.empty(), user, "expected a function without parameters");
    begin_block();
    variables();
    Activation activation;
    activation.function = &main;
    function(main, activation);
    program_.slots = slots_;
    for (const Operation& operation : program_.operations)
        program_.largest_result = std::max(program_.largest_result, operation.count);
}

void Resolver::begin_block() {
    block_ = {};
    block_operations_.clear();
}

void Resolver::end_block(Ending ending, Slot condition, std::uint32_t first_edge) {
    block_.first = static_cast<std::uint32_t>(program_.operations.size());
    block_.operations = static_cast<std::uint32_t>(block_operations_.size());
    block_.effort += block_.cost;
    block_.ending = ending;
    block_.condition = condition;
    block_.first_edge = first_edge;
    block_.edges = static_cast<std::uint32_t>(program_.edges.size()) - first_edge;
    program_.operations.insert(program_.operations.end(), block_operations_.begin(), block_operations_.end());
    program_.blocks.push_back(block_);
    begin_block();
}

void Resolver::emit(const Instruction& user, Operation operation) {
    require(program_.operations.size() + block_operations_.size() < most_operations, user,
            fmt::format("expected a shader of {} operations or fewer, with its calls put in place", most_operations));
    block_operations_.push_back(operation);
    block_.effort += effort_of(operation);
}

void Resolver::initialise(const Instruction& user, Slot slot, Id constant_id) {
    const Value initial = constant(constant_id, user);
    const std::uint32_t count = type(initial.type).scalars;
    emit(user, {copy_of(count), slot, count, initial.slot});
}

void Resolver::function(const Function& function, Activation& activation) {
    activation_ = &activation;
    // The only way out of the function is its end: what follows the call goes on in the same block.
    const auto returns = [&](const BasicBlock& block) {
        const Op op = module_.instruction(block.last - 1).op;
        return op == Op::return_nothing || op == Op::return_value;
    };
    const bool falls_through = activation.caller != nullptr && returns(function.blocks.back()) &&
                               std::count_if(function.blocks.begin(), function.blocks.end(), returns) == 1;
    for (const BasicBlock& block : function.blocks) {
        activation.label = block.label;
        spend({Op::label, function.word, 0, 0, 0, 0}, 16);
        while (!activation.constructs.empty() && activation.constructs.back().merge == block.label)
            activation.constructs.pop_back();
        // Blocks are added when they end, so this one's number is that of those before it.
        activation.blocks[block.label] = static_cast<std::uint32_t>(program_.blocks.size());
        for (std::uint32_t i = block.first; i + 1 < block.last; ++i) instruction(module_.instruction(i));
        const Instruction& last = module_.instruction(block.last - 1);
        if (block.merge != 0) activation.constructs.push_back({block.merge, block.loop});
        ++block_.cost;
        if (falls_through && &block == &function.blocks.back()) {
            if (last.op == Op::return_value) leave(last);
        } else {
            ending(last);
        }
    }
    finish_edges(activation);
    for (const std::uint32_t edge : activation.returns)
        program_.edges[edge].block = static_cast<std::uint32_t>(program_.blocks.size());
}

void Resolver::call(const Instruction& call) {
    const Function& callee = module_.function(operand(call, 0), call);
    std::uint32_t depth = 0;
    for (const Activation* a = activation_; a != nullptr; a = a->caller, ++depth)
        require(a->function != &callee, call, "expected no recursion");
    require(depth < deepest_call, call, fmt::format("expected calls {} deep or less", deepest_call));
    const Type& signature = type(callee.type);
    require(signature.element == call.type && call.operands == callee.parameters.size() + 1, call,
            "expected the result and the number of arguments of the function");
    for (std::uint32_t i = 0; i < callee.parameters.size(); ++i) {
        const Value argument = value(call, i + 1);
        require(argument.type == signature.members[i].type, call,
                fmt::format("expected argument {} to be of the parameter's type", i));
        values_[callee.parameters[i]] = argument;
    }
    Activation inner;
    inner.function = &callee;
    inner.caller = activation_;
    inner.in_loop = activation_->in_loop || std::any_of(activation_->constructs.begin(), activation_->constructs.end(),
                                                        [](const Construct& construct) { return construct.loop; });
    const std::uint32_t count = type(call.type).scalars;
    if (count > 0) inner.result = define(call);
    function(callee, inner);
    activation_ = inner.caller;
}

void Resolver::leave(const Instruction& instruction) {
    const Id wanted = type(activation_->function->type).element;
    if (instruction.op == Op::return_nothing)
        return require(type(wanted).kind == Kind::nothing, instruction, "expected a value");
    const Value result = registers(instruction, 0);
    require(result.type == wanted, instruction, "expected a value of the function's type");
    const std::uint32_t count = type(wanted).scalars;
    if (activation_->caller != nullptr) emit(instruction, {copy_of(count), activation_->result, count, result.slot});
}

void Resolver::edge_to(const Instruction& instruction, Id label) {
    activation_->edges.push_back(
        {static_cast<std::uint32_t>(program_.edges.size()), activation_->label, label, instruction});
    program_.edges.push_back({});
}

void Resolver::ending(const Instruction& instruction) {
    const auto first = static_cast<std::uint32_t>(program_.edges.size());
    switch (instruction.op) {
    case Op::branch:
        edge_to(instruction, operand(instruction, 0));
        return end_block(Ending::jump, 0, first);
    case Op::branch_conditional: {
        const Slot condition = lanes(instruction, 0, 'b', 1);
        edge_to(instruction, operand(instruction, 1));
        edge_to(instruction, operand(instruction, 2));
        return end_block(Ending::branch, condition, first);
    }
    case Op::switch_case:
        return choice(instruction);
    case Op::return_nothing:
    case Op::return_value:
        leave(instruction);
        if (activation_->caller == nullptr) return end_block(Ending::finish, 0, first);
        activation_->returns.push_back(first);
        program_.edges.push_back({});
        return end_block(Ending::jump, 0, first);
    case Op::unreachable:
        return end_block(Ending::finish, 0, first);
    default:
        return kill(instruction);
    }
}

void Resolver::choice(const Instruction& instruction) {
    const auto first = static_cast<std::uint32_t>(program_.edges.size());
    const Slot selector = lanes(instruction, 0, 'i', 1);
    require(instruction.operands % 2 == 0, instruction, "expected pairs of a number and a block");
    block_.effort += instruction.operands / 2;
    block_.first_literal = static_cast<std::uint32_t>(program_.lists.size());
    edge_to(instruction, operand(instruction, 1));
    for (std::uint32_t i = 2; i < instruction.operands; i += 2) {
        program_.lists.push_back(operand(instruction, i));
        edge_to(instruction, operand(instruction, i + 1));
    }
    end_block(Ending::choice, selector, first);
}

/// Lanes that discard go on as helpers where the construct ends that they are in, so that differences within the quad
/// stay what they are on hardware; not in loops, whose end they might never reach.
void Resolver::kill(const Instruction& instruction) {
    const auto first = static_cast<std::uint32_t>(program_.edges.size());
    const auto loop = [](const Construct& construct) { return construct.loop; };
    const std::vector<Construct>& around = activation_->constructs;
    program_.discards = true;
    if (!around.empty() && !activation_->in_loop && std::none_of(around.begin(), around.end(), loop))
        edge_to(instruction, around.back().merge);
    end_block(Ending::kill, 0, first);
}

void Resolver::phi(const Instruction& instruction) {
    require(instruction.operands % 2 == 0, instruction, "expected pairs of a value and a block");
    activation_->phis.push_back({instruction, activation_->label, define(instruction)});
}

void Resolver::make_moves(const Activation& activation, const PendingEdge& pending, Edge& edge) {
    struct Move {
        Slot from = 0, to = 0;
        std::uint32_t count = 0;
    };
    std::vector<Move> moves;
    spend(pending.user, activation.phis.size());
    for (const Phi& phi : activation.phis) {
        if (phi.block != pending.to) continue;
        std::uint32_t i = 0;
        while (i < phi.instruction.operands && operand(phi.instruction, i + 1) != pending.from) i += 2;
        if (i >= phi.instruction.operands) {
            require(pending.user.op == Op::kill || pending.user.op == Op::terminate_invocation, phi.instruction,
                    fmt::format("expected a value for block {}", pending.from));
            continue;
        }
        const Value source = registers(phi.instruction, i);
        require(source.type == phi.instruction.type, phi.instruction, "expected values of the type of the phi");
        if (source.slot != phi.slot) moves.push_back({source.slot, phi.slot, type(source.type).scalars});
    }
    // All phis of a block change at once: what another move overwrites goes the way of a register of its own.
    const auto overwritten = [&](const Move& move) {
        return std::any_of(moves.begin(), moves.end(), [&](const Move& other) {
            return move.from < other.to + static_cast<Slot>(other.count) &&
                   other.to < move.from + static_cast<Slot>(move.count);
        });
    };
    const auto add = [&](Slot from, Slot to, std::uint32_t count) {
        emit(pending.user, {copy_of(count), to, count, from});
        ++edge.moves;
    };
    edge.first = static_cast<std::uint32_t>(program_.operations.size());
    begin_block();
    const std::vector<Move> all = moves;
    spend(pending.user, all.size() * all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        if (overwritten(all[i])) {
            moves[i].from = allocate(pending.user, all[i].count);
            add(all[i].from, moves[i].from, all[i].count);
        }
    for (const Move& move : moves) add(move.from, move.to, move.count);
    program_.operations.insert(program_.operations.end(), block_operations_.begin(), block_operations_.end());
}

void Resolver::finish_edges(Activation& activation) {
    // Of a block that goes on behind the call.
    Block open = block_;
    std::vector<Operation> open_operations = std::exchange(block_operations_, {});
    const Id entry = activation.function->blocks.front().label;
    for (const PendingEdge& pending : activation.edges) {
        const auto target = activation.blocks.find(pending.to);
        require(target != activation.blocks.end() && pending.to != entry, pending.user,
                fmt::format("expected id {} to be a block of the function, and not its first", pending.to));
        Edge& edge = program_.edges[pending.edge];
        edge.block = target->second;
        make_moves(activation, pending, edge);
        Block& into = edge.block < program_.blocks.size() ? program_.blocks[edge.block] : open;
        into.effort += block_.effort;
    }
    block_ = open;
    block_operations_ = std::move(open_operations);
}

void Resolver::instruction(const Instruction& instruction) {
    spend(instruction, 16 + instruction.operands);
    const auto counts = [&] {
        return instruction.op != Op::variable && instruction.op != Op::phi && instruction.op != Op::undef;
    };
    if (counts()) ++block_.cost;
    switch (instruction.op) {
    case Op::phi:
        return phi(instruction);
    case Op::function_call:
        return call(instruction);
    case Op::ext_inst:
        return extended(instruction);
    case Op::undef: {
        const Type& of = type(instruction.type);
        require(of.scalars > 0, instruction, "expected the type of a value");
        return define_as(instruction, {Is::registers, instruction.type,
                                       fixed(instruction, std::vector<std::uint32_t>(of.scalars, 0)), 0});
    }
    case Op::demote_to_helper_invocation:
        program_.discards = true;
        return emit(instruction, {demote});
    case Op::is_helper_invocation: {
        check_kind(instruction, instruction.type, 'b', 1, "the result");
        return emit(instruction, {is_helper, define(instruction), 1});
    }
    default:
        break;
    }
    if (!memory(instruction) && !composite(instruction) && !arithmetic(instruction) && !texture(instruction))
        fail(instruction, "not modelled in a function");
}

} // namespace traces::spirv
