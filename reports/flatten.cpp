#include "reports/flatten.hpp"

#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

bool is_histogram(const ordered_json& json) { return json.contains("bins") && json.contains("bin_width"); }

void append(FlatValues& values, const std::string& path, const ordered_json& json) {
    const auto below = [&path](const std::string& name) { return path.empty() ? name : path + "." + name; };
    if (json.is_object() && is_histogram(json)) {
        for (const char* part : {"count", "mean", "min", "max"})
            if (json.contains(part)) values.emplace_back(below(part), json[part]);
    } else if (json.is_object()) {
        for (const auto& item : json.items()) append(values, below(item.key()), item.value());
    } else if (json.is_array()) {
        for (std::size_t i = 0; i < json.size(); ++i) append(values, below(std::to_string(i)), json[i]);
    } else if (!json.is_null()) {
        values.emplace_back(path, json);
    }
}

} // namespace

FlatValues flatten(const ordered_json& json) {
    FlatValues values;
    append(values, {}, json);
    return values;
}

std::string cell_text(const ordered_json& leaf) {
    return leaf.is_string() ? leaf.get<std::string>() : leaf.is_null() ? std::string() : leaf.dump();
}

} // namespace reports
