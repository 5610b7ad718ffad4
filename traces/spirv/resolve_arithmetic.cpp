// Arithmetic, logic, comparisons, products of vectors and matrices.
#include "traces/spirv/resolver.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace traces::spirv {

bool Resolver::arithmetic(const Instruction& instruction) {
    const auto number = static_cast<std::uint32_t>(instruction.op);
    if (component_wise(instruction, real_operations(), number, 0) ||
        component_wise(instruction, whole_operations(), number, 0))
        return true;
    switch (instruction.op) {
    case Op::i_add_carry:
        pair(instruction, add_carry, "iii", 0);
        return true;
    case Op::i_sub_borrow:
        pair(instruction, subtract_borrow, "iii", 0);
        return true;
    case Op::u_mul_extended:
        pair(instruction, multiply_extended, "iii", 0);
        return true;
    case Op::s_mul_extended:
        pair(instruction, multiply_extended_signed, "iii", 0);
        return true;
    case Op::any:
    case Op::all: {
        const Value operand = registers(instruction, 0);
        const std::uint32_t count = components(instruction, operand.type);
        check_kind(instruction, operand.type, 'b', count, "the operand");
        check_kind(instruction, instruction.type, 'b', 1, "the result");
        emit(instruction, {instruction.op == Op::any ? any_of : all_of, define(instruction), 1, operand.slot,
                           static_cast<Slot>(count)});
        return true;
    }
    default:
        return bit_field(instruction) || linear(instruction);
    }
}

bool Resolver::component_wise(const Instruction& instruction, std::span<const ComponentWise> table,
                              std::uint32_t number, std::uint32_t first) {
    const auto found =
        std::find_if(table.begin(), table.end(), [&](const ComponentWise& row) { return row.number == number; });
    if (found == table.end()) return false;
    const std::uint32_t count = components(instruction, instruction.type);
    const std::string_view kinds = found->signature;
    check_kind(instruction, instruction.type, kinds[0], count, "the result");
    std::array<Slot, 4> slots{};
    for (std::uint32_t i = 1; i < kinds.size(); ++i) slots[i - 1] = lanes(instruction, first + i - 1, kinds[i], count);
    emit(instruction, {found->run[count - 1], define(instruction), count, slots[0], slots[1], slots[2], slots[3]});
    return true;
}

bool Resolver::bit_field(const Instruction& instruction) {
    const bool inserts = instruction.op == Op::bit_field_insert;
    if (!inserts && instruction.op != Op::bit_field_s_extract && instruction.op != Op::bit_field_u_extract)
        return false;
    const std::uint32_t count = components(instruction, instruction.type), next = inserts ? 2 : 1;
    check_kind(instruction, instruction.type, 'i', count, "the result");
    const Slot base = lanes(instruction, 0, 'i', count), inserted = inserts ? lanes(instruction, 1, 'i', count) : 0;
    const Slot offset = lanes(instruction, next, 'i', 1), bits = lanes(instruction, next + 1, 'i', 1);
    const auto size = static_cast<Slot>(count);
    const Slot to = define(instruction);
    if (!inserts) {
        const Handler handler =
            instruction.op == Op::bit_field_s_extract ? bit_field_extract_signed : bit_field_extract;
        emit(instruction, {handler, to, count, base, offset, size, bits});
        return true;
    }
    const auto list = static_cast<Slot>(program_.lists.size());
    program_.lists.insert(program_.lists.end(), {static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(bits)});
    emit(instruction, {bit_field_insert, to, count, base, inserted, size, list});
    return true;
}

bool Resolver::linear(const Instruction& instruction) {
    switch (instruction.op) {
    case Op::vector_times_scalar:
    case Op::matrix_times_scalar: {
        const Value scaled = registers(instruction, 0);
        const Type& of = type(scaled.type);
        require(scaled.type == instruction.type && (of.kind == Kind::matrix || scalar_kind(of) == Kind::real),
                instruction, "expected a vector or a matrix of floats, as the result is");
        const Slot factor = lanes(instruction, 1, 'r', 1);
        emit(instruction, {scale, define(instruction), of.scalars, scaled.slot, factor});
        return true;
    }
    case Op::dot: {
        const std::uint32_t count = components(instruction, registers(instruction, 0).type);
        const Slot a = lanes(instruction, 0, 'r', count), b = lanes(instruction, 1, 'r', count);
        check_kind(instruction, instruction.type, 'r', 1, "the result");
        emit(instruction, {dot_of(count), define(instruction), 1, a, b});
        return true;
    }
    case Op::transpose: {
        const Value matrix = registers(instruction, 0);
        const Type &of = type(matrix.type), &result = type(instruction.type);
        require(of.kind == Kind::matrix && result.kind == Kind::matrix && result.scalars == of.scalars &&
                    result.count == of.scalars / of.count,
                instruction, "expected a matrix and its transpose");
        emit(instruction, {transpose, define(instruction), of.scalars, matrix.slot, 0, static_cast<Slot>(of.count),
                           static_cast<Slot>(result.count)});
        return true;
    }
    case Op::vector_times_matrix:
    case Op::matrix_times_vector:
    case Op::matrix_times_matrix:
    case Op::outer_product:
        product(instruction);
        return true;
    default:
        return false;
    }
}

void Resolver::product(const Instruction& instruction) {
    const Value a = registers(instruction, 0), b = registers(instruction, 1);
    // A row vector on the left, a column vector on the right, seen as matrices.
    struct Shape {
        std::uint32_t columns = 0, rows = 0;
    };
    const bool outer = instruction.op == Op::outer_product;
    const auto shape = [&](Id id, bool as_row) {
        const Type& of = type(id);
        if (of.kind == Kind::matrix) return Shape{of.count, of.scalars / of.count};
        require(of.kind == Kind::vector && scalar_kind(of) == Kind::real, instruction,
                "expected vectors or matrices of floats");
        return as_row ? Shape{of.count, 1} : Shape{1, of.count};
    };
    const bool left_vector = instruction.op == Op::vector_times_matrix,
               right_vector = instruction.op == Op::matrix_times_vector;
    require((type(a.type).kind == Kind::vector) == (left_vector || outer) &&
                (type(b.type).kind == Kind::vector) == (right_vector || outer),
            instruction, "expected other operands");
    const Shape left = shape(a.type, left_vector), right = shape(b.type, outer);
    const Shape result = shape(instruction.type, left_vector);
    require(left.columns == right.rows && result.columns == right.columns && result.rows == left.rows, instruction,
            fmt::format("expected shapes that fit, got {}x{} times {}x{} for {}x{}", left.columns, left.rows,
                        right.columns, right.rows, result.columns, result.rows));
    const std::uint32_t count = result.columns * result.rows;
    const Slot to = define(instruction);
    const auto emit_product = [&](Handler handler, std::uint32_t c, std::uint32_t d) {
        emit(instruction, {handler, to, count, a.slot, b.slot, static_cast<Slot>(c), static_cast<Slot>(d)});
    };
    if (outer) return emit_product(outer_product, right.columns, left.rows);
    if (right_vector) return emit_product(spirv::matrix_times_vector(left.columns, left.rows), left.columns, left.rows);
    if (left_vector) return emit_product(vector_times_matrix, right.columns, right.rows);
    emit_product(matrix_times_matrix, left.columns, left.rows);
}

/// Results of two parts; `kinds`: of the first, of the second, of the operands.
void Resolver::pair(const Instruction& instruction, Handler handler, std::string_view kinds, std::uint32_t first) {
    const Type& result = type(instruction.type);
    require(result.kind == Kind::structure && result.count == 2, instruction, "expected a structure of two results");
    const Id low = result.members[0].type, high = result.members[1].type;
    const std::uint32_t count = components(instruction, low);
    check_kind(instruction, low, kinds[0], count, "the first result");
    check_kind(instruction, high, kinds[1], count, "the second result");
    const bool binary = first == 0; // functions of the extended set that do this have one operand
    const Slot a = lanes(instruction, first, kinds[2], count);
    const Slot b = binary ? lanes(instruction, 1, kinds[2], count) : 0;
    emit(instruction, {handler, define(instruction), 2 * count, a, b, static_cast<Slot>(count)});
}

} // namespace traces::spirv
