// What is reported of the geometry feed: published rows and the plan of their use, studies, advice.
#include "models/gpu_library.hpp"
#include "reports/geometry/advice.hpp"
#include "reports/geometry/calibration.hpp"
#include "reports/geometry/figures.hpp"
#include "reports/geometry/folds.hpp"
#include "reports/geometry/json.hpp"
#include "reports/geometry/page.hpp"
#include "reports/geometry/solver.hpp"
#include "reports/geometry/tables.hpp"
#include "reports/geometry/text.hpp"
#include "reports/study.hpp"
#include "tests/support/program_run.hpp"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

namespace geometry_reports_test {

using reports::CalibrationKind;
using reports::Fidelity;

reports::GeometryRunOptions quick() {
    reports::GeometryRunOptions options;
    options.fidelity = Fidelity::estimate;
    return options;
}

TEST(GeometryReports, EveryRowOfThePublishedTablesIsThere) {
    std::map<std::string, std::size_t> rows;
    for (const reports::PublishedRow& row : reports::load_published_geometry()) rows[row.table] += row.fps.size();
    EXPECT_EQ(rows, (std::map<std::string, std::size_t>{{"T3.1", 16}, {"T3.2", 8}, {"T3.3", 8}, {"T3.4", 20}}));
}

TEST(GeometryReports, EveryStatementOfThePublishedFiguresIsThere) {
    std::map<std::string, std::size_t> rows;
    for (const reports::PublishedFigure& figure : reports::load_published_figures()) {
        rows[figure.table] += figure.by_gpu.size();
        EXPECT_NE(figure.origin, reports::PublishedOrigin::measured) << figure.key();
        EXPECT_FALSE(figure.source.empty()) << figure.key();
    }
    EXPECT_EQ(rows, (std::map<std::string, std::size_t>{{"F3.1", 7}, {"F3.2", 7}, {"F3.3", 10}}));
}

TEST(GeometryReports, RowsThatSayNothingNewAreRowsAndSayWhy) {
    std::set<std::pair<std::string, std::string>> rows;
    for (const reports::PublishedRow& row : reports::load_published_geometry())
        for (const auto& [gpu, fps] : row.fps) rows.emplace(gpu, row.key());
    for (const reports::PublishedFigure& figure : reports::load_published_figures())
        for (const auto& [gpu, interval] : figure.by_gpu) rows.emplace(gpu, figure.key());
    const reports::CalibrationPlan plan = reports::load_calibration_plan();
    EXPECT_GE(plan.shared.size(), 4U);
    for (const reports::SharedNumber& number : plan.shared) {
        EXPECT_TRUE(rows.contains({number.gpu, number.row})) << number.gpu << " " << number.row;
        EXPECT_FALSE(number.reason.empty()) << number.gpu << " " << number.row;
        EXPECT_TRUE(models::load_gpu(number.gpu).origins().contains(number.parameter)) << number.parameter;
    }
}

TEST(GeometryReports, PHY_P8_ChoicesNameRowsThatExistAndValuesThatHold) {
    std::set<std::pair<std::string, std::string>> rows;
    for (const reports::PublishedRow& row : reports::load_published_geometry())
        for (const auto& [gpu, fps] : row.fps) rows.emplace(gpu, row.key());
    for (const reports::PublishedFigure& figure : reports::load_published_figures())
        for (const auto& [gpu, interval] : figure.by_gpu) rows.emplace(gpu, figure.key());
    const auto choices = reports::load_choices("geometry");
    EXPECT_GE(choices.size(), 7U);
    for (const reports::Choice& one : choices) {
        EXPECT_FALSE(one.reason.empty()) << one.what;
        for (const std::string& gpu : one.gpus) {
            for (const std::string& row : one.rows) EXPECT_TRUE(rows.contains({gpu, row})) << gpu << " " << row;
            if (one.parameter.empty()) continue;
            EXPECT_DOUBLE_EQ(reports::value_of(reports::gpu_params(gpu), one.parameter), one.value) << one.what;
        }
    }
}

// The rows that P8 names: they were in view when something was chosen, so they are not counted.
TEST(GeometryReports, PHY_P8_RowsThatWereInViewCountAsCalibrated) {
    const reports::CalibrationPlan plan = reports::load_calibration_plan();
    std::map<std::string, std::set<std::string>> predicted;
    for (const reports::PublishedRow& published : reports::load_published_geometry())
        for (const auto& [gpu, fps] : published.fps) {
            reports::ValidationRow row = reports::published_row(published, gpu);
            reports::apply_plan(row, plan);
            if (row.status == reports::RowStatus::predicted) predicted[gpu].insert(row.key());
        }
    for (const std::string gpu : {"g70", "r420"})
        for (const std::string layout : {"T3.2 OpenCCL, 32 bit", "T3.2 OpenCCL, 16 bit"})
            EXPECT_FALSE(predicted[gpu].contains(layout)) << gpu << layout;
    EXPECT_EQ(predicted["r420"], (std::set<std::string>{"T3.1 buffers", "T3.3 Happy, FLOAT", "T3.4 none"}));
    EXPECT_EQ(predicted["g70"].size(), 8U);
    EXPECT_EQ(predicted["nv43"], std::set<std::string>{"T3.1 buffers"});
    EXPECT_EQ(predicted["rv350"], std::set<std::string>{"T3.1 buffers"});
}

namespace {

/// Rows of figures on a GPU, by figure and row: those that begin so.
std::map<std::string, reports::ValidationRow> figures_of(const std::string& gpu, const std::string& begin) {
    reports::GeometryRunOptions options = quick();
    options.threads = 2;
    std::vector<reports::PublishedFigure> figures = reports::load_published_figures();
    std::erase_if(figures, [&begin](const auto& figure) { return !figure.key().starts_with(begin); });
    std::map<std::string, reports::ValidationRow> rows;
    for (const auto& row : reports::validate_figures(figures, reports::load_calibration_plan(), {gpu}, options))
        rows[row.key()] = row;
    return rows;
}

double frames_per_second(const std::string& gpu, const std::string& key) {
    const auto rows = reports::load_published_geometry();
    const pipeline::GpuParams params = reports::gpu_params(gpu);
    const auto frame = reports::prepare_frame(reports::find_row(rows, key).experiment, params).frame;
    return reports::run_geometry(params, *frame, Fidelity::estimate).frames_per_second();
}

} // namespace

TEST(GeometryReportsLong, G2AndG4FiguresAreReadOffTheCurvesOfTheModel) {
    for (const std::string gpu : {"g70", "r420"}) {
        const auto throughput = figures_of(gpu, "F3.1"), batches = figures_of(gpu, "F3.2");
        // One draw of 0.7M vertices is the same in both figures and in T3.4.
        const double alone = frames_per_second(gpu, "T3.4 none");
        EXPECT_DOUBLE_EQ(throughput.at("F3.1 0.7M vertices").model, alone) << gpu;
        EXPECT_DOUBLE_EQ(batches.at("F3.2 one draw call").model, alone) << gpu;
        EXPECT_NEAR(throughput.at("F3.1 vertices/s of 0.1M over 0.95M").model, 1.0, 0.03) << gpu;
        EXPECT_EQ(batches.at("F3.2 best number of draw calls").log_error(), 0) << gpu;
        EXPECT_LT(batches.at("F3.2 largest ratio of a step, from 1,000 draw calls on").model, 1) << gpu;
    }
}

TEST(GeometryReports, G8ColdBytesAreThoseOfTheLinesOfARecord) {
    for (const std::string gpu : {"g70", "r420"}) {
        const auto rows = figures_of(gpu, "F3.3 bytes");
        for (const auto& [n, ratio] : {std::pair{"1", 1.55}, std::pair{"4", 2.41}, std::pair{"8", 2.92}})
            EXPECT_NEAR(rows.at(std::string("F3.3 bytes saved, cold and random, n = ") + n).model, ratio, 0.1 * ratio)
                << gpu;
    }
}

TEST(GeometryReportsLong, G8InterleavedIsFasterForEveryNumberOfAttributesAndGainsWithIt) {
    for (const std::string gpu : {"g70", "r420"}) {
        const auto rows = figures_of(gpu, "F3.3 least");
        EXPECT_GT(rows.at("F3.3 least gain for n = 1 to 8").model, 1) << gpu;
        // Estimated; in detail r420, where memory limits, falls by 1% from n = 6 to 7.
        EXPECT_GT(rows.at("F3.3 least growth of the gain with n").model, 1) << gpu;
    }
}

TEST(GeometryReports, G3LongTheDropOfTheFigureIsAPenaltyAndTheX800HasNone) {
    const auto g70 = figures_of("g70", "F3.1"), r420 = figures_of("r420", "F3.1");
    const std::string drop = "F3.1 vertices/s of 0.7M over 2.1M, normals";
    EXPECT_NEAR(g70.at(drop).model, 4.44, 0.444);
    EXPECT_EQ(g70.at(drop).status, reports::RowStatus::penalty);
    EXPECT_EQ(g70.at(drop).parameter, "host.overflow_slowdown");
    EXPECT_NEAR(r420.at(drop).model, 1.0, 0.1);
    EXPECT_EQ(r420.at(drop).status, reports::RowStatus::derived); // a quotient of printed numbers is not counted
    EXPECT_NEAR(g70.at("F3.1 vertices/s of 0.7M over 2.1M, without indices").model, 1.0, 0.03);
}

TEST(GeometryReports, RowsOfFiguresAreWrittenLikeThoseOfTables) {
    reports::ValidationRow row;
    row.table = "F3.2";
    row.row = "best number of draw calls";
    row.gpu = "g70";
    row.unit = "draw calls";
    row.low = 500;
    row.high = 1000;
    row.model = 2000;
    row.origin = reports::PublishedOrigin::stated;
    reports::apply_plan(row, {});
    row.source = "words";
    reports::GeometryValidation validation{{row}, reports::summarise({row}), Fidelity::estimate};
    const auto json = reports::validation_json(validation, {}).at("rows").at(0);
    EXPECT_EQ(json.at("published"), 1000); // what is nearest to the model
    EXPECT_EQ(json.at("ratio"), 2);
    EXPECT_EQ(json.at("published_least"), 500);
    EXPECT_EQ(json.at("origin"), "stated");
    const std::string text = reports::validation_text(validation, {});
    EXPECT_NE(text.find("500 to 1000"), std::string::npos) << text;
    EXPECT_NE(text.find("F3.2 best number of draw calls on g70 (derived): not explained"), std::string::npos) << text;
    const std::string csv = reports::validation_tables(validation, {}).front().text();
    EXPECT_NE(
        csv.find("best number of draw calls,g70,draw calls,1000,500,1000,,2000,2,0.693147,,,derived,stated,words"),
        std::string::npos)
        << csv;
    EXPECT_NE(reports::validation_page(validation, {}).find("500 to 1000"), std::string::npos);
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

TEST(GeometryReports, LongCalibrationFindsTheNumbersOfTheFile) {
    const auto found = reports::calibrate_geometry({"rv350"}, quick());
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(found[0].numbers.size(), 3U);
    for (const reports::CalibratedNumber& number : found[0].numbers) {
        EXPECT_NEAR(number.value / number.in_file, 1.0, 0.02) << number.step.parameter;
        EXPECT_NEAR(number.model / number.published, 1.0, 0.002) << number.step.parameter;
    }
}

// Each of its three numbers is the only one of its row: left out, nothing says what that row takes.
TEST(GeometryReportsLong, PHY_P8_FoldsSayWhichRowsAreNotTestable) {
    const auto cards = reports::fold_geometry({"rv350"}, 4, 1, quick());
    ASSERT_EQ(cards.size(), 1U);
    std::set<std::string> testable, untestable;
    for (const reports::HeldOutRow& held : cards[0].rows)
        (held.testable() ? testable : untestable).insert(held.row.key());
    EXPECT_EQ(testable, std::set<std::string>{"T3.1 buffers"});
    EXPECT_EQ(untestable, (std::set<std::string>{"T3.1 display list", "T3.1 immediate", "T3.1 vertex arrays"}));
    EXPECT_EQ(cards[0].held_out.rows, 1U);
    for (const auto& [number, value] : cards[0].whole.values) {
        const double in_file = reports::value_of(reports::gpu_params("rv350"), number);
        EXPECT_NEAR(value / in_file, 1, 0.02) << number; // three rows, three numbers: the fit is the plan's
    }
    EXPECT_THROW(reports::fold_geometry({"g80"}, 4, 1, quick()), sim::InputError);
}

TEST(GeometryReports, CalibrationIsWrittenIntoItsLinesOnly) {
    const ropsim_test::TemporaryFolder folder;
    ropsim_test::write_text(folder.path() / "x.toml",
                            "base = \"neutral\"\n\n[host]\nlist_ns = { value = 1.0 }\n# kept\n");
    reports::GpuCalibration calibration;
    calibration.gpu = "x";
    calibration.command = "ropsim calibrate that";
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
    EXPECT_NE(text.find("; ropsim calibrate that\""), std::string::npos) << text;
    EXPECT_NE(text.find("[host.convert.normal]\ns8_ns = { value = 31.0,"), std::string::npos) << text;
}

TEST(GeometryReportsLong, PredictedRowsAreWithinTenPercentAtTheMedian) {
    reports::GeometryRunOptions options;
    options.threads = 2;
    const reports::GeometryValidation validation = reports::validate_geometry({}, options);
    EXPECT_EQ(validation.rows.size(), 76U);
    std::set<std::pair<std::string, std::string>> planned; // rows that decide a number
    for (const reports::CalibrationStep& step : reports::load_calibration_plan().steps)
        for (const std::string& row : reports::rows_in(step.row)) planned.emplace(step.gpu, row);
    for (const reports::ValidationRow& row : validation.rows) {
        if (!row.parameter.empty() && planned.contains({row.gpu, row.key()})) {
            EXPECT_LE(std::abs(row.log_error()), 0.03) << row.table << row.row << row.gpu << row.model;
        }
        if (row.missed()) {
            EXPECT_FALSE(row.explanation.empty()) << row.table << row.row << row.gpu << row.model;
        }
    }
    ASSERT_EQ(validation.summary.back().gpu, "all");
    const reports::ErrorSummary& all = validation.summary.back();
    EXPECT_EQ(all.predicted.rows, 13U);
    EXPECT_LE(all.predicted.median, std::log(1.10));
    ASSERT_TRUE(all.predicted.skill());
    EXPECT_GT(*all.predicted.skill(), 0.5);
    std::set<std::string> gpus;
    for (const reports::ErrorSummary& summary : validation.summary) {
        gpus.insert(summary.gpu);
        EXPECT_GE(summary.predicted.rows, 1U) << summary.gpu;
        EXPECT_LE(summary.predicted.worst, std::log(1 + reports::large_miss))
            << summary.gpu << " " << summary.predicted.worst_row;
    }
    EXPECT_EQ(gpus, (std::set<std::string>{"all", "g70", "nv43", "r420", "rv350"}));
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

} // namespace geometry_reports_test
