// Names, decorations, entry points: what a module says about its ids.
#include "sim/check.hpp"
#include "traces/spirv/module_reader.hpp"

#include <fmt/format.h>

namespace traces::spirv {

namespace {

/// SPIR-V specification 1.6, section 3.20.
enum class Decoration : std::uint32_t {
    block = 2,
    buffer_block = 3,
    row_major = 4,
    column_major = 5,
    array_stride = 6,
    matrix_stride = 7,
    built_in = 11,
    no_perspective = 13,
    flat = 14,
    centroid = 16,
    location = 30,
    component = 31,
    binding = 33,
    descriptor_set = 34,
    offset = 35,
};

} // namespace

void ModuleReader::decorate(const Instruction& instruction, std::uint32_t first, Decorations& decorations) {
    const auto value = [&] { return operand(instruction, first + 1); };
    switch (static_cast<Decoration>(operand(instruction, first))) {
    case Decoration::block:
        decorations.block = true;
        return;
    case Decoration::buffer_block:
        decorations.buffer = true;
        return;
    case Decoration::row_major:
        decorations.row_major = true;
        return;
    case Decoration::column_major:
        decorations.row_major = false;
        return;
    case Decoration::array_stride:
        decorations.array_stride = value();
        return;
    case Decoration::matrix_stride:
        decorations.matrix_stride = value();
        return;
    case Decoration::built_in:
        decorations.built_in = value();
        return;
    case Decoration::no_perspective:
        decorations.no_perspective = true;
        return;
    case Decoration::flat:
        decorations.flat = true;
        return;
    case Decoration::centroid:
        decorations.centroid = true;
        return;
    case Decoration::location:
        decorations.location = value();
        return;
    case Decoration::component:
        decorations.component = value();
        return;
    case Decoration::binding:
        decorations.binding = value();
        return;
    case Decoration::descriptor_set:
        decorations.set = value();
        return;
    case Decoration::offset:
        decorations.offset = value();
        return;
    default:
        return; // precision and other hints
    }
}

void ModuleReader::name(const Instruction& instruction) {
    const Id id = id_operand(instruction, 0);
    if (instruction.op == Op::name)
        module_.texts_[id] = text(instruction, 1).text;
    else
        member_names_[{id, operand(instruction, 1)}] = text(instruction, 2).text;
}

void ModuleReader::entry_point(const Instruction& instruction) {
    EntryPoint entry;
    entry.model = operand(instruction, 0);
    entry.function = id_operand(instruction, 1);
    Text name = text(instruction, 2);
    entry.name = std::move(name.text);
    for (std::uint32_t i = name.next; i < instruction.operands; ++i)
        entry.interface.push_back(id_operand(instruction, i));
    module_.entry_points_.push_back(std::move(entry));
}

void ModuleReader::execution_mode(const Instruction& instruction) {
    // Section 3.6.
    constexpr std::uint32_t upper_left = 7, early_tests = 9, depth_replacing = 12;
    for (EntryPoint& entry : module_.entry_points_) {
        if (entry.function != operand(instruction, 0)) continue;
        switch (operand(instruction, 1)) {
        case upper_left:
            entry.origin_upper_left = true;
            break;
        case early_tests:
            entry.early_tests = true;
            break;
        case depth_replacing:
            entry.sets_depth = true;
            break;
        default:
            break;
        }
    }
}

void ModuleReader::import(const Instruction& instruction) {
    const std::string set = text(instruction, 0).text;
    define(instruction, Names::instruction_set, 0);
    if (set == "GLSL.std.450")
        module_.std450_ = instruction.id;
    else if (set.starts_with("NonSemantic."))
        module_.ignored_sets_.push_back(instruction.id);
    else
        fail(instruction, fmt::format("expected the set GLSL.std.450, got '{}'", set));
}

bool ModuleReader::debug_or_annotation(const Instruction& instruction) {
    switch (instruction.op) {
    case Op::source:
    case Op::source_continued:
    case Op::source_extension:
    case Op::module_processed:
    case Op::extension:
    case Op::memory_model:
    case Op::capability:
    case Op::execution_mode_id:
    case Op::decorate_id:
    case Op::decorate_string:
    case Op::member_decorate_string:
        return true;
    case Op::string:
        define(instruction, Names::other, 0);
        return true;
    case Op::name:
    case Op::member_name:
        name(instruction);
        return true;
    case Op::ext_inst_import:
        import(instruction);
        return true;
    case Op::entry_point:
        entry_point(instruction);
        return true;
    case Op::execution_mode:
        execution_mode(instruction);
        return true;
    case Op::decorate:
        decorate(instruction, 1, module_.decorations_[id_operand(instruction, 0)]);
        return true;
    case Op::member_decorate:
        decorate(instruction, 2, member_decorations_[{id_operand(instruction, 0), operand(instruction, 1)}]);
        return true;
    default:
        return false;
    }
}

} // namespace traces::spirv
