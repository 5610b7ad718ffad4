#include "models/programs/program_file.hpp"

#include "ropsim_build.hpp"
#include "sim/check.hpp"
#include "sim/read_file.hpp"

#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <system_error>

namespace models {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t longest_text = 1U << 20; ///< bytes

fs::path find_program_file(std::string_view path) {
    std::error_code failed;
    if (fs::exists(path, failed)) return path;
    const fs::path name(path);
    const auto installed = ropsim_build::find_data(fs::path("models/programs") / name);
    return !name.has_parent_path() && installed ? *installed : name;
}

} // namespace

std::string_view program_name(std::string_view program) { return program.substr(0, program.find('\n')); }

std::string program_text(std::string_view program) {
    const std::string_view name = program_name(program);
    if (name.size() == program.size()) return sim::read_file(find_program_file(name), longest_text);
    const std::string_view text = program.substr(name.size() + 1);
    if (text.size() > longest_text)
        throw sim::InputError(
            fmt::format("{}: expected a program of at most {} bytes, got {}", name, longest_text, text.size()));
    return std::string(text);
}

void refuse_entry_kind(std::string_view program, std::string_view entry) {
    if (!entry.empty())
        throw sim::InputError(fmt::format("program {}: it declares its entries; expected no kind, got '{}'",
                                          program_name(program), entry));
}

} // namespace models
