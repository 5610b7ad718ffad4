// A number as a table prints it.
#pragma once

#include <string>
#include <string_view>

namespace reports {

/// What was printed, and how far it was rounded.
struct PrintedNumber {
    double value = 0;
    double half_digit = 0; ///< half a unit of the last digit that was printed

    /// The half digit over the value: how uncertain a logarithm of the value is.
    double sigma() const { return half_digit / value; }
};

/// "41.4": 41.4 +- 0.05. Throws sim::InputError naming `place` for what is no number above 0.
PrintedNumber printed_number(std::string_view text, std::string_view place);

} // namespace reports
