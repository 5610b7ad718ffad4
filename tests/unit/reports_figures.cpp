// How a number is read off a curve, and how it is compared with what was published.
#include "reports/geometry/figures.hpp"
#include "reports/geometry/text.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace reports_figures_test {

using reports::CurveReading;
using reports::ValidationRow;

constexpr double infinity = std::numeric_limits<double>::infinity();

ValidationRow row_between(double low, double high, double model) {
    ValidationRow row;
    row.gpu = "g70";
    row.low = low;
    row.high = high;
    row.model = model;
    return row;
}

TEST(Figures, EveryReadingOfACurve) {
    const std::vector<double> x{1, 10, 100, 1000}, y{4, 6, 3, 2};
    EXPECT_EQ(reports::read_curve(CurveReading::argmax, x, y), 10);
    EXPECT_EQ(reports::read_curve(CurveReading::least, x, y), 2);
    EXPECT_EQ(reports::read_curve(CurveReading::first_over_last, x, y), 2);
    EXPECT_EQ(reports::read_curve(CurveReading::least_growth, x, y), 0.5);
    EXPECT_EQ(reports::read_curve(CurveReading::greatest_growth, x, y), 1.5);
    EXPECT_EQ(reports::read_curve(CurveReading::value, {1}, {4}), 4);
    EXPECT_EQ(reports::read_curve(CurveReading::argmax, {1, 2, 3}, {5, 5, 5}), 1); // the first of equals
}

TEST(Figures, AModelInsideAnIntervalHasNoError) {
    for (const double model : {500.0, 700.0, 1000.0}) {
        EXPECT_EQ(row_between(500, 1000, model).ratio(), 1) << model;
        EXPECT_EQ(row_between(500, 1000, model).log_error(), 0) << model;
    }
    EXPECT_EQ(row_between(500, 1000, 2000).ratio(), 2);
    EXPECT_EQ(row_between(500, 1000, 2000).published(), 1000);
    EXPECT_EQ(row_between(500, 1000, 250).ratio(), 0.5);
    EXPECT_EQ(row_between(1, infinity, 1e9).log_error(), 0);
    EXPECT_NEAR(row_between(1, infinity, 0.5).log_error(), -std::log(2), 1e-15);
    EXPECT_EQ(row_between(4, 4, 5).ratio(), 1.25);
}

TEST(Figures, IntervalsAsText) {
    EXPECT_EQ(reports::published_text(row_between(4.44, 4.44, 1)), "4.44");
    EXPECT_EQ(reports::published_text(row_between(500, 1000, 1)), "500 to 1000");
    EXPECT_EQ(reports::published_text(row_between(1, infinity, 1)), "at least 1.00");
    EXPECT_EQ(reports::published_text(row_between(0, 1, 1)), "at most 1.00");
}

} // namespace reports_figures_test
