// Programs of Debian whose replays are compared, and how they are traced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace replay_oracle {

struct DebianProgram {
    std::string name;
    std::string package;
    std::vector<std::string> command;
    std::uint32_t first = 0, end = 3; ///< frames that are compared
    std::uint32_t seconds = 240;      ///< after which the program is ended, if it does not end itself
};

const std::vector<DebianProgram>& debian_programs();

bool is_installed(const DebianProgram& program);

/// Writes what the program draws to an apitrace file, with a home folder that is empty. Throws sim::InputError where
/// apitrace or the program is missing, or nothing was written.
void trace_program(const DebianProgram& program, const std::filesystem::path& file);

} // namespace replay_oracle
