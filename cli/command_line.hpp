// The arguments of the program. CLI11 takes 8 s to compile, so only command_line.cpp includes it.
#pragma once

#include "cli/options.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace cli {

/// The arguments are not a command. The message is one line. Exit status 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Throws UsageError, naming what is near to a mistyped subcommand or option.
Command parse_command_line(const std::vector<std::string>& arguments);

} // namespace cli
