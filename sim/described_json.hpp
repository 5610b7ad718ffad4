// Described structs as JSON, both ways.
#pragma once

#include "sim/described.hpp"

#include <nlohmann/json_fwd.hpp>

namespace sim {

namespace detail {

using Json = nlohmann::ordered_json;

/// Where a value comes from: `place` is a file or an option, `path` the place within it.
struct JsonPlace {
    std::string_view place;
    std::string path;
};

[[noreturn]] void expected(const JsonPlace& where, std::string_view what, const Json& got);
[[noreturn]] void unknown_key(const JsonPlace& where, const std::string& key, const std::vector<std::string>& known);

void read_struct(const StructTable& table, void* object, const Json& json, const JsonPlace& where);
/// The member that `field` tells of.
void read_member(const FieldRow& field, void* member, const Json& json, const JsonPlace& where);

} // namespace detail

nlohmann::ordered_json to_json(DescribedRef object);

/// Json is a parameter so that a file may call this without the JSON library, which only whoever uses the result needs.
template <Described S, class Json = nlohmann::ordered_json>
Json to_json(const S& object) {
    return static_cast<Json (*)(DescribedRef)>(to_json)(DescribedRef(object));
}

/// Overwrites the fields that `json` names; throws InputError, its text beginning with `place`, for unknown keys and
/// for values of the wrong type or out of range.
template <Described S>
void read_json(S& object, const nlohmann::ordered_json& json, std::string_view place) {
    detail::read_struct(struct_table<S>, &object, json, {place, {}});
}

} // namespace sim
