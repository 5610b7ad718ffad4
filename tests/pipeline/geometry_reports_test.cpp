// What is reported of the geometry feed: published rows and the plan of their use, studies, advice.
#include "models/gpu_library.hpp"
#include "reports/geometry/advice.hpp"
#include "reports/geometry/calibration.hpp"
#include "reports/geometry/json.hpp"
#include "reports/study.hpp"
#include "tests/support/program_run.hpp"

#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <set>

namespace {

using reports::CalibrationKind;
using reports::Fidelity;

reports::GeometryRunOptions quick() {
    reports::GeometryRunOptions options;
    options.fidelity = Fidelity::estimate;
    return options;
}

} // namespace

TEST(GeometryReports, EveryRowOfThePublishedTablesIsThere) {
    std::map<std::string, std::size_t> rows;
    for (const reports::PublishedRow& row : reports::load_published_geometry()) rows[row.table] += row.fps.size();
    EXPECT_EQ(rows, (std::map<std::string, std::size_t>{{"T3.1", 16}, {"T3.2", 8}, {"T3.3", 8}, {"T3.4", 20}}));
}

TEST(GeometryReports, CalibratedNumbersOfGpuFilesAreThoseOfThePlan) {
    const reports::CalibrationPlan plan = reports::load_calibration_plan();
    const auto rows = reports::load_published_geometry();
    std::map<std::string, std::set<std::string>> planned;
    for (const reports::CalibrationStep& step : plan.steps) {
        planned[step.gpu].insert(step.parameter);
        for (const std::string& row : reports::rows_in(step.row))
            EXPECT_TRUE(reports::find_row(rows, row).fps.contains(step.gpu)) << step.parameter;
        for (const std::string& alternative : step.alternatives)
            for (const std::string& row : reports::rows_in(alternative)) EXPECT_NO_THROW(reports::find_row(rows, row));
        EXPECT_FALSE(step.reason.empty()) << step.parameter;
    }
    for (const reports::ScaledParameter& rule : plan.scaled) planned[rule.gpu].insert(rule.parameter);
    for (const auto& [gpu, parameters] : planned) {
        const sim::Config config = models::load_gpu(gpu);
        std::set<std::string> calibrated;
        for (const auto& [path, origin] : config.origins())
            if (origin.origin == "calibrated") calibrated.insert(path);
        // A GPU with a base also has what that was calibrated to.
        for (const std::string& parameter : parameters) EXPECT_TRUE(calibrated.contains(parameter)) << gpu << parameter;
        if (models::base_of(gpu) == "neutral") {
            EXPECT_EQ(calibrated, parameters) << gpu;
        }
    }
}

TEST(GeometryReports, CalibrationFindsTheNumbersOfTheFile) {
    const auto found = reports::calibrate_geometry({"rv350"}, quick());
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(found[0].numbers.size(), 3U);
    for (const reports::CalibratedNumber& number : found[0].numbers) {
        EXPECT_NEAR(number.value / number.in_file, 1.0, 0.02) << number.step.parameter;
        EXPECT_NEAR(number.model / number.published, 1.0, 0.002) << number.step.parameter;
    }
}

TEST(GeometryReports, CalibrationIsWrittenIntoItsLinesOnly) {
    const ropsim_test::TemporaryFolder folder;
    ropsim_test::write_text(folder.path() / "x.toml",
                            "base = \"neutral\"\n\n[host]\nlist_ns = { value = 1.0 }\n# kept\n");
    reports::GpuCalibration calibration{"x", {}, {}, 1};
    const auto found = [](std::string parameter, double value) {
        reports::CalibratedNumber number;
        number.step.parameter = std::move(parameter);
        number.value = value;
        return number;
    };
    calibration.numbers = {found("host.list_ns", 2.5), found("host.convert.normal.s8_ns", 31)};
    reports::write_calibration({calibration}, folder.path().string());
    std::ifstream file(folder.path() / "x.toml");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_NE(text.find("list_ns = { value = 2.5, origin = \"calibrated\""), std::string::npos) << text;
    EXPECT_NE(text.find("# kept"), std::string::npos) << text;
    EXPECT_NE(text.find("[host.convert.normal]\ns8_ns = { value = 31.0,"), std::string::npos) << text;
}

TEST(GeometryReportsLong, PredictedRowsAreWithinTenPercentAtTheMedian) {
    reports::GeometryRunOptions options;
    options.threads = 2;
    const reports::GeometryValidation validation = reports::validate_geometry({}, options);
    EXPECT_EQ(validation.rows.size(), 52U);
    for (const reports::ValidationRow& row : validation.rows) {
        if (row.status == reports::RowStatus::calibrated) {
            EXPECT_LE(row.error(), 0.03) << row.table << row.row << row.gpu << row.model;
        }
        if (row.status == reports::RowStatus::predicted && row.error() > reports::large_miss) {
            EXPECT_FALSE(row.explanation.empty()) << row.table << row.row << row.gpu << row.model;
        }
    }
    ASSERT_EQ(validation.summary.back().gpu, "all");
    EXPECT_GE(validation.summary.back().predicted, 20U);
    EXPECT_LE(validation.summary.back().median, 0.10);
}

TEST(GeometryReports, EveryStudyCanBeRead) {
    EXPECT_GE(reports::study_names().size(), 9U);
    for (const std::string& name : reports::study_names()) {
        const reports::Study study = reports::load_study(name);
        EXPECT_FALSE(study.question.empty()) << name;
        EXPECT_FALSE(study.points.empty()) << name;
    }
}

TEST(GeometryReports, StudyFillsInItsVariables) {
    const ropsim_test::TemporaryFolder folder;
    const auto path = folder.path() / "mine.toml";
    ropsim_test::write_text(path, R"(title = "t"
question = "q"
gpus = ["neutral", "g70"]
x = "blades"
measure = "acmr"
points = [ { x = 10 }, { x = 20, entries = 3 } ]
[[series]]
name = "grass"
scene = "gen:grass?blades={x}"
)");
    const reports::StudyResult result = reports::run_study(reports::load_study(path.string()), {}, quick());
    ASSERT_EQ(result.values.size(), 4U);
    for (const reports::StudyValue& value : result.values) EXPECT_NEAR(value.measure, 1.4, 1e-9);
    EXPECT_EQ(result.values[1].gpu, "g70");
    EXPECT_EQ(result.values[2].x, "20");
    ropsim_test::write_text(path, "title = \"t\"\nquestion = \"q\"\nx = \"n\"\npoints = [ { x = 1 } ]\n[[series]]\n"
                                  "name = \"s\"\nscene = \"gen:grass?blades={n}\"\n");
    EXPECT_THROW(reports::run_study(reports::load_study(path.string()), {}, quick()), sim::InputError);
}

TEST(GeometryReports, AdviceTriesEveryPreparationAndNamesTheBest) {
    reports::GeometryRequest request;
    request.experiment.scene = "gen:blob?triangles=20000&order=random";
    request.gpu = "g70";
    const reports::GeometryAdvice advice = reports::advise(request, quick());
    EXPECT_EQ(advice.cases.front().name, "as it is");
    EXPECT_EQ(advice.cases.size(), 8U);
    EXPECT_NEAR(advice.cases.front().measure.acmr, 3.0, 0.05);
    EXPECT_GT(advice.best(), 0U);
    EXPECT_LT(advice.cases[advice.best()].measure.acmr, 0.8);
    EXPECT_NE(advice.recommendation().find(advice.cases[advice.best()].name), std::string::npos);
    for (const reports::GeometryCase& one : advice.cases) EXPECT_EQ(one.measure.triangles, 20'000U) << one.name;
    EXPECT_EQ(reports::advice_json(advice).at("cases").size(), 8U);
}
