// The C++ type of a described number, where the code for each is the same. For the sources behind described.hpp.
#pragma once

#include "sim/struct_table.hpp"

#include <cstring>

namespace sim::detail {

/// Calls visit(T{}) with the type of an integer, a real, or the unsigned integer that holds a choice.
template <class Visit>
auto with_number_type(const ValueType& type, Visit&& visit) {
    if (type.kind == Kind::real) return type.bytes == sizeof(float) ? visit(float{}) : visit(double{});
    switch (type.bytes) {
    case 1:
        return type.is_signed ? visit(std::int8_t{}) : visit(std::uint8_t{});
    case 2:
        return type.is_signed ? visit(std::int16_t{}) : visit(std::uint16_t{});
    case 4:
        return type.is_signed ? visit(std::int32_t{}) : visit(std::uint32_t{});
    default:
        return type.is_signed ? visit(std::int64_t{}) : visit(std::uint64_t{});
    }
}

// By copy: what lies there may be another type of the same size, such as an enumeration or long long.
template <class T>
T load(const void* place) {
    T value;
    std::memcpy(&value, place, sizeof(T));
    return value;
}

template <class T>
void store(void* place, T value) {
    std::memcpy(place, &value, sizeof(T));
}

inline std::size_t choice_at(const ValueType& type, const void* place) {
    return with_number_type(type,
                            [place](auto number) { return static_cast<std::size_t>(load<decltype(number)>(place)); });
}

inline std::string_view choice_name(const ValueType& type, const void* place) {
    const std::size_t index = choice_at(type, place);
    return index < type.choices.size() ? type.choices[index] : "?";
}

} // namespace sim::detail
