#include "traces/preparation/table.hpp"

namespace traces {

std::string spec_text(const std::string& id, const nlohmann::ordered_json& parameters) {
    std::string text = id;
    char separator = '?';
    for (const auto& [name, value] : parameters.items()) {
        text += separator;
        text += name + '=' + (value.is_string() ? value.get<std::string>() : value.dump());
        separator = '&';
    }
    return text;
}

} // namespace traces
