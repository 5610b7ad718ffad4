// Functions of GLSL.std.450.
#include "traces/spirv/resolver.hpp"

#include <fmt/format.h>

namespace traces::spirv {

void Resolver::extended(const Instruction& instruction) {
    const Id set = operand(instruction, 0);
    if (module_.is_ignored_set(set)) return;
    require(module_.is_std450(set), instruction, "expected the set GLSL.std.450");
    const std::uint32_t number = operand(instruction, 1);
    const auto function = static_cast<Std450>(number);
    if (component_wise(instruction, std450_operations(), number, 2) || geometric(instruction, function) ||
        splits(instruction, function) || packs(instruction, function) || interpolates(instruction, function))
        return;
    fail(instruction, fmt::format("expected a function of GLSL.std.450 for 32 bits, got {}", number));
}

bool Resolver::geometric(const Instruction& instruction, Std450 function) {
    const std::uint32_t count = [&] {
        const Type& of = type(registers(instruction, 2).type);
        return of.kind == Kind::vector ? of.count : of.scalars;
    }();
    const auto add = [&](Handler handler, std::uint32_t vectors, bool to_scalar, std::uint32_t scalars = 0) {
        check_kind(instruction, instruction.type, 'r', to_scalar ? 1 : count, "the result");
        std::array<Slot, 3> slots{};
        for (std::uint32_t i = 0; i < vectors + scalars; ++i)
            slots[i] = lanes(instruction, 2 + i, 'r', i < vectors ? count : 1);
        emit(instruction, {handler, define(instruction), to_scalar ? 1 : count, slots[0], slots[1],
                           static_cast<Slot>(count), slots[2]});
        return true;
    };
    switch (function) {
    case Std450::length:
        return add(length_of, 1, true);
    case Std450::distance:
        return add(distance_of, 2, true);
    case Std450::normalize:
        return add(normalize, 1, false);
    case Std450::face_forward:
        return add(face_forward, 3, false);
    case Std450::reflect:
        return add(reflect, 2, false);
    case Std450::refract:
        return add(refract, 2, false, 1);
    case Std450::cross:
        require(count == 3, instruction, "expected vectors of three components");
        return add(cross, 2, false);
    case Std450::determinant:
    case Std450::matrix_inverse: {
        const Value matrix = registers(instruction, 2);
        const Type& of = type(matrix.type);
        require(of.kind == Kind::matrix && of.scalars == of.count * of.count, instruction, "expected a square matrix");
        const bool inverts = function == Std450::matrix_inverse;
        if (inverts)
            require(instruction.type == matrix.type, instruction, "expected the type of the matrix");
        else
            check_kind(instruction, instruction.type, 'r', 1, "the result");
        emit(instruction, {inverts ? inverse : determinant, define(instruction), inverts ? of.scalars : 1, matrix.slot,
                           0, static_cast<Slot>(of.count)});
        return true;
    }
    default:
        return false;
    }
}

bool Resolver::splits(const Instruction& instruction, Std450 function) {
    const bool modf = function == Std450::modf || function == Std450::modf_struct;
    const Handler handler = modf ? modf_pair : frexp_pair;
    switch (function) {
    case Std450::modf_struct:
    case Std450::frexp_struct:
        pair(instruction, handler, modf ? "rrr" : "rir", 2);
        return true;
    case Std450::modf:
    case Std450::frexp: {
        const std::uint32_t count = components(instruction, instruction.type);
        check_kind(instruction, instruction.type, 'r', count, "the result");
        const Slot from = lanes(instruction, 2, 'r', count);
        Id second = 0;
        const Pointer to = pointer(instruction, 3, &second);
        check_kind(instruction, second, modf ? 'r' : 'i', count, "the second result");
        const Slot both = allocate(instruction, 2 * count);
        emit(instruction, {handler, both, 2 * count, from, 0, static_cast<Slot>(count)});
        store(instruction, to, both + static_cast<Slot>(count), count);
        define_as(instruction, {Is::registers, instruction.type, both, 0});
        return true;
    }
    default:
        return false;
    }
}

bool Resolver::packs(const Instruction& instruction, Std450 function) {
    const Handler handler = packing(function);
    if (handler == nullptr) return false;
    const std::uint32_t parts = packed_parts(function);
    const bool unpacks = function >= Std450::unpack_snorm_2x16;
    check_kind(instruction, instruction.type, unpacks ? 'r' : 'i', unpacks ? parts : 1, "the result");
    const Slot from = lanes(instruction, 2, unpacks ? 'i' : 'r', unpacks ? 1 : parts);
    emit(instruction, {handler, define(instruction), unpacks ? parts : 1, from});
    return true;
}

/// One sample a pixel: its centre is the centroid and the place of every sample.
bool Resolver::interpolates(const Instruction& instruction, Std450 function) {
    if (function != Std450::interpolate_at_centroid && function != Std450::interpolate_at_sample &&
        function != Std450::interpolate_at_offset)
        return false;
    Id of = 0;
    const Pointer from = pointer(instruction, 2, &of);
    const std::uint32_t count = components(instruction, instruction.type);
    check_kind(instruction, instruction.type, 'r', count, "the result");
    require(of == instruction.type && from.storage == Storage::input, instruction,
            "expected a pointer to an input of this type");
    const Value centre = load(instruction, from, of);
    if (function != Std450::interpolate_at_offset) {
        define_as(instruction, centre);
        return true;
    }
    const Slot offset = lanes(instruction, 3, 'r', 2);
    emit(instruction,
         {interpolate_at_offset, define(instruction), count, centre.slot, offset, static_cast<Slot>(count)});
    return true;
}

} // namespace traces::spirv
