// Where tests find the program, the repository and further scenes.
#pragma once

#include <filesystem>
#include <optional>

namespace ropsim_test {

std::filesystem::path source_dir();
std::filesystem::path program();

/// A file below the folder of further scenes and traces ($ROPSIM_SHARED_DIR, else the one CMake was given), or nothing:
/// then the test skips itself.
std::optional<std::filesystem::path> shared_file(const std::filesystem::path& relative);

} // namespace ropsim_test
