#include "tests/support/schema.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace ropsim_test {

using nlohmann::json;

namespace {

const std::set<std::string> known_keywords = {"$schema", "$defs",    "$ref",        "title",
                                              "type",    "required", "items",       "properties",
                                              "enum",    "minimum",  "description", "additionalProperties"};

bool has_type(const json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    return type == "null" && value.is_null();
}

class Checker {
  public:
    explicit Checker(const json& root) : root_(root) {}

    void check(const json& schema, const json& value, const std::string& path) {
        for (const auto& item : schema.items())
            if (!known_keywords.contains(item.key())) report(path, "schema keyword '" + item.key() + "' is not known");
        if (schema.contains("$ref"))
            check(root_.at(json::json_pointer(schema["$ref"].get<std::string>().substr(1))), value, path);
        if (schema.contains("type") && !has_type(value, schema["type"]))
            return report(path,
                          "expected " + schema["type"].get<std::string>() + ", got " + value.dump().substr(0, 60));
        if (schema.contains("enum") &&
            std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
            report(path, "expected one of " + schema["enum"].dump());
        if (schema.contains("minimum") && value.is_number() && !(value >= schema["minimum"]))
            report(path, "expected at least " + schema["minimum"].dump() + ", got " + value.dump());
        if (value.is_object()) check_object(schema, value, path);
        if (value.is_array() && schema.contains("items"))
            for (std::size_t i = 0; i < value.size(); ++i)
                check(schema["items"], value[i], path + "/" + std::to_string(i));
    }

    std::vector<std::string> violations;

  private:
    void check_object(const json& schema, const json& value, const std::string& path) {
        for (const auto& name : schema.value("required", json::array()))
            if (!value.contains(name.get<std::string>())) report(path, "lacks " + name.dump());
        const json properties = schema.value("properties", json::object());
        for (const auto& item : value.items()) {
            const std::string below = path + "/" + item.key();
            if (properties.contains(item.key()))
                check(properties[item.key()], item.value(), below);
            else if (schema.contains("additionalProperties"))
                check_additional(schema["additionalProperties"], item.value(), below);
        }
    }

    void check_additional(const json& schema, const json& value, const std::string& path) {
        if (schema.is_object())
            check(schema, value, path);
        else if (schema == false)
            report(path, "is not in the schema");
    }

    void report(const std::string& path, const std::string& what) { violations.push_back(path + ": " + what); }

    const json& root_;
};

} // namespace

std::vector<std::string> schema_violations(const json& schema, const json& document) {
    Checker checker(schema);
    checker.check(schema, document, "");
    return checker.violations;
}

} // namespace ropsim_test
