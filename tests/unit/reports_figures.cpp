// How a number is read off a curve, and how it is compared with what was published.
#include "reports/geometry/figures.hpp"
#include "reports/geometry/text.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace {

using reports::CurveReading;
using reports::PublishedOrigin;
using reports::RowStatus;
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

} // namespace

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

TEST(Figures, AModelInsideAnIntervalHasARatioOfOne) {
    for (const double model : {500.0, 700.0, 1000.0}) {
        EXPECT_EQ(row_between(500, 1000, model).ratio(), 1) << model;
        EXPECT_EQ(row_between(500, 1000, model).error(), 0) << model;
    }
    EXPECT_EQ(row_between(500, 1000, 2000).ratio(), 2);
    EXPECT_EQ(row_between(500, 1000, 2000).published(), 1000);
    EXPECT_EQ(row_between(500, 1000, 250).ratio(), 0.5);
    EXPECT_EQ(row_between(1, infinity, 1e9).error(), 0);
    EXPECT_EQ(row_between(1, infinity, 0.5).error(), 0.5);
    EXPECT_EQ(row_between(4, 4, 5).ratio(), 1.25);
}

TEST(Figures, IntervalsAsText) {
    EXPECT_EQ(reports::published_text(row_between(4.44, 4.44, 1)), "4.44");
    EXPECT_EQ(reports::published_text(row_between(500, 1000, 1)), "500 to 1000");
    EXPECT_EQ(reports::published_text(row_between(1, infinity, 1)), "at least 1.00");
    EXPECT_EQ(reports::published_text(row_between(0, 1, 1)), "at most 1.00");
}

TEST(Figures, NumbersThatWereNotMeasuredAreCountedApart) {
    std::vector<ValidationRow> rows{row_between(10, 10, 11), row_between(10, 10, 13), row_between(10, 10, 10),
                                    row_between(10, 10, 30)};
    rows[2].origin = PublishedOrigin::derived;
    rows[3].status = RowStatus::calibrated;
    rows[1].table = "T", rows[1].row = "r";
    const auto summary = reports::summarise(rows);
    ASSERT_EQ(summary.size(), 2U); // the GPU, and all
    EXPECT_EQ(summary[0].predicted.rows, 3U);
    EXPECT_NEAR(summary[0].predicted.median, 0.1, 1e-12);
    EXPECT_NEAR(summary[0].predicted.worst, 0.3, 1e-12);
    EXPECT_EQ(summary[0].predicted.worst_row, "T r");
    EXPECT_EQ(summary[1].predicted.worst_row, "T r on g70");
    EXPECT_EQ(summary[0].measured.rows, 2U);
    EXPECT_NEAR(summary[0].measured.median, 0.2, 1e-12);
}
