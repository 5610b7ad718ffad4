#include "traces/preparation/table.hpp"

#include <nlohmann/json.hpp>

namespace traces {

std::string spec_text(const std::string& id, sim::DescribedRef parameters) {
    std::string text = id;
    char separator = '?';
    const nlohmann::ordered_json json = sim::to_json(parameters);
    for (const auto& [name, value] : json.items()) {
        text += separator;
        text += name + '=' + (value.is_string() ? value.get<std::string>() : value.dump());
        separator = '&';
    }
    return text;
}

} // namespace traces
