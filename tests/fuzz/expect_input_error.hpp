// What a reader may do with anything at all: read it, or throw sim::InputError with one line.
#pragma once

#include "sim/check.hpp"

#include <cstdlib>
#include <fmt/format.h>
#include <string_view>

namespace fuzz {

/// Runs `read`; every outcome but these two ends the program, which libFuzzer reports with the input.
template <class Read>
void expect_result_or_input_error(Read&& read) {
    try {
        read();
    } catch (const sim::InputError& error) {
        if (std::string_view(error.what()).find('\n') == std::string_view::npos) return;
        fmt::print(stderr, "more than one line: {}\n", error.what());
        std::abort();
    }
}

} // namespace fuzz
