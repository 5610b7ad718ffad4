// A stiff or extreme case: what is done to the program's own functions, what has to come out, and what did.
#pragma once

#include "reports/images.hpp"
#include "sim/check.hpp"
#include "sim/field.hpp"

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace reports::stability {

/// On which side of its limit a case lies; `whole` has no limit, or goes through all of them.
enum class Side : std::uint8_t { below, at, above, whole };

/// What a case finds out.
class Finding {
  public:
    /// One distance between what came out and what was expected, in the unit of the case. The largest is the error of
    /// the case; what is not a number counts as infinite.
    void error(double distance);
    /// A fact that does not hold fails the case whatever its error.
    void require(bool holds, std::string_view fact);
    /// `action` throws sim::InputError whose message holds `part`.
    void refuses(const std::function<void()>& action, std::string_view part);
    /// What came out, in words; without it "as expected", or the facts that do not hold.
    void outcome(std::string text) { outcome_ = std::move(text); }
    void show(Picture picture) { picture_ = std::move(picture); }

    double largest_error() const { return error_; }
    const std::string& failed_facts() const { return failed_; }
    const std::string& outcome() const { return outcome_; }
    const Picture& picture() const { return picture_; }

  private:
    double error_ = 0.0;
    std::string failed_, outcome_;
    Picture picture_;
};

struct Case {
    std::string id; ///< "GROUP.NAME"
    Side side = Side::whole;
    std::string subject;     ///< what is stiff or extreme about it
    std::string expectation; ///< in words, with the numbers
    std::string unit;        ///< of the error: "ulp", "D24 units", "1/255", "relative" ...; empty: facts only
    double bound = 0.0;      ///< of the error, in that unit
    std::function<void(Finding&)> check;
    bool is_long = false; ///< takes more than three seconds
};

/// What became of a case.
struct Outcome {
    const Case* of = nullptr;
    std::string text;
    double error = 0.0;
    bool ok = false;
    double seconds = 0.0;
    Picture picture; ///< of no pixels where there is none
};

/// Runs one case. Whatever it throws, but for sim::Interrupted, is an outcome that fails.
Outcome run(const Case& one);

} // namespace reports::stability

template <>
struct sim::EnumNames<reports::stability::Side> {
    static constexpr std::array<std::string_view, 4> names{"below", "at", "above", "-"};
};
