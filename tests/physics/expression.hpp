// Arithmetic over numbers of runs, as the table of predictions states its expectations.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace physics {

/// The number that a name stands for. Throws sim::InputError when there is none.
using Lookup = std::function<double(std::string_view name)>;

/// The value of `text`: + - * / ( ), numbers, min(a, b), max(a, b), abs(a), names (letters, digits, _ and .), and
/// or_zero(NAME): 0 where the run has no such link; for names "RUN.bytes..." only, since a link that carried nothing is
/// not listed. Throws sim::InputError that repeats `text` and says what was expected.
double evaluate(std::string_view text, const Lookup& lookup);

/// Both sides of an expectation and whether it holds.
struct Verdict {
    bool holds = false;
    std::string text; ///< "1.23 >= 1.5"
};

/// `text` is one of
///     A < B, A <= B, A > B, A >= B, A == B
///     A == B within X                  |A - B| <= X * |B|
///     RUN_*.VALUE rises [within X]     from run to run of a series no step down by more than the share X; rises as a
///                                      whole: the last is above the first
///     RUN_*.VALUE falls [within X]     likewise
///     RUN_*.VALUE does not rise [within X], RUN_*.VALUE does not fall [within X]      single steps only
/// `series` gives the names of the runs of a series in their order.
Verdict judge(const std::string& text, const Lookup& lookup,
              const std::function<std::vector<std::string>(const std::string& prefix)>& series);

} // namespace physics
