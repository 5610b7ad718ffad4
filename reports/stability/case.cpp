#include "reports/stability/case.hpp"

#include "reports/stopwatch.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace reports::stability {

void Finding::error(double distance) {
    const double size = std::fabs(distance);
    error_ = std::max(error_, std::isnan(size) ? std::numeric_limits<double>::infinity() : size);
}

void Finding::require(bool holds, std::string_view fact) {
    if (holds || failed_.size() > 200) return; // the first few tell enough
    failed_ += fmt::format("{}not so: {}", failed_.empty() ? "" : "; ", fact);
}

void Finding::refuses(const std::function<void()>& action, std::string_view part) {
    try {
        action();
    } catch (const sim::InputError& refusal) {
        require(std::string_view(refusal.what()).find(part) != std::string_view::npos,
                fmt::format("'{}' names '{}'", refusal.what(), part));
        if (outcome_.empty()) outcome_ = fmt::format("refused: {}", refusal.what());
        return;
    }
    require(false, fmt::format("refused with '{}'", part));
}

Outcome run(const Case& one) {
    Outcome outcome;
    outcome.of = &one;
    Finding finding;
    const Stopwatch watch;
    try {
        one.check(finding);
        outcome.error = finding.largest_error();
        outcome.ok = finding.failed_facts().empty() && outcome.error <= one.bound;
        outcome.text = finding.failed_facts();
        if (outcome.text.empty()) outcome.text = finding.outcome();
        if (outcome.text.empty()) outcome.text = outcome.ok ? "as expected" : "the error is above its bound";
        outcome.picture = finding.picture();
    } catch (const sim::Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        outcome.text = fmt::format("threw: {}", error.what());
        outcome.error = std::numeric_limits<double>::infinity();
    }
    outcome.seconds = watch.seconds();
    return outcome;
}

} // namespace reports::stability
