#include "tests/support/paths.hpp"

#include <cstdlib>

namespace ropsim_test {

std::filesystem::path source_dir() { return ROPSIM_SOURCE_DIR; }

std::filesystem::path program() { return ROPSIM_PROGRAM; }

std::optional<std::filesystem::path> shared_file(const std::filesystem::path& relative) {
    const char* chosen = std::getenv("ROPSIM_SHARED_DIR");
    const std::filesystem::path directory = chosen != nullptr ? chosen : ROPSIM_SHARED_DIR;
    if (directory.empty() || !std::filesystem::exists(directory / relative)) return std::nullopt;
    return directory / relative;
}

} // namespace ropsim_test
