// Parameters of generators and workloads: described structs, overridden by name with text or JSON values.
#pragma once

#include "sim/described_json.hpp"
#include "sim/json_value.hpp"

#include <string>
#include <string_view>

namespace traces {

/// `text` as a JSON value where it is one (8, 0.5, true, [1,1,1]), else as a string.
nlohmann::ordered_json value_of_text(std::string_view text);

/// Adds "key=value" to `values`. Throws sim::InputError, beginning with `place`, when there is no key or it came
/// before.
void add_assignment(nlohmann::ordered_json& values, std::string_view assignment, std::string_view place);

/// The assignments of "key=value&key=value". Throws sim::InputError as add_assignment() does.
sim::JsonValue values_of_query(std::string_view text, std::string_view place);

/// The defaults of P overridden by `values`. Throws sim::InputError, beginning with `place`, for unknown names and for
/// values of the wrong type or out of range.
template <sim::Described P>
P read_parameters(const nlohmann::ordered_json& values, std::string_view place) {
    P parameters;
    sim::read_json(parameters, values, place);
    return parameters;
}

} // namespace traces
