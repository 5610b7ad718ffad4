// Numbers as people read them.
#pragma once

#include "sim/counted.hpp"

#include <cstdint>
#include <string>

namespace reports {

using sim::counted;
using sim::with_commas;

/// Three significant digits and a letter: 1234567 -> "1.23M"; below 10,000 as they are.
std::string short_number(double number);

/// "512 B", "3.4 MB" (powers of 1000).
std::string bytes_text(double bytes);

/// "0.35 s", "12 s", "3 min 20 s".
std::string duration_text(double seconds);

} // namespace reports
