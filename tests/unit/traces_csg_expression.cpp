// Boolean expressions of constructive solid geometry: every combination of what is inside, and every mistake.
#include "sim/check.hpp"
#include "traces/workloads/csg_expression.hpp"

#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>

namespace traces_csg_expression_test {

using traces::CsgExpression;

std::string error_of(const std::string& text, std::uint32_t objects = 3) {
    try {
        CsgExpression(text, objects);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

void expect_equal(const std::string& text, const std::function<bool(bool, bool, bool)>& expected) {
    const CsgExpression expression(text, 3);
    for (unsigned bits = 0; bits < 8; ++bits) {
        const bool a = (bits & 1U) != 0, b = (bits & 2U) != 0, c = (bits & 4U) != 0;
        EXPECT_EQ(expression({a, b, c}), expected(a, b, c)) << text << " with bits " << bits;
    }
}

TEST(CsgExpression, OperatorsAreThoseOfSets) {
    expect_equal("A", [](bool a, bool, bool) { return a; });
    expect_equal("!A", [](bool a, bool, bool) { return !a; });
    expect_equal("A & B", [](bool a, bool b, bool) { return a && b; });
    expect_equal("A|B", [](bool a, bool b, bool) { return a || b; });
    expect_equal("A ^ B", [](bool a, bool b, bool) { return a != b; });
    expect_equal("A - B", [](bool a, bool b, bool) { return a && !b; });
}

TEST(CsgExpression, DrawsAreLettersOrNumbers) {
    expect_equal("a & !b | c", [](bool a, bool b, bool c) { return (a && !b) || c; });
    expect_equal("0 & !1 | 2", [](bool a, bool b, bool c) { return (a && !b) || c; });
    EXPECT_TRUE(CsgExpression("27", 28)(std::vector<std::uint8_t>(28, 1)));
}

TEST(CsgExpression, OperatorsBindAsInC) {
    expect_equal("A | B ^ C", [](bool a, bool b, bool c) { return a || (b != c); });
    expect_equal("A ^ B & C", [](bool a, bool b, bool c) { return a != (b && c); });
    expect_equal("A & B - C", [](bool a, bool b, bool c) { return a && (b && !c); });
    expect_equal("A - B - C", [](bool a, bool b, bool c) { return a && !b && !c; });
    expect_equal("A - (B - C)", [](bool a, bool b, bool c) { return a && !(b && !c); });
    expect_equal("!(A | B) & !!C", [](bool a, bool b, bool c) { return !(a || b) && c; });
}

TEST(CsgExpression, MistakesAreNamedWithTheirColumn) {
    const std::string begin = "workload csg: expression: column ";
    EXPECT_EQ(error_of(""), begin + "1: expected a draw (letter or number), ! or (");
    EXPECT_EQ(error_of("A &"), begin + "4: expected a draw (letter or number), ! or (");
    EXPECT_EQ(error_of("A & * B"), begin + "5: expected a draw (letter or number), ! or (");
    EXPECT_EQ(error_of("A B"), begin + "3: expected an operator of | ^ & - or the end");
    EXPECT_EQ(error_of("(A | B"), begin + "7: expected an operator of | ^ & - or )");
    EXPECT_EQ(error_of("A)"), begin + "2: expected an operator of | ^ & - or the end");
    EXPECT_EQ(error_of("A & D"),
              begin + "5: expected a draw of the scene, which has 3 (A or 0 is the first), but D is none");
    EXPECT_EQ(error_of("A - 99999999999999999999"),
              begin + "5: expected a draw of the scene, which has 3 (A or 0 is the first), but 99999999999999999999 is "
                      "none");
}

TEST(CsgExpression, NestingIsBoundedAndLengthIsNot) {
    EXPECT_EQ(error_of(std::string(200, '!') + "A"), "workload csg: expression: column 201: expected at most 200 "
                                                     "parentheses and ! within each other");
    EXPECT_EQ(error_of(std::string(199, '!') + "A"), "");
    EXPECT_NE(error_of(std::string(1'000'000, '(')), "");
    std::string sum = "A";
    for (int i = 0; i < 100'000; ++i) sum += "|B";
    EXPECT_TRUE(CsgExpression(sum, 2)({0, 1}));
}

} // namespace traces_csg_expression_test
