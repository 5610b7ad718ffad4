#include "tests/physics/expression.hpp"

#include "sim/config.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace physics {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Recursive descent; one character looked ahead.
class Parser {
  public:
    Parser(std::string_view text, const Lookup& lookup) : text_(text), lookup_(&lookup) {}

    double all() {
        const double value = sum();
        if (here() != '\0') expected("an operator");
        return value;
    }

  private:
    [[noreturn]] void expected(std::string_view what) const {
        throw sim::InputError(
            fmt::format("'{}': expected {} at '{}'", text_, what, text_.substr(std::min(at_, text_.size()))));
    }

    char here() {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool take(char c) {
        if (here() != c) return false;
        ++at_;
        return true;
    }
    void need(char c) {
        if (!take(c)) expected(fmt::format("'{}'", c));
    }

    double sum() {
        double value = product();
        while (here() == '+' || here() == '-') value = take('+') ? value + product() : (need('-'), value - product());
        return value;
    }
    double product() {
        double value = factor();
        while (here() == '*' || here() == '/') value = take('*') ? value * factor() : (need('/'), value / factor());
        return value;
    }
    double factor() {
        if (take('-')) return -factor();
        if (take('(')) {
            const double value = sum();
            need(')');
            return value;
        }
        if (is_digit(here())) return number();
        if (is_letter(here())) return named();
        expected("a number, a name or '('");
    }

    double number() {
        double value = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error != std::errc()) expected("a number");
        at_ = static_cast<std::size_t>(end - text_.data());
        return value;
    }
    std::string_view name() {
        here();
        const std::size_t begin = at_;
        while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '.')) ++at_;
        return text_.substr(begin, at_ - begin);
    }
    double named() {
        const std::string_view word = name();
        if (!take('(')) return (*lookup_)(word);
        double value = 0;
        if (word == "or_zero") {
            value = or_zero(name());
        } else if (word == "abs") {
            value = std::abs(sum());
        } else if (word == "min" || word == "max") {
            value = sum();
            need(',');
            const double other = sum();
            value = word == "min" ? std::min(value, other) : std::max(value, other);
        } else {
            expected("abs, min, max or or_zero before '('");
        }
        need(')');
        return value;
    }
    double or_zero(std::string_view of) {
        if (of.find(".bytes.") == std::string_view::npos) expected("the name of a link in or_zero()");
        const std::string_view run = of.substr(0, of.find('.'));
        (*lookup_)(fmt::format("{}.cycles", run)); // the run itself has to be there
        try {
            return (*lookup_)(of);
        } catch (const sim::InputError&) {
            return 0;
        }
    }

    std::string_view text_;
    const Lookup* lookup_;
    std::size_t at_ = 0;
};

/// Cuts " within X" off the end; 0 when there is none.
double take_tolerance(std::string& text, const Lookup& lookup) {
    constexpr std::string_view word = " within ";
    const std::size_t at = text.rfind(word);
    if (at == std::string::npos) return 0;
    const double tolerance = evaluate(std::string_view(text).substr(at + word.size()), lookup);
    text.resize(at);
    return tolerance;
}

bool ends(std::string& text, std::string_view suffix) {
    if (!text.ends_with(suffix)) return false;
    text.resize(text.size() - suffix.size());
    return true;
}

/// Steps of a series, in the direction `sign` (1: up). A step back by more than the tolerance breaks it.
Verdict judge_steps(const std::vector<double>& values, double sign, double tolerance, bool as_a_whole) {
    Verdict verdict{true, fmt::format("{:.6g}", fmt::join(values, ", "))};
    for (std::size_t i = 1; i < values.size(); ++i)
        if (sign * (values[i] - values[i - 1]) < -tolerance * std::abs(values[i - 1])) verdict.holds = false;
    if (as_a_whole && !(sign * (values.back() - values.front()) > 0)) verdict.holds = false;
    return verdict;
}

bool compare(std::string_view relation, double a, double b, double tolerance) {
    if (relation == "<=") return a <= b;
    if (relation == ">=") return a >= b;
    if (relation == "==") return std::abs(a - b) <= tolerance * std::abs(b);
    return relation == "<" ? a < b : a > b;
}

} // namespace

double evaluate(std::string_view text, const Lookup& lookup) { return Parser(text, lookup).all(); }

Verdict judge(const std::string& text, const Lookup& lookup,
              const std::function<std::vector<std::string>(const std::string& prefix)>& series) {
    std::string rest = text;
    const double tolerance = take_tolerance(rest, lookup);
    const std::size_t star = rest.find("_*.");
    if (star != std::string::npos) {
        // The direction that no single step may leave, and whether the ends have to differ.
        double sign = 0;
        bool as_a_whole = true;
        if (ends(rest, " does not fall"))
            sign = 1, as_a_whole = false;
        else if (ends(rest, " does not rise"))
            sign = -1, as_a_whole = false;
        else if (ends(rest, " rises"))
            sign = 1;
        else if (ends(rest, " falls"))
            sign = -1;
        else
            throw sim::InputError(fmt::format("'{}': expected rises, falls, does not rise or does not fall", text));
        std::vector<double> values;
        for (const std::string& run : series(rest.substr(0, star + 1)))
            values.push_back(lookup(fmt::format("{}{}", run, rest.substr(star + 2))));
        if (values.size() < 2) throw sim::InputError(fmt::format("'{}': expected a series of at least two runs", text));
        return judge_steps(values, sign, tolerance, as_a_whole);
    }
    for (const std::string_view relation : std::array<std::string_view, 5>{"<=", ">=", "==", "<", ">"}) {
        const std::size_t at = rest.find(relation);
        if (at == std::string::npos) continue;
        const double a = evaluate(std::string_view(rest).substr(0, at), lookup);
        const double b = evaluate(std::string_view(rest).substr(at + relation.size()), lookup);
        return {compare(relation, a, b, tolerance), fmt::format("{:.6g} {} {:.6g}", a, relation, b)};
    }
    throw sim::InputError(fmt::format("'{}': expected a relation", text));
}

} // namespace physics
