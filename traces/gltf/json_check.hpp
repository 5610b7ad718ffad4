// Checks on the JSON of a glTF file that come before tinygltf, which passes over properties of the wrong type and ends
// up in deep recursion for deeply nested ones.
#pragma once

#include <string>
#include <string_view>

namespace traces::gltf {

/// Extensions of which everything that matters to a frame is read.
bool is_read_extension(std::string_view name);

/// Throws sim::InputError, beginning with `file`: JSON that does not parse or is nested too deeply, another version
/// than 2.x, a required extension that is not read, lists that are no lists, indices, counts and lengths that are no
/// natural numbers.
void check_json(const std::string& file, std::string_view text);

} // namespace traces::gltf
