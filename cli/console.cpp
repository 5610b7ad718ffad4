#include "cli/console.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace cli {

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw sim::InputError(fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
}

void complain(std::string_view text) { fmt::print(stderr, "ropsim: {}\n", text); }

reports::TerminalStyle terminal_style() {
    reports::TerminalStyle style;
    if (::isatty(STDOUT_FILENO) == 0) return style;
    const char* no_colour = std::getenv("NO_COLOR");
    style.colour = no_colour == nullptr || *no_colour == '\0';
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col >= 40)
        style.columns = std::min<std::size_t>(size.ws_col, style.columns);
    return style;
}

} // namespace cli
