#include "cli/console.hpp"

#include "reports/remarks.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace cli {

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
    if (errno == EPIPE) { // whoever read has seen enough: end as others do
        std::signal(SIGPIPE, SIG_DFL);
        std::raise(SIGPIPE);
    }
    throw sim::InputError(fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
}

// With write(), which needs no lock and no memory, and whose failure is no exception.
void write_error(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
        if (written <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void complain(std::string_view text) { write_error("ropsim: " + std::string(text) + "\n"); }

void print_result(bool json, const std::string& document, const std::string& table,
                  const std::vector<std::string>& notes, const std::string& written) {
    if (!json) return print(table + reports::remarks_text(notes, terminal_style()) + written);
    print(document);
    for (const std::string& note : notes) complain("note: " + note);
}

bool terminal_is_able() {
    const char* terminal = std::getenv("TERM");
    return terminal == nullptr || std::string_view(terminal) != "dumb";
}

namespace {

constexpr std::size_t narrowest = 20;

std::size_t asked_columns() {
    const char* text = std::getenv("COLUMNS");
    std::size_t columns = 0;
    if (text == nullptr) return 0;
    const char* end = text + std::strlen(text);
    const auto [stop, error] = std::from_chars(text, end, columns);
    return error == std::errc() && stop == end ? columns : 0;
}

} // namespace

reports::TerminalStyle terminal_style() {
    reports::TerminalStyle style;
    const char* no_colour = std::getenv("NO_COLOR");
    const bool terminal = ::isatty(STDOUT_FILENO) != 0;
    style.colour = terminal && terminal_is_able() && (no_colour == nullptr || *no_colour == '\0');
    std::size_t columns = asked_columns();
    winsize size{};
    if (columns == 0 && terminal && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) columns = size.ws_col;
    if (columns != 0) style.columns = std::clamp(columns, narrowest, reports::TerminalStyle::widest);
    return style;
}

} // namespace cli
