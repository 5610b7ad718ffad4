#include "traces/tetrahedra/input_bytes.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <fstream>

namespace traces {

namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string read_all(const std::filesystem::path& path) {
    std::error_code error;
    std::ifstream stream(path, std::ios::binary);
    const auto size = std::filesystem::file_size(path, error);
    if (error || !stream || !std::filesystem::is_regular_file(path))
        throw sim::InputError(fmt::format("{}: expected a file that can be read", path.string()));
    std::string bytes(size, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (stream.gcount() != static_cast<std::streamsize>(size))
        throw sim::InputError(fmt::format("{}: expected {} bytes, got {}", path.string(), size, stream.gcount()));
    return bytes;
}

} // namespace

InputBytes::InputBytes(const std::filesystem::path& path) : name_(path.string()), bytes_(read_all(path)) {}

std::string_view InputBytes::take(std::size_t count, std::string_view what) {
    require_at_byte(count <= left(), "{} bytes of {}, got {}", count, what, left());
    const std::string_view taken = std::string_view(bytes_).substr(at_, count);
    at_ += count;
    return taken;
}

std::string_view InputBytes::next_word() const {
    const std::size_t begin = std::min(bytes_.find_first_not_of(blanks, at_), bytes_.size());
    const std::size_t end = std::min(bytes_.find_first_of(blanks, begin), bytes_.size());
    return std::string_view(bytes_).substr(begin, end - begin);
}

std::string_view InputBytes::word() {
    const std::string_view found = next_word();
    last_ = static_cast<std::size_t>(found.data() - bytes_.data());
    at_ = last_ + found.size();
    return found;
}

std::string_view InputBytes::line() {
    last_ = at_;
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view text = std::string_view(bytes_).substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
}

void InputBytes::fail_at_line(std::string_view expected) const {
    const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(last_, bytes_.size()));
    throw sim::InputError(
        fmt::format("{}: line {}: expected {}", name_, 1 + std::count(bytes_.begin(), end, '\n'), expected));
}

void InputBytes::fail_at_byte(std::string_view expected) const {
    throw sim::InputError(fmt::format("{}: byte {}: expected {}", name_, at_, expected));
}

std::string in_quotes(std::string_view word) {
    if (word.empty()) return "the end of the file";
    std::string text(word.substr(0, 40));
    for (char& letter : text)
        if (letter < ' ' || letter > '~') letter = '?';
    return fmt::format("'{}'{}", text, word.size() > 40 ? "..." : "");
}

} // namespace traces
