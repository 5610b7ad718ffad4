// Scenes made by rule, for measurements whose outcome can be computed: `gen:NAME?key=value&key=value`.
#pragma once

#include "sim/described.hpp"
#include "traces/scene.hpp"

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

struct Generator {
    std::string id;
    std::string summary; ///< one line
    std::vector<sim::FieldInfo> parameters;
    /// `values` overrides parameters by name; throws sim::InputError for unknown names and values out of range.
    std::function<Scene(const nlohmann::ordered_json& values)> build;
};

/// All generators, in the order in which help lists them.
const std::vector<Generator>& generators();

/// `spec` begins with "gen:". Throws sim::InputError, naming what is near to a mistyped name.
Scene generate_scene(std::string_view spec);

} // namespace traces
