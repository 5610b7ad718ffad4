#include "traces/spirv/module.hpp"

#include "sim/check.hpp"
#include "traces/spirv/module_reader.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace traces::spirv {

void fail(const Instruction& instruction, std::string_view problem) {
    throw sim::InputError(fmt::format("SPIR-V, word {} ({}): {}", instruction.word, name_of(instruction.op), problem));
}

namespace {

std::string_view words_for(Names what) {
    constexpr std::array<std::string_view, 9> words{"nothing",    "a type",  "a constant",         "a variable",
                                                    "a function", "a block", "an instruction set", "a value",
                                                    "a text"};
    return words.at(static_cast<std::size_t>(what));
}

} // namespace

std::uint32_t coordinates_of(ImageDimension dimension) {
    switch (dimension) {
    case ImageDimension::d1:
    case ImageDimension::buffer:
        return 1;
    case ImageDimension::d3:
    case ImageDimension::cube:
        return 3;
    default:
        return 2;
    }
}

Module::Module(std::span<const std::uint32_t> words) : words_(words.begin(), words.end()) {
    ModuleReader(*this).read();
}

std::uint32_t Module::operand(const Instruction& instruction, std::uint32_t i) const {
    if (i >= instruction.operands)
        fail(instruction, fmt::format("expected more than {} operands", instruction.operands));
    return words_[instruction.first + i];
}

const Type& Module::type(Id id, const Instruction& user) const {
    if (names(id) != Names::type)
        fail(user, fmt::format("expected id {} to be a type, got {}", id, words_for(names(id))));
    return types_[names_[id].index];
}

const Constant& Module::constant(Id id, const Instruction& user) const {
    if (names(id) != Names::constant)
        fail(user, fmt::format("expected id {} to be a constant, got {}", id, words_for(names(id))));
    return constants_[names_[id].index];
}

const Function& Module::function(Id id, const Instruction& user) const {
    if (names(id) != Names::function)
        fail(user, fmt::format("expected id {} to be a function, got {}", id, words_for(names(id))));
    return functions_[names_[id].index];
}

const Decorations& Module::decorations(Id id) const {
    static const Decorations none{};
    const auto found = decorations_.find(id);
    return found != decorations_.end() ? found->second : none;
}

std::string Module::name(Id id) const {
    const auto found = texts_.find(id);
    return found != texts_.end() ? found->second : std::string();
}

bool Module::is_ignored_set(Id set) const {
    return std::find(ignored_sets_.begin(), ignored_sets_.end(), set) != ignored_sets_.end();
}

void ModuleReader::header() {
    constexpr std::uint32_t magic = 0x07230203, oldest = 0x10000, newest = 0x10600;
    const auto bad = [](std::uint32_t word, const std::string& problem) {
        throw sim::InputError(fmt::format("SPIR-V, word {}: {}", word, problem));
    };
    const std::vector<std::uint32_t>& words = module_.words_;
    if (words.size() < 5) bad(0, fmt::format("expected a header of five words, got {}", words.size()));
    if (words[0] != magic) bad(0, fmt::format("expected the magic number {:#x}, got {:#x}", magic, words[0]));
    if (words[1] != 0 && (words[1] < oldest || words[1] > newest || (words[1] & 0xFFU) != 0))
        bad(1, fmt::format("expected version 1.0 to 1.6, got {:#x}", words[1]));
    // Optimizers leave gaps between ids; a table of all of them is to be made.
    const std::size_t most = words.size() + (1U << 16);
    if (words[3] == 0 || words[3] > most) bad(3, fmt::format("expected 1 to {} ids, got {}", most, words[3]));
    module_.names_.resize(words[3]);
}

Instruction ModuleReader::next(std::uint32_t& at) {
    const std::vector<std::uint32_t>& words = module_.words_;
    const std::uint32_t opcode = words[at] & 0xFFFFU, length = words[at] >> 16U;
    Instruction instruction{static_cast<Op>(opcode), at, 0, 0, at + 1, 0};
    if (length == 0 || length > words.size() - at)
        fail(instruction, fmt::format("expected 1 to {} words, got {}", words.size() - at, length));
    const OpInfo* info = info_of(opcode);
    if (info == nullptr) fail(instruction, "not an instruction that is modelled");
    const std::uint32_t head = 1U + (info->type ? 1U : 0U) + (info->result ? 1U : 0U);
    if (length < head + info->operands)
        fail(instruction, fmt::format("expected {} words or more, got {}", head + info->operands, length));
    const auto id = [&] {
        const Id read = words[instruction.first++];
        if (read == 0 || read >= module_.bound())
            fail(instruction, fmt::format("expected an id from 1 to {}, got {}", module_.bound() - 1, read));
        return read;
    };
    if (info->type) instruction.type = id();
    if (info->result) instruction.id = id();
    instruction.operands = length - head;
    at += length;
    return instruction;
}

void ModuleReader::read() {
    header();
    const std::size_t end = module_.words_.size();
    for (std::uint32_t at = 5; at < end;) {
        const Instruction instruction = next(at);
        switch (instruction.op) {
        case Op::nop:
        case Op::line:
        case Op::no_line:
            continue;
        default:
            break;
        }
        if (function_ != nullptr)
            in_function(instruction);
        else
            global(instruction);
    }
    if (function_ != nullptr) throw sim::InputError(fmt::format("SPIR-V, word {}: expected OpFunctionEnd", end));
    if (module_.entry_points_.empty())
        throw sim::InputError(fmt::format("SPIR-V, word {}: expected an entry point before the end", end));
    for (const EntryPoint& entry : module_.entry_points_)
        if (module_.names(entry.function) != Names::function)
            throw sim::InputError(fmt::format("SPIR-V: expected entry point '{}' to be a function", entry.name));
}

Id ModuleReader::id_operand(const Instruction& instruction, std::uint32_t i) const {
    const Id id = operand(instruction, i);
    if (id == 0 || id >= module_.bound())
        fail(instruction, fmt::format("expected an id from 1 to {}, got {}", module_.bound() - 1, id));
    return id;
}

ModuleReader::Text ModuleReader::text(const Instruction& instruction, std::uint32_t first) const {
    Text read;
    for (std::uint32_t i = first; i < instruction.operands; ++i)
        for (std::uint32_t byte = 0; byte < 4; ++byte) {
            const char letter = static_cast<char>(operand(instruction, i) >> (8 * byte) & 0xFFU);
            if (letter == '\0') {
                read.next = i + 1;
                return read;
            }
            read.text += letter;
        }
    fail(instruction, "expected a text that ends with a zero");
}

void ModuleReader::define(const Instruction& instruction, Names what, std::size_t index) {
    Module::Named& named = module_.names_[instruction.id];
    if (named.what != Names::nothing) fail(instruction, fmt::format("id {} is defined twice", instruction.id));
    named = {what, static_cast<std::uint32_t>(index)};
}

void ModuleReader::global(const Instruction& instruction) {
    if (instruction.op == Op::function) return begin_function(instruction);
    if (has_body_) fail(instruction, "expected OpFunction");
    if (debug_or_annotation(instruction)) return;
    if (type_or_constant(instruction)) return;
    if (instruction.op == Op::variable) return variable(instruction);
    if (instruction.op == Op::undef) {
        // Any value is right: nought.
        const Type& type = module_.type(instruction.type, instruction);
        if (type.scalars == 0) fail(instruction, "expected the type of a value");
        constant(instruction);
        return;
    }
    fail(instruction, "not modelled outside of functions");
}

void ModuleReader::variable(const Instruction& instruction) {
    const Type& pointer = module_.type(instruction.type, instruction);
    if (pointer.kind != Kind::pointer) fail(instruction, "expected the type of a pointer");
    const auto storage = static_cast<Storage>(operand(instruction, 0));
    if (storage != pointer.storage) fail(instruction, "expected the storage class of its pointer");
    Variable made{instruction.id, pointer.element, instruction.type, storage, 0, instruction.word};
    if (instruction.operands > 1) {
        made.initial = operand(instruction, 1);
        if (module_.constant(made.initial, instruction).type != made.type)
            fail(instruction, "expected an initial value of the variable's type");
    }
    if (storage == Storage::function) fail(instruction, "expected it in a function");
    define(instruction, Names::variable, module_.variables_.size());
    module_.variables_.push_back(made);
}

void ModuleReader::begin_function(const Instruction& instruction) {
    const Type& type = module_.type(operand(instruction, 1), instruction);
    if (type.kind != Kind::function || type.element != instruction.type)
        fail(instruction, "expected the type of a function with this result");
    define(instruction, Names::function, module_.functions_.size());
    module_.functions_.push_back({instruction.id, operand(instruction, 1), {}, {}, instruction.word});
    function_ = &module_.functions_.back();
    in_block_ = false;
    has_body_ = true;
}

void ModuleReader::end_function(const Instruction& instruction) {
    if (in_block_) fail(instruction, "expected the block to end");
    if (function_->blocks.empty()) fail(instruction, "expected a function with a block");
    if (function_->parameters.size() != module_.type(function_->type).members.size())
        fail(instruction, "expected as many parameters as the function's type has");
    function_ = nullptr;
}

void ModuleReader::in_function(const Instruction& instruction) {
    switch (instruction.op) {
    case Op::function_end:
        return end_function(instruction);
    case Op::function_parameter: {
        const std::vector<Member>& expected = module_.type(function_->type).members;
        const std::size_t i = function_->parameters.size();
        if (!function_->blocks.empty() || i >= expected.size() || expected[i].type != instruction.type)
            fail(instruction, "expected the parameters of the function's type");
        define(instruction, Names::value, 0);
        function_->parameters.push_back(instruction.id);
        return;
    }
    case Op::label:
        if (in_block_) fail(instruction, "expected the block to end first");
        define(instruction, Names::label, 0);
        function_->blocks.push_back(
            {instruction.id, static_cast<std::uint32_t>(module_.instructions_.size()), 0, 0, false});
        in_block_ = true;
        return;
    case Op::selection_merge:
    case Op::loop_merge:
        if (!in_block_) fail(instruction, "expected it in a block");
        function_->blocks.back().merge = id_operand(instruction, 0);
        function_->blocks.back().loop = instruction.op == Op::loop_merge;
        return;
    default:
        return add_to_block(instruction);
    }
}

void ModuleReader::add_to_block(const Instruction& instruction) {
    if (!in_block_) fail(instruction, "expected OpLabel or OpFunctionEnd");
    if (instruction.type != 0) module_.type(instruction.type, instruction);
    if (instruction.id != 0) define(instruction, Names::value, module_.instructions_.size());
    module_.instructions_.push_back(instruction);
    switch (instruction.op) {
    case Op::branch:
    case Op::branch_conditional:
    case Op::switch_case:
    case Op::kill:
    case Op::terminate_invocation:
    case Op::return_nothing:
    case Op::return_value:
    case Op::unreachable:
        in_block_ = false;
        function_->blocks.back().last = static_cast<std::uint32_t>(module_.instructions_.size());
        return;
    default:
        return;
    }
}

} // namespace traces::spirv
