#include "reports/numbers.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>

namespace reports {

namespace {

// 3 significant digits, never in powers of ten: 1.23, 12.3, 123.
std::string three_digits(double number) {
    const int decimals = number >= 99.95 ? 0 : number >= 9.995 ? 1 : 2;
    return fmt::format("{:.{}f}", number, decimals);
}

} // namespace

std::string short_number(double number) {
    if (!std::isfinite(number)) return "-";
    if (number < 10000) return number == std::floor(number) ? fmt::format("{:.0f}", number) : three_digits(number);
    constexpr std::array<const char*, 4> letters{"k", "M", "G", "T"};
    std::size_t letter = 0;
    for (number /= 1000; number >= 999.5 && letter + 1 < letters.size(); ++letter) number /= 1000;
    return three_digits(number) + letters[letter];
}

std::string bytes_text(double bytes) {
    constexpr std::array<const char*, 5> units{"B", "kB", "MB", "GB", "TB"};
    std::size_t unit = 0;
    for (; bytes >= 999.5 && unit + 1 < units.size(); ++unit) bytes /= 1000;
    return unit == 0 ? fmt::format("{:.0f} B", bytes) : fmt::format("{} {}", three_digits(bytes), units[unit]);
}

std::string duration_text(double seconds) {
    if (seconds < 9.95) return fmt::format("{:.{}f} s", seconds, seconds < 0.995 ? 2 : 1);
    const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

} // namespace reports
