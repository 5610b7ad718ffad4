// Parts of composites: most of it is renaming of registers and takes no time in a run.
#include "traces/spirv/resolver.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace traces::spirv {

bool Resolver::composite(const Instruction& instruction) {
    switch (instruction.op) {
    case Op::vector_shuffle:
        shuffle(instruction);
        return true;
    case Op::composite_construct:
        construct(instruction);
        return true;
    case Op::composite_extract:
        extract(instruction);
        return true;
    case Op::composite_insert:
        insert(instruction);
        return true;
    case Op::vector_extract_dynamic:
    case Op::vector_insert_dynamic:
        vector_component(instruction);
        return true;
    case Op::select:
        select(instruction);
        return true;
    case Op::copy_object: {
        const Value copied = value(instruction, 0);
        require(copied.type == instruction.type, instruction, "expected the type of the operand");
        define_as(instruction, copied);
        return true;
    }
    case Op::copy_logical:
    case Op::u_convert:
    case Op::s_convert:
    case Op::f_convert:
    case Op::bitcast: {
        // All scalars have 32 bits.
        Value copied = registers(instruction, 0);
        require(type(copied.type).scalars == type(instruction.type).scalars, instruction,
                "expected as many scalars as the operand has");
        if (instruction.op != Op::copy_logical)
            require(scalar_kind(type(copied.type)) != Kind::truth && scalar_kind(type(instruction.type)) != Kind::truth,
                    instruction, "expected numbers");
        copied.type = instruction.type;
        define_as(instruction, copied);
        return true;
    }
    default:
        return false;
    }
}

/// Makes `to` what the slots hold.
void Resolver::gather(std::span<const Slot> from, Slot to) {
    const Instruction user{Op::composite_construct, 0, 0, 0, 0, 0};
    for (std::size_t i = 0; i < from.size();) {
        std::size_t run = 1;
        while (i + run < from.size() && from[i + run] == from[i] + static_cast<Slot>(run)) ++run;
        const Slot target = to + static_cast<Slot>(i);
        if (run >= 4) {
            const auto count = static_cast<std::uint32_t>(run);
            emit(user, {copy_of(count), target, count, from[i]});
            i += run;
            continue;
        }
        const std::size_t count = std::min<std::size_t>(4, from.size() - i);
        const auto source = [&](std::size_t k) { return from[std::min(i + k, from.size() - 1)]; };
        emit(user, {gather_of(static_cast<std::uint32_t>(count)), target, static_cast<std::uint32_t>(count), source(0),
                    source(1), source(2), source(3)});
        i += count;
    }
}

namespace {

bool consecutive(std::span<const Slot> slots) {
    for (std::size_t i = 1; i < slots.size(); ++i)
        if (slots[i] != slots[0] + static_cast<Slot>(i)) return false;
    return true;
}

} // namespace

void Resolver::shuffle(const Instruction& instruction) {
    const Value a = registers(instruction, 0), b = registers(instruction, 1);
    const Type &left = type(a.type), &right = type(b.type), &result = type(instruction.type);
    require(left.kind == Kind::vector && right.kind == Kind::vector && result.kind == Kind::vector, instruction,
            "expected vectors");
    require(left.element == right.element && left.element == result.element, instruction,
            "expected vectors of the same components");
    require(instruction.operands == 2 + result.count, instruction,
            fmt::format("expected {} components, got {}", result.count, instruction.operands - 2));
    constexpr std::uint32_t undefined = 0xFFFFFFFF;
    std::vector<Slot> from;
    for (std::uint32_t i = 0; i < result.count; ++i) {
        std::uint32_t component = operand(instruction, 2 + i);
        if (component == undefined) component = 0;
        require(component < left.count + right.count, instruction,
                fmt::format("expected components below {}, got {}", left.count + right.count, component));
        from.push_back(component < left.count ? a.slot + static_cast<Slot>(component)
                                              : b.slot + static_cast<Slot>(component - left.count));
    }
    if (consecutive(from)) return define_as(instruction, {Is::registers, instruction.type, from[0], 0});
    gather(from, define(instruction));
}

void Resolver::construct(const Instruction& instruction) {
    const Type& result = type(instruction.type);
    const bool vector = result.kind == Kind::vector;
    require(vector || result.kind == Kind::matrix || result.kind == Kind::array || result.kind == Kind::structure,
            instruction, "expected the type of a composite");
    require(vector || instruction.operands == result.count, instruction,
            fmt::format("expected {} parts, got {}", result.count, instruction.operands));
    std::vector<Slot> from;
    for (std::uint32_t i = 0; i < instruction.operands; ++i) {
        const Value part = registers(instruction, i);
        const Type& of = type(part.type);
        const Id expected = result.kind == Kind::structure ? result.members[i].type : result.element;
        require(part.type == expected || (vector && of.kind == Kind::vector && of.element == expected), instruction,
                fmt::format("expected part {} to be of the declared type", i));
        require(from.size() + of.scalars <= result.scalars, instruction, "expected fewer parts");
        for (std::uint32_t k = 0; k < of.scalars; ++k) from.push_back(part.slot + static_cast<Slot>(k));
    }
    require(from.size() == result.scalars && !from.empty(), instruction, "expected more parts");
    spend(instruction, from.size());
    if (consecutive(from)) return define_as(instruction, {Is::registers, instruction.type, from[0], 0});
    gather(from, define(instruction));
}

std::pair<Id, std::uint32_t> Resolver::part(const Instruction& instruction, Id id, std::uint32_t first) const {
    std::uint32_t offset = 0;
    for (std::uint32_t i = first; i < instruction.operands; ++i) {
        const Type& of = type(id);
        const std::uint32_t index = operand(instruction, i);
        const bool composite =
            of.kind == Kind::structure || of.kind == Kind::array || of.kind == Kind::matrix || of.kind == Kind::vector;
        require(composite, instruction, fmt::format("expected {} indices or fewer", i - first));
        require(index < of.count, instruction, fmt::format("expected an index below {}, got {}", of.count, index));
        if (of.kind == Kind::structure) {
            offset += of.members[index].first;
            id = of.members[index].type;
        } else {
            offset += index * type(of.element).scalars;
            id = of.element;
        }
    }
    return {id, offset};
}

void Resolver::extract(const Instruction& instruction) {
    const Value whole = registers(instruction, 0);
    const auto [of, offset] = part(instruction, whole.type, 1);
    require(of == instruction.type, instruction, "expected the type of the part");
    define_as(instruction, {Is::registers, of, whole.slot + static_cast<Slot>(offset), 0});
}

void Resolver::insert(const Instruction& instruction) {
    const Value inserted = registers(instruction, 0), whole = registers(instruction, 1);
    require(whole.type == instruction.type, instruction, "expected the type of the composite");
    const auto [of, offset] = part(instruction, whole.type, 2);
    require(of == inserted.type, instruction, "expected an object of the type of the part");
    const std::uint32_t count = type(whole.type).scalars, part_count = type(of).scalars;
    spend(instruction, count);
    std::vector<Slot> from;
    for (std::uint32_t i = 0; i < count; ++i)
        from.push_back(i >= offset && i < offset + part_count ? inserted.slot + static_cast<Slot>(i - offset)
                                                              : whole.slot + static_cast<Slot>(i));
    gather(from, define(instruction));
}

void Resolver::select(const Instruction& instruction) {
    const Value condition = registers(instruction, 0), yes = registers(instruction, 1), no = registers(instruction, 2);
    require(yes.type == instruction.type && no.type == instruction.type, instruction,
            "expected objects of the result's type");
    const std::uint32_t count = type(instruction.type).scalars;
    if (type(condition.type).kind == Kind::vector) {
        component_wise(instruction, whole_operations(), static_cast<std::uint32_t>(Op::select), 0);
        return;
    }
    check_kind(instruction, condition.type, 'b', 1, "the condition");
    emit(instruction, {choose_many, define(instruction), count, condition.slot, yes.slot, no.slot});
}

void Resolver::vector_component(const Instruction& instruction) {
    const Value vector = registers(instruction, 0);
    const Type& of = type(vector.type);
    require(of.kind == Kind::vector, instruction, "expected a vector");
    const auto size = static_cast<Slot>(of.count);
    if (instruction.op == Op::vector_extract_dynamic) {
        require(of.element == instruction.type, instruction, "expected the type of a component");
        const Slot index = lanes(instruction, 1, 'i', 1);
        return emit(instruction, {extract_component, define(instruction), 1, vector.slot, index, size});
    }
    const Value component = registers(instruction, 1);
    require(vector.type == instruction.type && component.type == of.element, instruction,
            "expected a vector and its component");
    const Slot index = lanes(instruction, 2, 'i', 1);
    emit(instruction, {insert_component, define(instruction), of.count, vector.slot, index, size, component.slot});
}

} // namespace traces::spirv
