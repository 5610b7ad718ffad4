// Whole files as text, with an error that says what is wrong with the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace sim {

/// The bytes of `path`. Throws InputError "PATH: " and what was expected: a file, where there is none, or a folder; one
/// that may be read, with the system's reason; one of at most `most_bytes`.
std::string read_file(const std::filesystem::path& path, std::uint64_t most_bytes);

} // namespace sim
