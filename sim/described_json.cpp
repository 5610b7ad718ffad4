#include "sim/described_json.hpp"

#include "sim/number_type.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

namespace sim {
namespace detail {

namespace {

std::string short_text(const Json& json) {
    if (json.is_object()) return "a table";
    if (json.is_number_float()) return number_text(json.get<double>());
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > 60) text = text.substr(0, 57) + "...";
    return text;
}

std::string message(const JsonPlace& where, std::string_view what, const Json& got) {
    const std::string path = where.path.empty() ? "" : where.path + ": ";
    return fmt::format("{}: {}expected {}, got {}", where.place, path, what, short_text(got));
}

template <class T>
bool fits(const Json& json) {
    if (json.is_number_unsigned()) return std::in_range<T>(json.get<std::uint64_t>());
    return json.is_number_integer() && std::in_range<T>(json.get<std::int64_t>());
}

std::uint64_t number_in(const Json& json, const char* key, const JsonPlace& where) {
    const auto found = json.find(key);
    if (found == json.end()) return 0;
    if (!fits<std::uint64_t>(*found)) expected({where.place, join_path(where.path, key)}, "a count", *found);
    return found->get<std::uint64_t>();
}

[[noreturn]] void expected_choice(const JsonPlace& where, const std::vector<std::string>& names, const Json& got) {
    const std::string word = got.is_string() ? got.get<std::string>() : "";
    throw InputError(message(where, fmt::format("one of {}", fmt::join(names, " | ")), got) +
                     did_you_mean(word, names));
}

// Only bins that hold something are written: {"start": count}.
Json histogram_to_json(const Histogram& histogram) {
    Json bins = Json::object();
    for (std::size_t bin = 0; bin < Histogram::bin_count; ++bin)
        if (histogram.bins()[bin] != 0) bins[std::to_string(histogram.bin_start(bin))] = histogram.bins()[bin];
    return {{"count", histogram.count()}, {"sum", histogram.sum()},   {"min", histogram.min()},
            {"max", histogram.max()},     {"mean", histogram.mean()}, {"bin_width", histogram.bin_width()},
            {"bins", std::move(bins)}};
}

Histogram histogram_from_json(const Json& json, const JsonPlace& where) {
    if (!json.is_object()) expected(where, "a histogram", json);
    const std::uint64_t width = number_in(json, "bin_width", where);
    const Histogram shape = width == 0 ? Histogram() : Histogram::linear(width);
    Histogram::Bins bins{};
    if (const auto list = json.find("bins"); list != json.end()) {
        if (!list->is_object()) expected({where.place, where.path + ".bins"}, "a table", *list);
        for (const auto& item : list->items()) {
            std::uint64_t start = 0;
            const char* end = item.key().data() + item.key().size();
            const auto parsed = std::from_chars(item.key().data(), end, start);
            const bool good = parsed.ec == std::errc() && parsed.ptr == end;
            const std::size_t bin = shape.bin_of(start);
            if (!good || shape.bin_start(bin) != start)
                expected({where.place, where.path + ".bins"}, "starts of bins as keys", item.key());
            bins[bin] = number_in(*list, item.key().c_str(), where);
        }
    }
    return Histogram::from_parts(width, number_in(json, "sum", where), number_in(json, "min", where),
                                 number_in(json, "max", where), bins);
}

Json value_to_json(const ValueType& type, const void* value);

Json table_to_json(const StructTable& table, const void* object) {
    Json json = Json::object();
    for (const FieldRow& field : table.fields)
        json[std::string(field.name)] = value_to_json(*field.type, member_at(field, object));
    return json;
}

Json value_to_json(const ValueType& type, const void* value) {
    switch (type.kind) {
    case Kind::boolean:
        return *static_cast<const bool*>(value);
    case Kind::integer:
    case Kind::real:
        return with_number_type(type, [value](auto number) { return Json(load<decltype(number)>(value)); });
    case Kind::choice:
        return choice_name(type, value);
    case Kind::text:
        return *static_cast<const std::string*>(value);
    case Kind::list: {
        Json json = Json::array();
        for (std::size_t i = 0; i < type.size(value); ++i)
            json.push_back(value_to_json(*type.element, element_at(type, value, i)));
        return json;
    }
    case Kind::table:
        return table_to_json(*type.table, value);
    case Kind::counter:
        return static_cast<const Counter*>(value)->value;
    case Kind::high_water:
        return static_cast<const HighWater*>(value)->value;
    case Kind::histogram:
        return histogram_to_json(*static_cast<const Histogram*>(value));
    }
    return {};
}

/// False for a NaN where there is a bound.
template <class T>
bool in_range(const FieldRow& field, T value) {
    return (field.low == nullptr || value >= load<T>(field.low)) &&
           (field.high == nullptr || value <= load<T>(field.high));
}

template <class T>
bool read_number(const FieldRow& field, void* into, const Json& json) {
    bool good = false;
    if constexpr (std::floating_point<T>)
        good = json.is_number() && std::isfinite(json.get<T>()) && in_range(field, json.get<T>());
    else
        good = fits<T>(json) && in_range(field, json.get<T>());
    if (good) store(into, json.get<T>());
    return good;
}

void read_choice(const ValueType& type, void* into, const Json& json, const JsonPlace& where) {
    const auto& names = type.choices;
    const auto found =
        json.is_string() ? std::find(names.begin(), names.end(), json.get_ref<const std::string&>()) : names.end();
    if (found == names.end()) expected_choice(where, {names.begin(), names.end()}, json);
    with_number_type(type, [&](auto number) { store(into, static_cast<decltype(number)>(found - names.begin())); });
}

/// `field` gives the range.
void read_value(const FieldRow& field, const ValueType& type, void* into, const Json& json, const JsonPlace& where);

void read_list(const FieldRow& field, const ValueType& type, void* list, const Json& json, const JsonPlace& where) {
    if (!json.is_array()) expected(where, type_name(type), json);
    if (type.resize != nullptr)
        type.resize(list, json.size());
    else if (json.size() != type.size(list))
        expected(where, std::to_string(type.size(list)) + " values", json);
    for (std::size_t i = 0; i < json.size(); ++i)
        read_value(field, *type.element, element_at(type, list, i), json[i],
                   {where.place, join_path(where.path, std::to_string(i))});
}

std::uint64_t read_count(const ValueType& type, const Json& json, const JsonPlace& where) {
    if (!fits<std::uint64_t>(json)) expected(where, type_name(type), json);
    return json.get<std::uint64_t>();
}

void read_value(const FieldRow& field, const ValueType& type, void* into, const Json& json, const JsonPlace& where) {
    switch (type.kind) {
    case Kind::boolean:
        if (!json.is_boolean()) expected(where, type_name(type), json);
        *static_cast<bool*>(into) = json.get<bool>();
        break;
    case Kind::text:
        if (!json.is_string()) expected(where, type_name(type), json);
        *static_cast<std::string*>(into) = json.get<std::string>();
        break;
    case Kind::integer:
    case Kind::real:
        if (!with_number_type(type, [&](auto number) { return read_number<decltype(number)>(field, into, json); })) {
            const std::string range = range_text(field);
            expected(where, type_name(type) + (range.empty() ? "" : " ") + range, json);
        }
        break;
    case Kind::choice:
        read_choice(type, into, json, where);
        break;
    case Kind::list:
        read_list(field, type, into, json, where);
        break;
    case Kind::table:
        read_struct(*type.table, into, json, where);
        break;
    case Kind::counter:
        static_cast<Counter*>(into)->value = read_count(type, json, where);
        break;
    case Kind::high_water:
        static_cast<HighWater*>(into)->value = read_count(type, json, where);
        break;
    case Kind::histogram:
        *static_cast<Histogram*>(into) = histogram_from_json(json, where);
        break;
    }
}

} // namespace

void expected(const JsonPlace& where, std::string_view what, const Json& got) {
    throw InputError(message(where, what, got));
}

void unknown_key(const JsonPlace& where, const std::string& key, const std::vector<std::string>& known) {
    std::vector<std::string> paths;
    for (const std::string& name : known) paths.push_back(join_path(where.path, name));
    const std::string path = join_path(where.path, key);
    throw InputError(fmt::format("{}: unknown key '{}'{}", where.place, path, did_you_mean(path, paths)));
}

void read_struct(const StructTable& table, void* object, const Json& json, const JsonPlace& where) {
    if (!json.is_object()) expected(where, "a table", json);
    std::vector<std::string> names;
    for (const FieldRow& field : table.fields) names.emplace_back(field.name);
    for (const auto& item : json.items())
        if (std::find(names.begin(), names.end(), item.key()) == names.end()) unknown_key(where, item.key(), names);
    for (const FieldRow& field : table.fields) {
        const auto found = json.find(field.name);
        if (found != json.end())
            read_member(field, member_at(field, object), *found, {where.place, join_path(where.path, field.name)});
    }
}

void read_member(const FieldRow& field, void* member, const Json& json, const JsonPlace& where) {
    read_value(field, *field.type, member, json, where);
}

} // namespace detail

nlohmann::ordered_json to_json(DescribedRef object) { return detail::table_to_json(*object.table, object.object); }

} // namespace sim
