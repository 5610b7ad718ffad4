// The arrays of a legacy VTK file.
#pragma once

#include "traces/tetrahedra/input_bytes.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace traces {

/// Reads numbers as words, or as big-endian values of the type that the file names.
class VtkValues {
  public:
    VtkValues(InputBytes& file, bool binary) : file_(file), binary_(binary) {}

    /// `count` numbers of `type` ("float", "vtktypeint64", ...), all of them finite.
    std::vector<double> read(std::uint64_t count, std::string_view type, std::string_view what);
    /// Moves behind them.
    void skip(std::uint64_t count, std::string_view type, std::string_view what);
    /// Moves behind texts: a line each, or as long as it says.
    void skip_strings(std::uint64_t count);

  private:
    std::vector<double> read_words(std::uint64_t count, std::string_view what);
    std::string_view take_binary(std::uint64_t count, std::string_view type, std::string_view what);

    InputBytes& file_;
    bool binary_;
};

/// The next word as a whole number from 0 to `most`.
std::uint64_t read_count(InputBytes& file, std::uint64_t most, std::string_view what);

} // namespace traces
