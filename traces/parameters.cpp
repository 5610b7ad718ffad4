#include "traces/parameters.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace traces {

nlohmann::ordered_json value_of_text(std::string_view text) {
    nlohmann::ordered_json value = nlohmann::ordered_json::parse(text, nullptr, false);
    if (value.is_discarded() || value.is_object() || value.is_null()) return std::string(text);
    return value;
}

void add_assignment(nlohmann::ordered_json& values, std::string_view assignment, std::string_view place) {
    const std::size_t equals = assignment.find('=');
    if (equals == 0 || equals == std::string_view::npos)
        throw sim::InputError(fmt::format("{}: expected KEY=VALUE, got '{}'", place, assignment));
    const std::string key(assignment.substr(0, equals));
    if (values.contains(key)) throw sim::InputError(fmt::format("{}: '{}' is set twice", place, key));
    values[key] = value_of_text(assignment.substr(equals + 1));
}

sim::JsonValue values_of_query(std::string_view text, std::string_view place) {
    sim::JsonValue values;
    while (!text.empty()) {
        const std::size_t next = text.find('&');
        add_assignment(*values, text.substr(0, next), place);
        text = next == std::string_view::npos ? std::string_view() : text.substr(next + 1);
    }
    return values;
}

} // namespace traces
