// Makes handlers of functions over four lanes; private to operations_*.cpp.
#pragma once

#include "traces/spirv/operations.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace traces::spirv {

template <class Lanes>
inline Lanes lanes_as(Words lanes) {
    return (Lanes)lanes;
}

/// A handler for each number of components: function(a, b, ...) of the operands' slots, component by component.
template <auto function>
struct ComponentHandlers;

template <class Result, class... Operands, Result (*function)(Operands...)>
struct ComponentHandlers<function> {
    template <Slot... components>
    static void each(Run& run, const Operation& operation, std::integer_sequence<Slot, components...>) {
        (one(run, operation, components, std::index_sequence_for<Operands...>{}), ...);
    }
    template <std::size_t... i>
    static void one(Run& run, const Operation& operation, Slot component, std::index_sequence<i...>) {
        const Slot from[] = {operation.a, operation.b, operation.c, operation.d};
        run.file[operation.result + component] = words(function(lanes_as<Operands>(run.file[from[i] + component])...));
    }
    template <Slot components>
    static void apply(Run& run, const Operation& operation) {
        each(run, operation, std::make_integer_sequence<Slot, components>{});
    }
};

template <auto function>
constexpr ComponentWise row(std::uint32_t number, std::string_view signature) {
    using Handlers = ComponentHandlers<function>;
    return {number,
            signature,
            {Handlers::template apply<1>, Handlers::template apply<2>, Handlers::template apply<3>,
             Handlers::template apply<4>}};
}
template <auto function>
constexpr ComponentWise row(Op op, std::string_view signature) {
    return row<function>(static_cast<std::uint32_t>(op), signature);
}
template <auto function>
constexpr ComponentWise row(Std450 number, std::string_view signature) {
    return row<function>(static_cast<std::uint32_t>(number), signature);
}

/// A function of the C library, lane by lane.
template <float (*function)(float)>
Reals by_lane(Reals x) {
    return Reals{function(x[0]), function(x[1]), function(x[2]), function(x[3])};
}
template <float (*function)(float, float)>
Reals by_lane(Reals x, Reals y) {
    return Reals{function(x[0], y[0]), function(x[1], y[1]), function(x[2], y[2]), function(x[3], y[3])};
}

inline constexpr std::uint32_t sign_bit = 0x80000000;

inline Reals magnitude(Reals x) { return reals(words(x) & same(~sign_bit)); }
/// Infinite ones, too; false for NaN.
inline Words is_number(Reals x) { return words((words(x) & same(~sign_bit)) <= same(0x7F800000U)); }

/// Towards zero. From 2^23 on, floats are whole. The sign stays, that of a zero, too.
inline Reals truncated(Reals x) {
    const Words small = words(magnitude(x) < same(0x1p23F));
    const Wholes whole = __builtin_convertvector(pick(small, x, same(0.0F)), Wholes);
    const Words value = words(__builtin_convertvector(whole, Reals)) | (words(x) & same(sign_bit));
    return pick(small, reals(value), x);
}
inline Reals floored(Reals x) {
    const Reals whole = truncated(x);
    return reals(words(pick(words(whole > x), whole - same(1.0F), whole)) | (words(x) & same(sign_bit)));
}

inline Reals least(Reals x, Reals y) { return pick(words(y < x), y, x); }
inline Reals greatest(Reals x, Reals y) { return pick(words(x < y), y, x); }

inline float root(float x) { return std::sqrt(x); }
inline Reals roots(Reals x) { return by_lane<root>(x); }

} // namespace traces::spirv
