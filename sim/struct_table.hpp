// What fields() says as data: one constant table per described struct. What derives from it takes a type and a pointer
// to a value, so that it is compiled once, instead of once for each struct in each file.
#pragma once

#include "sim/field.hpp"
#include "sim/stats.hpp"

#include <span>

namespace sim {

enum class Kind : std::uint8_t {
    boolean,
    integer,
    real,
    choice,
    text,
    list,
    table,
    counter,
    high_water,
    histogram,
};

struct StructTable;

/// How a value is stored at a `const void*`.
struct ValueType {
    Kind kind{};
    std::uint8_t bytes = 0; ///< of integer, real and choice
    bool is_signed = false;
    std::span<const std::string_view> choices{};
    const StructTable* table = nullptr;

    // Lists
    const ValueType* element = nullptr;
    std::size_t (*size)(const void* list) = nullptr;
    const void* (*at)(const void* list, std::size_t index) = nullptr;
    void (*resize)(void* list, std::size_t size) = nullptr; ///< null where the size is fixed
};

struct FieldRow {
    std::string_view name;
    std::string_view text;
    std::string_view unit;
    const ValueType* type = nullptr;
    const void* (*member)(const void* object) = nullptr;
    // Bounds of the innermost elements, stored as these are; null where there is none.
    const void* low = nullptr;
    const void* high = nullptr;
};

struct StructTable {
    std::span<const FieldRow> fields;
};

inline const void* member_at(const FieldRow& field, const void* object) { return field.member(object); }
inline void* member_at(const FieldRow& field, void* object) { return const_cast<void*>(field.member(object)); }
inline const void* element_at(const ValueType& type, const void* list, std::size_t i) { return type.at(list, i); }
inline void* element_at(const ValueType& type, void* list, std::size_t i) {
    return const_cast<void*>(type.at(list, i));
}

namespace detail {

template <class T>
consteval ValueType make_value_type();

template <Described S>
inline constexpr auto fields_of = S::fields();

template <class S, auto Member>
const void* member_of(const void* object) {
    return &(static_cast<const S*>(object)->*Member);
}

} // namespace detail

template <class T>
inline constexpr ValueType value_type = detail::make_value_type<T>();

namespace detail {

template <class S, auto Member>
constexpr FieldRow row_of(const Field<Member>& field) {
    return {.name = field.name,
            .text = field.text,
            .unit = field.unit_text,
            .type = &value_type<typename Field<Member>::Value>,
            .member = member_of<S, Member>,
            .low = field.has_low ? &field.low : nullptr,
            .high = field.has_high ? &field.high : nullptr};
}

template <Described S>
inline constexpr auto field_rows = std::apply(
    [](const auto&... field) { return std::array<FieldRow, sizeof...(field)>{row_of<S>(field)...}; }, fields_of<S>);

} // namespace detail

template <Described S>
inline constexpr StructTable struct_table{detail::field_rows<S>};

/// A described struct as one type for all of them.
struct DescribedRef {
    const StructTable* table;
    const void* object;

    template <Described S>
    explicit DescribedRef(const S& described) : table(&struct_table<S>), object(&described) {}
};

namespace detail {

template <Sequence T>
consteval ValueType list_type() {
    ValueType type{.kind = Kind::list, .element = &value_type<typename T::value_type>};
    type.size = [](const void* list) { return static_cast<const T*>(list)->size(); };
    type.at = [](const void* list, std::size_t i) -> const void* { return static_cast<const T*>(list)->data() + i; };
    if constexpr (!FixedArray<T>)
        type.resize = [](void* list, std::size_t size) { static_cast<T*>(list)->resize(size); };
    return type;
}

template <class T>
consteval ValueType make_value_type() {
    if constexpr (std::same_as<T, bool>)
        return {.kind = Kind::boolean};
    else if constexpr (Integer<T>)
        return {.kind = Kind::integer, .bytes = sizeof(T), .is_signed = std::is_signed_v<T>};
    else if constexpr (std::same_as<T, float> || std::same_as<T, double>)
        return {.kind = Kind::real, .bytes = sizeof(T)};
    else if constexpr (NamedEnum<T>)
        return {.kind = Kind::choice, .bytes = sizeof(T), .choices = EnumNames<T>::names};
    else if constexpr (std::same_as<T, std::string>)
        return {.kind = Kind::text};
    else if constexpr (Sequence<T>)
        return list_type<T>();
    else if constexpr (Described<T>)
        return {.kind = Kind::table, .table = &struct_table<T>};
    else if constexpr (std::same_as<T, Counter>)
        return {.kind = Kind::counter};
    else if constexpr (std::same_as<T, HighWater>)
        return {.kind = Kind::high_water};
    else {
        static_assert(std::same_as<T, Histogram>, "a field of a type that described structs do not know");
        return {.kind = Kind::histogram};
    }
}

} // namespace detail
} // namespace sim
