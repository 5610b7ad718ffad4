// What derives from fields(): sums over parallel units, differences between draws, the list of all fields for help and
// the reference page, CSV columns. JSON is in described_json.hpp, which costs more to include.
#pragma once

#include "sim/check.hpp"
#include "sim/field.hpp"
#include "sim/stats.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// One field as text.
struct FieldInfo {
    std::string path; ///< "cache.lines"
    std::string type; ///< "integer", "number", "true or false", "text", "choice", "counter", "high water", "histogram"
    std::string unit;
    std::string text;
    std::string default_value;
    std::string range; ///< "1 to 65536", "at least 1", "rop_cache | writeback"; empty when anything goes
};

std::string number_text(double number); ///< shortest text that reads back as the same number
std::string number_text(float number);

/// One line of comma-separated values; cells that hold commas or quotes are quoted.
std::string csv_line(const std::vector<std::string>& cells);

namespace detail {

std::string join_path(std::string_view prefix, std::string_view name);
std::string with_unit(std::string path, std::string_view unit);

template <class T>
std::string text_of(const T& value) {
    if constexpr (std::same_as<T, bool>)
        return value ? "true" : "false";
    else if constexpr (Integer<T>)
        return std::to_string(value);
    else if constexpr (std::floating_point<T>)
        return number_text(value);
    else if constexpr (NamedEnum<T>)
        return std::string(enum_name(value));
    else if constexpr (std::same_as<T, std::string>)
        return value;
    else if constexpr (Sequence<T>) {
        std::string text;
        for (const auto& element : value) text += (text.empty() ? "" : " ") + text_of(element);
        return text;
    } else if constexpr (Described<T>) {
        std::string text;
        for_each_field(value, [&](const auto& field, const auto& member) {
            text += (text.empty() ? "" : " ") + std::string(field.name) + "=" + text_of(member);
        });
        return text;
    } else if constexpr (std::same_as<T, Histogram>)
        return std::to_string(value.count());
    else
        return std::to_string(value.value);
}

template <class T>
std::string type_name() {
    if constexpr (std::same_as<T, bool>)
        return "true or false";
    else if constexpr (Integer<T>)
        return "integer";
    else if constexpr (std::floating_point<T>)
        return "number";
    else if constexpr (NamedEnum<T>)
        return "choice";
    else if constexpr (std::same_as<T, std::string>)
        return "text";
    else if constexpr (Sequence<T>)
        return "list of " + type_name<typename T::value_type>();
    else if constexpr (Described<T>)
        return "table";
    else if constexpr (std::same_as<T, Counter>)
        return "counter";
    else if constexpr (std::same_as<T, HighWater>)
        return "high water";
    else {
        static_assert(std::same_as<T, Histogram>, "a field of a type that described structs do not know");
        return "histogram";
    }
}

template <NamedEnum E>
std::string choices() {
    std::string text;
    for (const std::string_view name : EnumNames<E>::names) text += (text.empty() ? "" : " | ") + std::string(name);
    return text;
}

template <auto Member>
std::string range_text(const Field<Member>& field) {
    if constexpr (NamedEnum<typename Field<Member>::Inner>) return choices<typename Field<Member>::Inner>();
    if (field.has_low && field.has_high) return text_of(field.low) + " to " + text_of(field.high);
    if (field.has_low) return "at least " + text_of(field.low);
    if (field.has_high) return "at most " + text_of(field.high);
    return {};
}

template <class T>
void add_value(T& into, const T& from) {
    if constexpr (Described<T>)
        for_each_field(into, [&](const auto& field, auto& member) { add_value(member, field.of(from)); });
    else if constexpr (std::same_as<T, HighWater>)
        into.note(from.value);
    else if constexpr (std::same_as<T, Histogram>)
        into.merge(from);
    else if constexpr (std::same_as<T, Counter>)
        into.value += from.value;
    else if constexpr (Number<T>)
        into = static_cast<T>(into + from);
    else if constexpr (Sequence<T>) {
        if constexpr (!FixedArray<T>)
            if (into.size() < from.size()) into.resize(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) add_value(into[i], from[i]);
    }
}

template <class T>
void subtract_value(T& from, const T& earlier) {
    if constexpr (Described<T>)
        for_each_field(from, [&](const auto& field, auto& member) { subtract_value(member, field.of(earlier)); });
    else if constexpr (std::same_as<T, Histogram>)
        from = from.since(earlier);
    else if constexpr (std::same_as<T, Counter>) {
        CHECK(from.value >= earlier.value);
        from.value -= earlier.value;
    } else if constexpr (Number<T>)
        from = static_cast<T>(from - earlier);
    else if constexpr (Sequence<T>)
        for (std::size_t i = 0; i < from.size() && i < earlier.size(); ++i) subtract_value(from[i], earlier[i]);
}

template <class T>
void describe_into(std::vector<FieldInfo>& list, const T& defaults, std::string_view prefix) {
    for_each_field(defaults, [&](const auto& field, const auto& member) {
        using Member = std::remove_cvref_t<decltype(member)>;
        const std::string path = join_path(prefix, field.name);
        if constexpr (Described<Member>)
            describe_into(list, member, path);
        else
            list.push_back({path, type_name<Member>(), std::string(field.unit_text), std::string(field.text),
                            text_of(member), range_text(field)});
    });
}

template <class T>
void csv_columns(std::vector<std::string>& columns, const T& value, const std::string& path, std::string_view unit) {
    if constexpr (Described<T>)
        for_each_field(value, [&](const auto& field, const auto& member) {
            csv_columns(columns, member, join_path(path, field.name), field.unit_text);
        });
    else if constexpr (FixedArray<T>)
        for (std::size_t i = 0; i < value.size(); ++i)
            csv_columns(columns, value[i], join_path(path, std::to_string(i)), unit);
    else if constexpr (std::same_as<T, Histogram>) {
        columns.push_back(path + ".count");
        for (const char* part : {".mean", ".min", ".max"}) columns.push_back(with_unit(path + part, unit));
    } else
        columns.push_back(with_unit(path, unit));
}

template <class T>
void csv_cells(std::vector<std::string>& cells, const T& value) {
    if constexpr (Described<T>)
        for_each_field(value, [&](const auto&, const auto& member) { csv_cells(cells, member); });
    else if constexpr (FixedArray<T>)
        for (const auto& element : value) csv_cells(cells, element);
    else if constexpr (std::same_as<T, Histogram>)
        cells.insert(cells.end(), {std::to_string(value.count()), number_text(value.mean()),
                                   std::to_string(value.min()), std::to_string(value.max())});
    else
        cells.push_back(text_of(value));
}

} // namespace detail

/// Adds up parallel units: counters and numbers are summed, high-water marks take the maximum, histograms are merged;
/// choices, flags and text stay as they are in `into`.
template <Described S>
void add(S& into, const S& from) {
    detail::add_value(into, from);
}

/// What happened between two copies of one struct: counters, numbers and histograms are subtracted; a high-water mark,
/// like every other field, is that of `later`.
template <Described S>
S difference(const S& later, const S& earlier) {
    S between = later;
    detail::subtract_value(between, earlier);
    return between;
}

/// All fields of S and of the structs in it, with their defaults.
template <Described S>
std::vector<FieldInfo> describe(std::string_view prefix = {}) {
    std::vector<FieldInfo> list;
    detail::describe_into(list, S{}, prefix);
    return list;
}

/// Column titles, with units: "tile_cache.hits [lines]". A histogram has four columns, a vector one.
template <Described S>
std::vector<std::string> csv_header(std::string_view prefix = {}) {
    std::vector<std::string> columns;
    detail::csv_columns(columns, S{}, std::string(prefix), {});
    return columns;
}

/// The cells below csv_header().
template <Described S>
std::vector<std::string> csv_row(const S& object) {
    std::vector<std::string> cells;
    detail::csv_cells(cells, object);
    return cells;
}

} // namespace sim
