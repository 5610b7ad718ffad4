// The arithmetic of the table of predictions, and that it can say no.
#include "sim/config.hpp"
#include "tests/physics/expression.hpp"

#include <gtest/gtest.h>

namespace physics {
namespace {

double value_of(std::string_view name) {
    if (name == "a.cycles") return 100;
    if (name == "s_1.x") return 10;
    if (name == "s_2.x") return 9.9;
    if (name == "s_3.x") return 12;
    throw sim::InputError("no value");
}

std::vector<std::string> series_of(const std::string& prefix) {
    return prefix == "s_" ? std::vector<std::string>{"s_1", "s_2", "s_3"} : std::vector<std::string>{};
}

bool holds(const std::string& text) { return judge(text, value_of, series_of).holds; }

TEST(PredictionExpression, Arithmetic) {
    EXPECT_EQ(evaluate("1 + 2 * 3 - 8 / 4", value_of), 5);
    EXPECT_EQ(evaluate("(1 + 2) * -a.cycles", value_of), -300);
    EXPECT_EQ(evaluate("max(1, min(a.cycles, 7)) + abs(2 - 5)", value_of), 10);
    EXPECT_EQ(evaluate("or_zero(a.bytes.dram_copy.bytes)", value_of), 0);
}

TEST(PredictionExpression, Relations) {
    EXPECT_TRUE(holds("a.cycles == 102 within 0.02"));
    EXPECT_FALSE(holds("a.cycles == 103 within 0.02"));
    EXPECT_FALSE(holds("a.cycles < 100"));
    EXPECT_TRUE(holds("a.cycles <= 100"));
    EXPECT_TRUE(holds("s_*.x rises within 0.02"));
    EXPECT_FALSE(holds("s_*.x rises"));
    EXPECT_FALSE(holds("s_*.x falls within 0.5"));
    EXPECT_TRUE(holds("s_*.x does not rise within 0.3"));
}

TEST(PredictionExpression, ErrorsRepeatTheText) {
    for (const char* text : {"1 + ", "a.cycles", "b.cycles < 1", "or_zero(a.cycles) < 1", "sqrt(2) > 1", "1 < 2 3",
                             "s_*.x jumps", "t_*.x rises"})
        EXPECT_THROW(
            {
                if (!holds(text)) throw sim::InputError("does not hold");
            },
            sim::InputError)
            << text;
}

} // namespace
} // namespace physics
