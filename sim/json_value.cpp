#include "sim/json_value.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace sim {

JsonValue::JsonValue() : value_(std::make_unique<Json>(Json::object())) {}

JsonValue::JsonValue(Json value) : value_(std::make_unique<Json>(std::move(value))) {}

JsonValue::JsonValue(const JsonValue& other) : value_(std::make_unique<Json>(*other)) {}

JsonValue::JsonValue(JsonValue&&) noexcept = default;

JsonValue& JsonValue::operator=(JsonValue other) noexcept {
    value_.swap(other.value_);
    return *this;
}

JsonValue::~JsonValue() = default;

JsonValue::Json& JsonValue::operator[](std::string_view key) { return (*value_)[std::string(key)]; }

bool JsonValue::operator==(const JsonValue& other) const { return *value_ == *other.value_; }

} // namespace sim
