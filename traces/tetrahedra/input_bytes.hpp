// A file as bytes, and where in it something was expected.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fmt/format.h>
#include <string>
#include <string_view>
#include <utility>

namespace traces {

/// Bytes of a file, read from the front to the end. Errors are sim::InputError of one line: file, place, what was
/// expected.
class InputBytes {
  public:
    /// Throws for a file that cannot be read.
    explicit InputBytes(const std::filesystem::path& path);

    const std::string& name() const { return name_; }
    const std::string& bytes() const { return bytes_; }
    std::size_t at() const { return at_; }
    std::size_t left() const { return bytes_.size() - at_; }

    /// The next `count` bytes; throws when fewer are left.
    std::string_view take(std::size_t count, std::string_view what);

    /// The next word: what lies between blanks and ends of lines; empty at the end of the file.
    std::string_view word();
    /// The next word without moving on.
    std::string_view next_word() const;
    /// The rest of this line, without its end.
    std::string_view line();

    /// Place in words of lines and bytes.
    [[noreturn]] void fail_at_line(std::string_view expected) const;
    [[noreturn]] void fail_at_byte(std::string_view expected) const;

    template <class... Arguments>
    void require_at_line(bool good, fmt::format_string<Arguments...> expected, Arguments&&... arguments) const {
        if (!good) fail_at_line(fmt::format(expected, std::forward<Arguments>(arguments)...));
    }
    template <class... Arguments>
    void require_at_byte(bool good, fmt::format_string<Arguments...> expected, Arguments&&... arguments) const {
        if (!good) fail_at_byte(fmt::format(expected, std::forward<Arguments>(arguments)...));
    }

  private:
    std::string name_;
    std::string bytes_;
    std::size_t at_ = 0;
    std::size_t last_ = 0; ///< where the last word began
};

/// A word of a file for an error message: cut off when long, with nothing that a terminal would obey.
std::string in_quotes(std::string_view word);

} // namespace traces
