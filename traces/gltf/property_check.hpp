// A glTF document against the table of its properties.
#pragma once

#include "traces/gltf/properties.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace traces::gltf {

/// Checks every property that has a row in the table, makes whole numbers integers and takes out what is unread, with a
/// note where it was bad. Throws sim::InputError "file: path.of[3].property: expected ..., got ...".
void check_properties(const std::string& file, nlohmann::json& document, std::vector<std::string>& notes);

/// ", got VALUE", cut off when long; "" for null.
std::string got(const nlohmann::json& value);

/// Text of a file for a message: without what a terminal would obey.
std::string one_line(std::string text);

} // namespace traces::gltf
