#include "reports/stability/catalogue.hpp"

#include "pipeline/functional/parallel.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports::stability {

namespace {

constexpr std::vector<Case> (*groups[])() = {depth_format_cases, peeling_cases,  kbuffer_cases,  rasterization_cases,
                                             blending_cases,     half_cases,     shadow_cases,   shadow_search_cases,
                                             field_cases,        distance_cases, geometry_cases, door_cases,
                                             frame_cases,        hardware_cases};

std::vector<Case> all_cases() {
    std::vector<Case> all;
    for (const auto group : groups)
        for (Case& one : group()) all.push_back(std::move(one));
    return all;
}

bool matches(std::string_view pattern, std::string_view text) {
    if (pattern.empty()) return text.empty();
    if (pattern.front() == '*')
        return matches(pattern.substr(1), text) || (!text.empty() && matches(pattern, text.substr(1)));
    return !text.empty() && (pattern.front() == '?' || pattern.front() == text.front()) &&
           matches(pattern.substr(1), text.substr(1));
}

std::vector<std::string> parts_of(const std::string& patterns) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= patterns.size();) {
        const std::size_t comma = std::min(patterns.find(',', at), patterns.size());
        parts.push_back(patterns.substr(at, comma - at));
        at = comma + 1;
    }
    return parts;
}

[[noreturn]] void refuse(const std::string& pattern) {
    std::vector<std::string> ids;
    for (const Case& one : catalogue()) ids.push_back(one.id);
    throw sim::InputError(fmt::format("--filter: no case matches '{}'{}; ropsim describe stability lists them", pattern,
                                      sim::did_you_mean(pattern, ids)));
}

} // namespace

const std::vector<Case>& catalogue() {
    static const std::vector<Case> cases = all_cases();
    return cases;
}

std::vector<const Case*> cases_matching(const std::string& patterns) {
    const std::vector<std::string> parts = parts_of(patterns.empty() ? "*" : patterns);
    std::vector<bool> used(parts.size());
    std::vector<const Case*> found;
    for (const Case& one : catalogue()) {
        bool wanted = false;
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (matches(parts[i], one.id)) used[i] = wanted = true;
        if (wanted) found.push_back(&one);
    }
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (!used[i]) refuse(parts[i]);
    return found;
}

std::vector<Outcome> run(const std::vector<const Case*>& cases, const std::atomic<bool>* stop) {
    std::vector<Outcome> outcomes(cases.size());
    pipeline::parallel_for(0, cases.size(), [&](std::size_t i) {
        if (stop != nullptr && *stop) throw sim::Interrupted();
        outcomes[i] = run(*cases[i]);
    });
    return outcomes;
}

} // namespace reports::stability
