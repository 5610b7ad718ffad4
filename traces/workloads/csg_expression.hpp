// Boolean expressions over objects: which points belong to a solid made of others.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

/// Operands are draws, as letters (A is draw 0, in upper or lower case) or numbers. Operators bind as in C: `!` (not),
/// `-` (without), `&` (and), `^` (either), `|` (or); all but `!` group from the left. Blanks do not count.
class CsgExpression {
  public:
    /// Throws sim::InputError with the column, counted from 1, and what was expected there.
    CsgExpression(std::string_view text, std::uint32_t objects);

    /// `inside[i]` says whether a point lies in object i.
    bool operator()(const std::vector<std::uint8_t>& inside) const;

  private:
    friend class CsgParser;
    struct Step {
        char operation = 0; ///< 0 = operand
        std::uint32_t object = 0;
    };
    std::vector<Step> steps_; ///< operands before their operator
};

} // namespace traces
