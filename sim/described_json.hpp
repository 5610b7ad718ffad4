// Described structs as JSON, both ways.
#pragma once

#include "sim/described.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace sim {

namespace detail {

using Json = nlohmann::ordered_json;

/// Where a value comes from: `place` is a file or an option, `path` the place within it.
struct JsonPlace {
    std::string_view place;
    std::string path;
};

[[noreturn]] void expected(const JsonPlace& where, std::string_view what, const Json& got);
[[noreturn]] void expected_choice(const JsonPlace& where, const std::vector<std::string>& names, const Json& got);
[[noreturn]] void unknown_key(const JsonPlace& where, const std::string& key, const std::vector<std::string>& known);
std::string with_range(std::string type, const std::string& range);
Json histogram_to_json(const Histogram& histogram);
Histogram histogram_from_json(const Json& json, const JsonPlace& where);

template <class T>
Json value_to_json(const T& value) {
    if constexpr (Described<T>) {
        Json json = Json::object();
        for_each_field(value, [&](const auto& field, const auto& member) {
            json[std::string(field.name)] = value_to_json(member);
        });
        return json;
    } else if constexpr (NamedEnum<T>)
        return std::string(enum_name(value));
    else if constexpr (Sequence<T>) {
        Json json = Json::array();
        for (const auto& element : value) json.push_back(value_to_json(element));
        return json;
    } else if constexpr (std::same_as<T, Histogram>)
        return histogram_to_json(value);
    else if constexpr (std::same_as<T, Counter> || std::same_as<T, HighWater>)
        return value.value;
    else
        return value;
}

template <Integer T>
bool fits(const Json& json) {
    if (json.is_number_unsigned()) return std::in_range<T>(json.get<std::uint64_t>());
    return json.is_number_integer() && std::in_range<T>(json.get<std::int64_t>());
}

/// `field` gives the range.
template <class T, class F>
void read_value(T& value, const Json& json, const JsonPlace& where, const F& field);

template <class T>
requires Described<T>
void read_struct(T& object, const Json& json, const JsonPlace& where) {
    if (!json.is_object()) expected(where, "a table", json);
    const auto& names = field_names<T>;
    for (const auto& item : json.items())
        if (std::find(names.begin(), names.end(), item.key()) == names.end())
            unknown_key(where, item.key(), {names.begin(), names.end()});
    for_each_field(object, [&](const auto& field, auto& member) {
        const auto found = json.find(field.name);
        if (found != json.end()) read_value(member, *found, {where.place, join_path(where.path, field.name)}, field);
    });
}

template <class T, class F>
void read_sequence(T& value, const Json& json, const JsonPlace& where, const F& field) {
    if (!json.is_array()) expected(where, type_name<T>(), json);
    if constexpr (FixedArray<T>) {
        if (json.size() != value.size()) expected(where, std::to_string(value.size()) + " values", json);
    } else
        value.resize(json.size());
    for (std::size_t i = 0; i < json.size(); ++i) {
        typename T::value_type element = value[i];
        read_value(element, json[i], {where.place, join_path(where.path, std::to_string(i))}, field);
        value[i] = std::move(element);
    }
}

template <class T, class F>
void read_value(T& value, const Json& json, const JsonPlace& where, const F& field) {
    if constexpr (Described<T>)
        read_struct(value, json, where);
    else if constexpr (Sequence<T>)
        read_sequence(value, json, where, field);
    else if constexpr (std::same_as<T, Histogram>)
        value = histogram_from_json(json, where);
    else if constexpr (std::same_as<T, Counter> || std::same_as<T, HighWater>) {
        if (!fits<std::uint64_t>(json)) expected(where, type_name<T>(), json);
        value.value = json.get<std::uint64_t>();
    } else if constexpr (NamedEnum<T>) {
        const auto& names = EnumNames<T>::names;
        const auto found =
            json.is_string() ? std::find(names.begin(), names.end(), json.get_ref<const std::string&>()) : names.end();
        if (found == names.end()) expected_choice(where, {names.begin(), names.end()}, json);
        value = static_cast<T>(found - names.begin());
    } else {
        bool good = false;
        if constexpr (std::same_as<T, bool>) good = json.is_boolean();
        if constexpr (std::same_as<T, std::string>) good = json.is_string();
        if constexpr (Integer<T>) good = fits<T>(json) && field.contains(json.get<T>());
        if constexpr (std::floating_point<T>)
            good = json.is_number() && std::isfinite(json.get<T>()) && field.contains(json.get<T>());
        if (!good) expected(where, with_range(type_name<T>(), range_text(field)), json);
        value = json.get<T>();
    }
}

} // namespace detail

template <Described S>
nlohmann::ordered_json to_json(const S& object) {
    return detail::value_to_json(object);
}

/// Overwrites the fields that `json` names; throws InputError, its text beginning with `place`, for unknown keys and
/// for values of the wrong type or out of range.
template <Described S>
void read_json(S& object, const nlohmann::ordered_json& json, std::string_view place) {
    detail::read_struct(object, json, {place, {}});
}

} // namespace sim
