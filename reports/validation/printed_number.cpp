#include "reports/validation/printed_number.hpp"

#include "sim/check.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace reports {

PrintedNumber printed_number(std::string_view text, std::string_view place) {
    PrintedNumber number;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number.value);
    const bool whole = error == std::errc{} && end == text.data() + text.size();
    if (!whole || !(number.value > 0) || !std::isfinite(number.value) || text.find_first_of("eE") != text.npos)
        throw sim::InputError(fmt::format("{}: '{}': expected a number above 0 as it was printed", place, text));
    const std::size_t point = text.find('.');
    const std::size_t digits = point == std::string_view::npos ? 0 : text.size() - point - 1;
    number.half_digit = 0.5 * std::pow(10.0, -static_cast<double>(digits));
    return number;
}

} // namespace reports
