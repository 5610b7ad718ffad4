// A struct says once what its members are: `static constexpr auto fields()` returns a tuple of
// sim::field<&S::member>(...).
//
// The name of a field is the name of the member, taken from the member pointer. Everything else that a parameter or a
// statistic needs (configuration, help, JSON, CSV, sums, differences) derives from this list: see described.hpp.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace sim {

/// Names of an enumeration whose values count from 0; specialise it beside the enumeration:
/// template <> struct sim::EnumNames<E> { static constexpr std::array<std::string_view, 2> names{"a", "b"}; };
template <class E>
struct EnumNames {};

template <class E>
concept NamedEnum = std::is_enum_v<E> && requires {
    EnumNames<E>::names.size();
};

/// The name of an enumerator, or "?" for a value that has none.
template <NamedEnum E>
constexpr std::string_view enum_name(E value) {
    const auto index = static_cast<std::size_t>(value);
    return index < EnumNames<E>::names.size() ? EnumNames<E>::names[index] : std::string_view("?");
}

template <class S>
concept Described = requires {
    std::tuple_size<decltype(S::fields())>::value;
};

template <class T>
concept Integer = std::integral<T> && !std::same_as<T, bool>;
template <class T>
concept Number = Integer<T> || std::floating_point<T>;

namespace detail {

// "... [with auto Member = &S::lines; ...]" or "... [Member = &S::lines]" -> "lines"
template <auto Member>
consteval std::string_view member_name() {
    std::string_view text = __PRETTY_FUNCTION__;
    text = text.substr(text.find("Member = "));
    text = text.substr(0, text.find_first_of(";]"));
    return text.substr(text.rfind("::") + 2);
}

template <class M>
struct MemberOf;
template <class S, class M>
struct MemberOf<M S::*> {
    using Struct = S;
    using Value = M;
};

template <class T>
struct IsArray : std::false_type {};
template <class T, std::size_t n>
struct IsArray<std::array<T, n>> : std::true_type {};
template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};

template <class T>
struct Innermost {
    using type = T;
};
template <class T>
requires(IsArray<T>::value || IsVector<T>::value) struct Innermost<T> : Innermost<typename T::value_type> {
};

struct AnyValue {
    template <class T>
    operator T() const;
};

template <class S, std::size_t... i>
constexpr bool takes_values(std::index_sequence<i...>) {
    return requires { S{(static_cast<void>(i), AnyValue{})...}; };
}

} // namespace detail

template <class T>
concept FixedArray = detail::IsArray<T>::value;
template <class T>
concept Sequence = FixedArray<T> || detail::IsVector<T>::value;

/// One member of a described struct. `range` and the like apply to every element of an array.
template <auto Member>
struct Field {
    using Struct = typename detail::MemberOf<decltype(Member)>::Struct;
    using Value = typename detail::MemberOf<decltype(Member)>::Value;
    using Inner = typename detail::Innermost<Value>::type;
    using Bound = std::conditional_t<Number<Inner>, Inner, std::uint64_t>;

    static constexpr std::string_view name = detail::member_name<Member>();

    std::string_view text; ///< what it is, one line
    std::string_view unit_text;
    bool has_low = false;
    bool has_high = false;
    Bound low{};
    Bound high{};

    constexpr Field unit(std::string_view what) const {
        Field field = *this;
        field.unit_text = what;
        return field;
    }
    constexpr Field at_least(Bound bound) const requires Number<Inner> {
        Field field = *this;
        field.low = bound;
        field.has_low = true;
        return field;
    }
    constexpr Field at_most(Bound bound) const requires Number<Inner> {
        Field field = *this;
        field.high = bound;
        field.has_high = true;
        return field;
    }
    constexpr Field range(Bound from, Bound to) const requires Number<Inner> { return at_least(from).at_most(to); }

    template <class S>
    static constexpr auto& of(S& object) {
        return object.*Member;
    }
};

template <auto Member>
constexpr Field<Member> field(std::string_view text) {
    return {.text = text, .unit_text = {}};
}

/// Calls visit(field, member) for each field of `object`, in the order of fields().
template <class S, class Visit>
requires Described<std::remove_const_t<S>>
constexpr void for_each_field(S& object, Visit&& visit) {
    std::apply([&](const auto&... field) { (visit(field, field.of(object)), ...); }, S::fields());
}

template <Described S>
inline constexpr std::size_t field_count = std::tuple_size_v<decltype(S::fields())>;

/// The names of the fields, in their order.
template <Described S>
inline constexpr std::array<std::string_view, field_count<S>> field_names = std::apply(
    [](const auto&... field) { return std::array<std::string_view, sizeof...(field)>{field.name...}; }, S::fields());

namespace detail {

template <Described S>
consteval bool names_differ() {
    const auto& names = field_names<S>;
    for (std::size_t i = 0; i < names.size(); ++i)
        for (std::size_t j = i + 1; j < names.size(); ++j)
            if (names[i] == names[j]) return false;
    return true;
}

} // namespace detail

/// S lists each of its members exactly once. For aggregates without base classes and C arrays.
template <class S>
inline constexpr bool fully_described = [] {
    static_assert(std::is_aggregate_v<S> && Described<S>);
    return detail::takes_values<S>(std::make_index_sequence<field_count<S>>()) &&
           !detail::takes_values<S>(std::make_index_sequence<field_count<S> + 1>()) && detail::names_differ<S>();
}();

} // namespace sim
