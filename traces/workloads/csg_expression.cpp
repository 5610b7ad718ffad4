#include "traces/workloads/csg_expression.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace traces {

namespace {

constexpr std::string_view operators = "|^&-"; // from the loosest to the tightest
constexpr int deepest = 200;                   // parentheses and `!` within each other

} // namespace

class CsgParser {
  public:
    CsgParser(std::string_view text, std::uint32_t objects) : text_(text), objects_(objects) {}

    std::vector<CsgExpression::Step> run() && {
        binary(0);
        if (next() != 0) fail("an operator of | ^ & - or the end");
        return std::move(steps_);
    }

  private:
    /// The next letter that is no blank; 0 at the end.
    char next() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }

    void binary(std::size_t level) {
        if (level == operators.size()) return unary();
        binary(level + 1);
        while (next() == operators[level]) {
            ++at_;
            binary(level + 1);
            steps_.push_back({operators[level], 0});
        }
    }

    void unary() {
        if (++depth_ > deepest) fail(fmt::format("at most {} parentheses and ! within each other", deepest));
        const char letter = next();
        if (letter == '!') {
            ++at_;
            unary();
            steps_.push_back({'!', 0});
        } else if (letter == '(') {
            ++at_;
            binary(0);
            if (next() != ')') fail("an operator of | ^ & - or )");
            ++at_;
        } else {
            operand(letter);
        }
        --depth_;
    }

    void operand(char letter) {
        const std::size_t begin = at_;
        std::uint64_t object = 0;
        if (std::isalpha(static_cast<unsigned char>(letter)) != 0) {
            object = static_cast<std::uint64_t>(std::toupper(static_cast<unsigned char>(letter)) - 'A');
            ++at_;
        } else if (letter >= '0' && letter <= '9') {
            for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_)
                object = std::min<std::uint64_t>(object * 10 + static_cast<std::uint64_t>(text_[at_] - '0'), objects_);
        } else {
            fail("a draw (letter or number), ! or (");
        }
        if (object < objects_) return steps_.push_back({'\0', static_cast<std::uint32_t>(object)});
        const std::string name(text_.substr(begin, std::min<std::size_t>(at_ - begin, 20)));
        at_ = begin;
        fail(fmt::format("a draw of the scene, which has {} (A or 0 is the first), but {} is none", objects_, name));
    }

    [[noreturn]] void fail(const std::string& expected) const {
        throw sim::InputError(fmt::format("workload csg: expression: column {}: expected {}", at_ + 1, expected));
    }

    std::string_view text_;
    std::uint32_t objects_;
    std::size_t at_ = 0;
    int depth_ = 0;
    std::vector<CsgExpression::Step> steps_;
};

CsgExpression::CsgExpression(std::string_view text, std::uint32_t objects) : steps_(CsgParser(text, objects).run()) {}

bool CsgExpression::operator()(const std::vector<std::uint8_t>& inside) const {
    std::vector<bool> stack;
    for (const Step& step : steps_) {
        if (step.operation == '\0') {
            stack.push_back(inside[step.object] != 0);
            continue;
        }
        const bool right = stack.back();
        stack.pop_back();
        if (step.operation == '!') {
            stack.push_back(!right);
            continue;
        }
        const bool left = stack.back();
        switch (step.operation) {
        case '&':
            stack.back() = left && right;
            break;
        case '|':
            stack.back() = left || right;
            break;
        case '^':
            stack.back() = left != right;
            break;
        default:
            stack.back() = left && !right;
            break;
        }
    }
    return stack.back();
}

} // namespace traces
