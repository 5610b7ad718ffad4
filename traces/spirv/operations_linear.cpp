// Vectors and matrices. Sums run from the first component to the last.
#include "traces/spirv/component_wise.hpp"

#include <algorithm>

namespace traces::spirv {

namespace {

Reals at(const Run& run, Slot slot) { return reals(run.file[slot]); }
void set(Run& run, Slot slot, Reals value) { run.file[slot] = words(value); }

Reals dot_product(const Run& run, Slot a, Slot b, Slot count, Slot step_a = 1, Slot step_b = 1) {
    Reals sum = at(run, a) * at(run, b);
    for (Slot i = 1; i < count; ++i) sum += at(run, a + i * step_a) * at(run, b + i * step_b);
    return sum;
}

template <Slot count>
void dot(Run& run, const Operation& operation) {
    set(run, operation.result, dot_product(run, operation.a, operation.b, count));
}

template <Slot columns, Slot rows>
void transform(Run& run, const Operation& operation) {
    for (Slot row = 0; row < rows; ++row)
        set(run, operation.result + row, dot_product(run, operation.a + row, operation.b, columns, rows));
}

using Square = std::array<std::array<Reals, 4>, 4>; ///< column, row

Square square(const Run& run, Slot first, Slot size) {
    Square matrix{};
    for (Slot column = 0; column < size; ++column)
        for (Slot row = 0; row < size; ++row)
            matrix[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)] =
                at(run, first + column * size + row);
    return matrix;
}

/// Without this column and row.
Square minor_of(const Square& matrix, std::size_t size, std::size_t column, std::size_t row) {
    Square rest{};
    for (std::size_t c = 0; c + 1 < size; ++c)
        for (std::size_t r = 0; r + 1 < size; ++r) rest[c][r] = matrix[c < column ? c : c + 1][r < row ? r : r + 1];
    return rest;
}

/// By the first column.
Reals determinant_of(const Square& matrix, std::size_t size) {
    if (size == 1) return matrix[0][0];
    if (size == 2) return matrix[0][0] * matrix[1][1] - matrix[1][0] * matrix[0][1];
    Reals sum{};
    for (std::size_t row = 0; row < size; ++row) {
        const Reals term = matrix[0][row] * determinant_of(minor_of(matrix, size, 0, row), size - 1);
        sum = row % 2 == 0 ? sum + term : sum - term;
    }
    return sum;
}

} // namespace

Handler dot_of(std::uint32_t components) {
    constexpr std::array<Handler, 4> handlers{dot<1>, dot<2>, dot<3>, dot<4>};
    return handlers.at(components - 1);
}

Handler matrix_times_vector(std::uint32_t columns, std::uint32_t rows) {
    constexpr std::array<Handler, 9> handlers{transform<2, 2>, transform<2, 3>, transform<2, 4>,
                                              transform<3, 2>, transform<3, 3>, transform<3, 4>,
                                              transform<4, 2>, transform<4, 3>, transform<4, 4>};
    return handlers.at((columns - 2) * 3 + rows - 2);
}

void scale(Run& run, const Operation& operation) {
    const Reals factor = at(run, operation.b);
    for (Slot i = 0; i < static_cast<Slot>(operation.count); ++i)
        set(run, operation.result + i, at(run, operation.a + i) * factor);
}

void vector_times_matrix(Run& run, const Operation& operation) {
    for (Slot column = 0; column < operation.c; ++column)
        set(run, operation.result + column,
            dot_product(run, operation.a, operation.b + column * operation.d, operation.d));
}

void matrix_times_matrix(Run& run, const Operation& operation) {
    const Slot middle = operation.c, rows = operation.d, columns = static_cast<Slot>(operation.count) / rows;
    for (Slot column = 0; column < columns; ++column)
        for (Slot row = 0; row < rows; ++row)
            set(run, operation.result + column * rows + row,
                dot_product(run, operation.a + row, operation.b + column * middle, middle, rows));
}

void transpose(Run& run, const Operation& operation) {
    for (Slot column = 0; column < operation.c; ++column)
        for (Slot row = 0; row < operation.d; ++row)
            run.file[operation.result + row * operation.c + column] =
                run.file[operation.a + column * operation.d + row];
}

void outer_product(Run& run, const Operation& operation) {
    for (Slot column = 0; column < operation.c; ++column)
        for (Slot row = 0; row < operation.d; ++row)
            set(run, operation.result + column * operation.d + row,
                at(run, operation.a + row) * at(run, operation.b + column));
}

void determinant(Run& run, const Operation& operation) {
    set(run, operation.result,
        determinant_of(square(run, operation.a, operation.c), static_cast<std::size_t>(operation.c)));
}

void inverse(Run& run, const Operation& operation) {
    const auto size = static_cast<std::size_t>(operation.c);
    const Square matrix = square(run, operation.a, operation.c);
    const Reals whole = determinant_of(matrix, size);
    for (std::size_t column = 0; column < size; ++column)
        for (std::size_t row = 0; row < size; ++row) {
            const Reals part = determinant_of(minor_of(matrix, size, row, column), size - 1);
            set(run, operation.result + static_cast<Slot>(column * size + row),
                ((column + row) % 2 == 0 ? part : -part) / whole);
        }
}

void length_of(Run& run, const Operation& operation) {
    set(run, operation.result, roots(dot_product(run, operation.a, operation.a, operation.c)));
}

void distance_of(Run& run, const Operation& operation) {
    Reals sum{};
    for (Slot i = 0; i < operation.c; ++i) {
        const Reals difference = at(run, operation.a + i) - at(run, operation.b + i);
        sum += difference * difference;
    }
    set(run, operation.result, roots(sum));
}

void normalize(Run& run, const Operation& operation) {
    const Reals factor = same(1.0F) / roots(dot_product(run, operation.a, operation.a, operation.c));
    for (Slot i = 0; i < operation.c; ++i) set(run, operation.result + i, at(run, operation.a + i) * factor);
}

void cross(Run& run, const Operation& operation) {
    for (Slot i = 0; i < 3; ++i) {
        const Slot j = (i + 1) % 3, k = (i + 2) % 3;
        set(run, operation.result + i,
            at(run, operation.a + j) * at(run, operation.b + k) - at(run, operation.a + k) * at(run, operation.b + j));
    }
}

void face_forward(Run& run, const Operation& operation) {
    const Words towards = words(dot_product(run, operation.b, operation.d, operation.c) < same(0.0F));
    for (Slot i = 0; i < operation.c; ++i) {
        const Reals normal = at(run, operation.a + i);
        set(run, operation.result + i, pick(towards, normal, -normal));
    }
}

void reflect(Run& run, const Operation& operation) {
    const Reals twice = same(2.0F) * dot_product(run, operation.b, operation.a, operation.c);
    for (Slot i = 0; i < operation.c; ++i)
        set(run, operation.result + i, at(run, operation.a + i) - twice * at(run, operation.b + i));
}

void refract(Run& run, const Operation& operation) {
    const Reals ratio = at(run, operation.d), cosine = dot_product(run, operation.b, operation.a, operation.c);
    const Reals k = same(1.0F) - ratio * ratio * (same(1.0F) - cosine * cosine);
    const Words total_reflection = words(k < same(0.0F));
    const Reals along = ratio * cosine + roots(greatest(k, same(0.0F)));
    for (Slot i = 0; i < operation.c; ++i)
        set(run, operation.result + i,
            pick(total_reflection, same(0.0F), ratio * at(run, operation.a + i) - along * at(run, operation.b + i)));
}

void interpolate_at_offset(Run& run, const Operation& operation) {
    const Reals x = at(run, operation.b), y = at(run, operation.b + 1);
    for (Slot i = 0; i < operation.c; ++i) {
        const Reals v = at(run, operation.a + i);
        const Reals dx{v[1] - v[0], v[1] - v[0], v[3] - v[2], v[3] - v[2]};
        const Reals dy{v[2] - v[0], v[3] - v[1], v[2] - v[0], v[3] - v[1]};
        set(run, operation.result + i, v + dx * x + dy * y);
    }
}

} // namespace traces::spirv
