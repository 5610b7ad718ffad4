// A JSON value as a member of a struct: who includes the struct need not compile the JSON library, which is large.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace sim {

/// An empty object at first. Copies as the JSON value does, and converts to it; one that was moved from can only be
/// assigned to.
class JsonValue {
  public:
    using Json = nlohmann::ordered_json;

    JsonValue();
    JsonValue(Json value);
    JsonValue(const JsonValue& other);
    JsonValue(JsonValue&& other) noexcept;
    JsonValue& operator=(JsonValue other) noexcept;
    ~JsonValue();

    Json& operator*() { return *value_; }
    const Json& operator*() const { return *value_; }
    Json* operator->() { return value_.get(); }
    const Json* operator->() const { return value_.get(); }
    operator const Json&() const { return *value_; }
    bool operator==(const JsonValue& other) const;

    /// Made null where it is missing.
    Json& operator[](std::string_view key);

  private:
    std::unique_ptr<Json> value_;
};

} // namespace sim
