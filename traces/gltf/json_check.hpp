// The JSON of a glTF file, checked before tinygltf sees it, which passes over properties of the wrong type, takes 1.0
// for none, and ends up in deep recursion for deeply nested ones.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace traces::gltf {

/// Extensions of which everything that matters to a frame is read.
bool is_read_extension(std::string_view name);

/// A document as its properties are to be (properties.hpp): whole numbers are integers, what nothing depends on is
/// taken out. Adds to `notes` what was bad there, empty lists where glTF wants at least one element, and what is not
/// read.
/// Throws sim::InputError, beginning with `file` and the property as a path: JSON that does not parse or is nested too
/// deeply, another version than 2.x, required extensions that are not read (all of them), and whatever else the table
/// does not allow.
nlohmann::json checked_json(const std::string& file, std::string_view text, std::vector<std::string>& notes);

} // namespace traces::gltf
