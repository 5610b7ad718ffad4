// A GLSL shader while it is written: declarations appear with their first use.
#pragma once

#include "traces/recording/recording.hpp"

#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace traces::fixed_function {

/// Names of uniforms, inputs and locals never coincide.
class ShaderText {
  public:
    /// Each gives the name back, and declares it the first time.
    template <class T>
    std::string uniform(const std::string& name, const T& value) {
        if (declare(name, "uniform " + glsl_type<T>() + " " + name)) {
            UniformValue& last = values_.emplace_back();
            last.name = name;
            last.words.resize(sizeof(T) / sizeof(std::uint32_t));
            std::memcpy(last.words.data(), &value, sizeof(T));
        }
        return name;
    }
    std::string sampler(const std::string& type, const std::string& name);
    /// `flat`: not interpolated.
    std::string input(const std::string& type, const std::string& name, bool flat = false);
    std::string output(const std::string& type, const std::string& name, bool flat = false);
    std::string local(const std::string& type, const std::string& name, const std::string& expression);

    /// A statement of main(), without indentation and semicolon.
    void statement(const std::string& text) { body_ += "    " + text + ";\n"; }
    /// Declares a function once.
    void function(const std::string& name, const std::string& text);

    bool declares(const std::string& name) const;
    const std::vector<std::string>& inputs() const { return inputs_; }
    const std::vector<UniformValue>& values() const { return values_; }
    std::string source() const;

  private:
    template <class T>
    static std::string glsl_type() {
        if constexpr (std::is_same_v<T, float>)
            return "float";
        else if constexpr (std::is_same_v<T, glm::vec3>)
            return "vec3";
        else if constexpr (std::is_same_v<T, glm::vec4>)
            return "vec4";
        else if constexpr (std::is_same_v<T, glm::mat3>)
            return "mat3";
        else {
            static_assert(std::is_same_v<T, glm::mat4>);
            return "mat4";
        }
    }
    bool declare(const std::string& name, const std::string& text);

    std::string declarations_, functions_, body_;
    std::vector<std::string> names_, inputs_;
    std::vector<UniformValue> values_;
};

} // namespace traces::fixed_function
