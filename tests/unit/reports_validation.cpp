// Errors of published numbers: signed logarithms, sigmas, what is counted, null models, skill.
#include "reports/validation/choices.hpp"
#include "reports/validation/error_report.hpp"
#include "reports/validation/null_models.hpp"
#include "reports/validation/printed_number.hpp"
#include "sim/check.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using reports::ErrorSpread;
using reports::PublishedOrigin;
using reports::RowStatus;
using reports::ValidationRow;

ValidationRow row_of(const std::string& name, double published, double model, RowStatus status = RowStatus::predicted) {
    ValidationRow row;
    row.table = "T";
    row.row = name;
    row.gpu = "g";
    row.low = row.high = published;
    row.sigma = 0.01;
    row.model = model;
    row.status = status;
    return row;
}

} // namespace

TEST(Validation, PHY_P7_TheLastDigitSaysHowFarANumberWasRounded) {
    EXPECT_DOUBLE_EQ(reports::printed_number("41.4", "t").half_digit, 0.05);
    EXPECT_DOUBLE_EQ(reports::printed_number("139", "t").half_digit, 0.5);
    EXPECT_DOUBLE_EQ(reports::printed_number("0.80", "t").half_digit, 0.005);
    EXPECT_DOUBLE_EQ(reports::printed_number("0.2", "t").sigma(), 0.25);
    for (const char* text : {"x", "0", "-1", "", "4.1e1", "1.5 ", "inf", "nan"})
        EXPECT_THROW(reports::printed_number(text, "t"), sim::InputError) << text;
}

TEST(Validation, PHY_P7_ErrorsAreSignedLogarithmsToTheNominalValue) {
    ValidationRow row = row_of("a", 0.1, 0.14);
    row.sigma = 0.5;
    EXPECT_NEAR(row.log_error(), std::log(1.4), 1e-15); // within the range of rounding, and an error all the same
    EXPECT_NEAR(row.error_in_sigma(), 2 * std::log(1.4), 1e-15);
    EXPECT_FALSE(row.sharp());
    EXPECT_NEAR(row_of("a", 10, 5).log_error(), -row_of("a", 10, 20).log_error(), 1e-15);
    row.sigma = 0.05;
    EXPECT_TRUE(row.sharp());
    row.sigma = 0; // a statement
    EXPECT_FALSE(row.sharp());
    EXPECT_EQ(row.error_in_sigma(), 0);
    EXPECT_EQ(reports::error_in_sigma_text(row), "");
    EXPECT_TRUE(row_of("a", 10, 10 / 1.26).missed());
    EXPECT_FALSE(row_of("a", 10, 10 / 1.24).missed());
}

TEST(Validation, OnlyPredictedRowsAreCountedAndSharpOnesApart) {
    const double e = std::exp(1);
    std::vector<ValidationRow> rows{row_of("a", 1, e), row_of("b", 1, 1 / (e * e)),
                                    row_of("c", 1, 50, RowStatus::derived), row_of("d", 1, 50, RowStatus::penalty),
                                    row_of("e", 1, e, RowStatus::calibrated)};
    rows[1].sigma = 0.2;
    const auto summary = reports::summarise(rows);
    ASSERT_EQ(summary.size(), 2U); // the GPU, and all
    const ErrorSpread &all = summary[0].predicted, &sharp = summary[0].sharp;
    EXPECT_EQ(all.rows, 2U);
    EXPECT_NEAR(all.median, 1.5, 1e-12);
    EXPECT_NEAR(all.rms, std::sqrt(2.5), 1e-12);
    EXPECT_NEAR(all.mean, -0.5, 1e-12);
    EXPECT_NEAR(all.worst, 2, 1e-12);
    EXPECT_EQ(all.worst_row, "T b");
    EXPECT_EQ(summary[1].predicted.worst_row, "T b on g");
    EXPECT_FALSE(all.skill()); // no null model said anything
    EXPECT_EQ(sharp.rows, 1U);
    EXPECT_NEAR(sharp.worst, 1, 1e-12);
    EXPECT_EQ(summary[0].fitted.rows, 1U);
    EXPECT_EQ(reports::error_spread("g", {}).rows, 0U);
}

TEST(Validation, SkillComparesWithTheNullModelOnTheSameRows) {
    std::vector<ValidationRow> rows{row_of("a", 1, std::exp(0.1)), row_of("b", 1, std::exp(-0.1))};
    for (ValidationRow& row : rows) row.null_model = std::exp(0.4);
    const auto spread = reports::summarise(rows).front().predicted;
    ASSERT_TRUE(spread.skill());
    EXPECT_NEAR(*spread.null_rms, 0.4, 1e-12);
    EXPECT_NEAR(*spread.skill(), 0.75, 1e-12);
    for (ValidationRow& row : rows) row.status = RowStatus::calibrated;
    EXPECT_FALSE(reports::summarise(rows).front().fitted.skill()); // the null model was fitted to them, too
    for (ValidationRow& row : rows) row.status = RowStatus::predicted;
    rows[1].null_model = 0;
    EXPECT_FALSE(reports::summarise(rows).front().predicted.skill());
}

TEST(Validation, PHY_P8_TheNullModelOfGeometryIsTheMeanOfTheCardsCalibratedRows) {
    std::vector<ValidationRow> rows{row_of("a", 2, 1, RowStatus::calibrated), row_of("b", 8, 1, RowStatus::calibrated),
                                    row_of("c", 1000, 1, RowStatus::penalty), row_of("d", 5, 1)};
    rows.push_back(row_of("e", 3, 1));
    rows.back().gpu = "other"; // without calibrated rows
    rows.push_back(row_of("f", 3, 1, RowStatus::calibrated));
    rows.back().origin = PublishedOrigin::derived; // printed nowhere
    reports::apply_geometry_null_model(rows);
    EXPECT_NEAR(rows[3].null_model, 4, 1e-12);
    EXPECT_NEAR(rows[2].null_model, 4, 1e-12);
    EXPECT_EQ(rows[4].null_model, 0);
    EXPECT_EQ(rows[5].null_model, 0);
}

TEST(Validation, PHY_P7_TheNullModelOfPeelingIsOneNumberAMesh) {
    std::vector<ValidationRow> rows{row_of("MP", 10, 1, RowStatus::calibrated), row_of("SP", 36, 1),
                                    row_of("MP 16", 2.4, 1), row_of("SPwH", 3, 1, RowStatus::calibrated),
                                    row_of("SP/MP", 3.6, 1, RowStatus::derived)};
    reports::apply_peeling_null_model(rows, {{"m", 4, 0}, {"m", 1, 0}, {"m", 16, 0}, {"m", 0, 1000}, {"m", 0, 0}});
    EXPECT_NEAR(rows[0].null_model, 10, 1e-12);
    EXPECT_NEAR(rows[1].null_model, 40, 1e-12);
    EXPECT_NEAR(rows[2].null_model, 2.5, 1e-12);
    EXPECT_NEAR(rows[3].null_model, 1e6 / 12.6 / 1000, 1e-9); // has no part in the number of the mesh
    EXPECT_EQ(rows[4].null_model, 0);
}

TEST(Validation, AChoiceMakesARowCalibratedAndLeavesOtherStatesAlone) {
    reports::Choice choice;
    choice.what = "x = 1";
    choice.gpus = {"g"};
    choice.rows = {"T a", "T b"};
    ValidationRow a = row_of("a", 1, 1), b = row_of("b", 1, 1, RowStatus::penalty), c = row_of("c", 1, 1);
    b.parameter = "its own";
    for (ValidationRow* row : {&a, &b, &c}) reports::apply_choices(*row, {choice});
    EXPECT_EQ(a.status, RowStatus::calibrated);
    EXPECT_EQ(a.parameter, "x = 1");
    EXPECT_EQ(b.status, RowStatus::penalty);
    EXPECT_EQ(b.parameter, "its own");
    EXPECT_EQ(c.status, RowStatus::predicted);
    a = row_of("a", 1, 1);
    a.gpu = "other";
    reports::apply_choices(a, {choice});
    EXPECT_EQ(a.status, RowStatus::predicted);
    choice.penalty = true;
    a.gpu = "g";
    reports::apply_choices(a, {choice});
    EXPECT_EQ(a.status, RowStatus::penalty);
}

TEST(Validation, SummariesSayTheSameToPeopleAndPrograms) {
    std::vector<ValidationRow> rows{row_of("a", 1, std::exp(0.1)), row_of("b", 1, std::exp(-0.3))};
    for (ValidationRow& row : rows) row.null_model = std::exp(0.5);
    const auto summary = reports::summarise(rows).back();
    const auto json = reports::error_summary_json(summary);
    EXPECT_EQ(json.at("predicted_rows"), 2);
    EXPECT_NEAR(json.at("median_predicted_error").get<double>(), 0.2, 1e-12);
    EXPECT_NEAR(json.at("worst_predicted_error").get<double>(), 0.3, 1e-12);
    EXPECT_NEAR(json.at("rms_predicted_error").get<double>(), std::sqrt(0.05), 1e-12);
    EXPECT_NEAR(json.at("skill").get<double>(), 1 - std::sqrt(0.05) / 0.5, 1e-12);
    EXPECT_EQ(json.at("sharp").at("predicted_rows"), 2);
    const std::string text = reports::error_sentences(summary);
    for (const char* part : {"2 predicted numbers", "0.200 in the median", "0.224 RMS", "T b on g", "skill +0.55"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(reports::error_sentences({}), "No row is predicted.");
    const auto one = reports::validation_row_json(rows[1]);
    EXPECT_NEAR(one.at("log_error").get<double>(), -0.3, 1e-12);
    EXPECT_NEAR(one.at("error_in_sigma").get<double>(), -30, 1e-9);
    EXPECT_EQ(reports::validation_cells(rows[0]).size(), reports::validation_columns().size());
}
