// Variables, the ways into them, loads and stores.
#include "traces/spirv/resolver.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace traces::spirv {

bool Resolver::memory(const Instruction& instruction) {
    switch (instruction.op) {
    case Op::variable:
        local_variable(instruction);
        return true;
    case Op::access_chain:
    case Op::in_bounds_access_chain:
        access_chain(instruction);
        return true;
    case Op::load: {
        Id type = 0;
        const Pointer from = pointer(instruction, 0, &type);
        require(type == instruction.type, instruction, "expected the type that the pointer points to");
        define_as(instruction, load(instruction, from, type));
        return true;
    }
    case Op::store: {
        Id type = 0;
        const Pointer to = pointer(instruction, 0, &type);
        const Value stored = registers(instruction, 1);
        require(type == stored.type, instruction, "expected a value of the type that the pointer points to");
        store(instruction, to, stored.slot, this->type(type).scalars);
        return true;
    }
    case Op::copy_memory: {
        Id to_type = 0, from_type = 0;
        const Pointer to = pointer(instruction, 0, &to_type), from = pointer(instruction, 1, &from_type);
        require(to_type == from_type && type(to_type).scalars > 0, instruction,
                "expected pointers to values of one type");
        store(instruction, to, load(instruction, from, from_type).slot, type(to_type).scalars);
        return true;
    }
    default:
        return false;
    }
}

const Resolver::Pointer& Resolver::pointer(const Instruction& instruction, std::uint32_t i, Id* pointee) const {
    const Id id = operand(instruction, i);
    if (id >= values_.size() || values_[id].is != Is::pointer)
        fail(instruction, fmt::format("expected id {} to be a pointer", id));
    if (pointee != nullptr) *pointee = type(values_[id].type).element;
    return pointers_[values_[id].index];
}

void Resolver::local_variable(const Instruction& instruction) {
    const Type& pointer = type(instruction.type);
    require(pointer.kind == Kind::pointer && pointer.storage == Storage::function &&
                operand(instruction, 0) == static_cast<std::uint32_t>(Storage::function),
            instruction, "expected a pointer to a variable of the function");
    const std::uint32_t count = type(pointer.element).scalars;
    require(count > 0, instruction, "expected a variable that holds a value");
    const Slot slot = allocate(instruction, count);
    pointers_.push_back({Storage::function, false, false, slot});
    define_as(instruction, {Is::pointer, instruction.type, 0, static_cast<std::uint32_t>(pointers_.size() - 1)});
    if (instruction.operands < 2) return;
    require(constant(operand(instruction, 1), instruction).type == pointer.element, instruction,
            "expected an initial value of the variable's type");
    initialise(instruction, slot, operand(instruction, 1));
}

void Resolver::advance(Pointer& pointer, const Instruction& instruction, std::uint32_t i, std::uint32_t count,
                       std::uint32_t stride) {
    const Id id = operand(instruction, i);
    if (module_.names(id) != Names::constant) {
        pointer.indices.push_back({lanes(instruction, i, 'i', 1), stride, count});
        return;
    }
    const Constant& index = module_.constant(id, instruction);
    check_kind(instruction, index.type, 'i', 1, "an index");
    const std::int64_t clamped =
        std::clamp<std::int64_t>(static_cast<std::int32_t>(index.scalars[0]), 0, static_cast<std::int64_t>(count) - 1);
    pointer.base += clamped * stride;
}

void Resolver::step(const Instruction& instruction, Pointer& pointer, Id& id, std::uint32_t i) {
    const Type& of = type(id);
    switch (of.kind) {
    case Kind::structure: {
        const Constant& index = module_.constant(operand(instruction, i), instruction);
        require(index.scalars.size() == 1 && index.scalars[0] < of.count, instruction,
                fmt::format("expected one of {} members", of.count));
        Layout layout = pointer.layout; // without decorations, members lie as they do in registers
        pointer.base += member_offset(of, index.scalars[0], layout);
        pointer.layout = layout;
        id = of.members[index.scalars[0]].type;
        return;
    }
    case Kind::array:
        advance(pointer, instruction, i, of.count, pointer.texture ? 1 : element_stride(module_, of, pointer.layout));
        break;
    case Kind::matrix:
        advance(pointer, instruction, i, of.count, column_stride(of, pointer.layout));
        pointer.stride = component_stride(pointer.layout);
        break;
    case Kind::vector:
        advance(pointer, instruction, i, of.count, pointer.stride);
        break;
    default:
        fail(instruction, fmt::format("expected {} indices or fewer", i - 1));
    }
    id = of.element;
}

void Resolver::access_chain(const Instruction& instruction) {
    Id at = 0;
    Pointer made = pointer(instruction, 0, &at);
    for (std::uint32_t i = 1; i < instruction.operands; ++i) step(instruction, made, at, i);
    const Type& result = type(instruction.type);
    require(result.kind == Kind::pointer && result.element == at && result.storage == made.storage, instruction,
            "expected a pointer to what the indices lead to");
    pointers_.push_back(std::move(made));
    define_as(instruction, {Is::pointer, instruction.type, 0, static_cast<std::uint32_t>(pointers_.size() - 1)});
}

std::uint32_t Resolver::list_of(const Pointer& pointer) {
    const auto first = static_cast<std::uint32_t>(program_.lists.size());
    program_.lists.push_back(static_cast<std::uint32_t>(pointer.indices.size()));
    program_.lists.push_back(static_cast<std::uint32_t>(pointer.base));
    for (const Index& index : pointer.indices)
        program_.lists.insert(program_.lists.end(),
                              {static_cast<std::uint32_t>(index.slot), index.stride, index.bound});
    return first;
}

Resolver::Value Resolver::load(const Instruction& instruction, const Pointer& from, Id id) {
    if (from.texture) {
        require(type(id).opaque() && from.indices.size() <= 1, instruction, "expected a texture, got an array of them");
        TextureReference reference{id,
                                   *from.texture,
                                   *from.texture,
                                   static_cast<std::uint32_t>(from.base),
                                   static_cast<std::uint32_t>(from.base),
                                   {}};
        if (!from.indices.empty()) reference.varying = from.indices[0].slot;
        references_.push_back(reference);
        return {Is::texture, id, 0, static_cast<std::uint32_t>(references_.size() - 1)};
    }
    if (from.uniform) return load_uniform(instruction, from, id);
    const std::uint32_t count = type(id).scalars;
    if (from.constant && from.indices.empty()) return {Is::registers, id, static_cast<Slot>(from.base), 0};
    const Slot slot = allocate(instruction, count);
    if (from.indices.empty())
        emit(instruction, {copy_of(count), slot, count, static_cast<Slot>(from.base)});
    else
        emit(instruction, {load_indexed, slot, count, static_cast<Slot>(list_of(from))});
    return {Is::registers, id, slot, 0};
}

Resolver::Value Resolver::load_uniform(const Instruction& instruction, const Pointer& from, Id id) {
    const Type& of = type(id);
    std::vector<PlacedScalar> places;
    const auto base = from.indices.empty() ? static_cast<std::uint32_t>(from.base) : 0U;
    if (of.kind == Kind::vector)
        for (std::uint32_t i = 0; i < of.count; ++i)
            places.push_back({base + i * from.stride, type(of.element).kind == Kind::truth});
    else
        place_scalars(module_, of, from.layout, base, places);
    const auto count = static_cast<std::uint32_t>(places.size());
    if (!from.indices.empty()) {
        const std::uint32_t list = list_of(from);
        for (const PlacedScalar& place : places) program_.lists.push_back(place.word);
        const Slot slot = allocate(instruction, count);
        emit(instruction, {load_uniform_indexed, slot, count, static_cast<Slot>(list)});
        for (std::uint32_t i = 0; i < count; ++i)
            if (places[i].truth)
                emit(instruction, {to_truth, slot + static_cast<Slot>(i), 1, slot + static_cast<Slot>(i)});
        return {Is::registers, id, slot, 0};
    }
    std::vector<std::uint32_t> key;
    for (const PlacedScalar& place : places) key.push_back(place.word);
    const auto [found, is_new] = uniform_registers_.try_emplace({id, std::move(key)}, 0);
    if (is_new) {
        found->second = allocate_fixed(instruction, count);
        for (std::uint32_t i = 0; i < count; ++i)
            program_.uniform_registers.push_back(
                {found->second + static_cast<Slot>(i), places[i].word, places[i].truth});
    }
    return {Is::registers, id, found->second, 0};
}

void Resolver::store(const Instruction& instruction, const Pointer& to, Slot from, std::uint32_t count) {
    require(!to.constant && !to.texture, instruction, "expected a variable that may be written");
    if (to.indices.empty()) return emit(instruction, {copy_of(count), static_cast<Slot>(to.base), count, from});
    emit(instruction, {store_indexed, 0, 0, static_cast<Slot>(list_of(to)), from, static_cast<Slot>(count)});
    block_.effort += count;
}

} // namespace traces::spirv
