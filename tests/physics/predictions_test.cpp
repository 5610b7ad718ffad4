// What theory says of the model, row by row: predictions.toml. --gtest_filter=*PHY_H3* runs one.
#include "sim/config.hpp"
#include "tests/physics/expression.hpp"
#include "tests/physics/runs.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <set>

namespace physics {
namespace {

/// Rows whose check is an expression of numbers. A table that cannot be read has none: Table.Reads says why.
std::vector<Prediction> rows_with_runs() {
    std::vector<Prediction> rows;
    try {
        for (const Prediction& row : read_predictions())
            if (row.test.empty()) rows.push_back(row);
    } catch (const sim::InputError&) {
        rows.clear();
    }
    return rows;
}

/// The runs of a row by name.
class Row {
  public:
    explicit Row(const Prediction& row) : row_(&row) {
        for (const PredictionRun& run : row.runs) runs_[run.name] = numbers_of(run);
    }

    double at(std::string_view name) const {
        const std::size_t dot = name.find('.');
        const auto run = runs_.find(std::string(name.substr(0, dot)));
        if (run == runs_.end() || dot == std::string_view::npos)
            throw sim::InputError(fmt::format("'{}': expected RUN.VALUE with a run of the row", name));
        return run->second->at(name.substr(dot + 1));
    }
    std::vector<std::string> series(const std::string& prefix) const {
        std::vector<std::string> names;
        for (const PredictionRun& run : row_->runs)
            if (run.name.starts_with(prefix)) names.push_back(run.name);
        return names;
    }
    const std::map<std::string, std::shared_ptr<const RunNumbers>>& runs() const { return runs_; }

  private:
    const Prediction* row_;
    std::map<std::string, std::shared_ptr<const RunNumbers>> runs_;
};

class PredictionTest : public testing::TestWithParam<Prediction> {};

TEST_P(PredictionTest, IsMet) {
    const Prediction& prediction = GetParam();
    SCOPED_TRACE(fmt::format("{}: {}", prediction.id, prediction.claim));
    try {
        const Row row(prediction);
        const Lookup lookup = [&](std::string_view name) { return row.at(name); };
        for (const std::string& expectation : prediction.expectations) {
            const Verdict verdict =
                judge(expectation, lookup, [&](const std::string& prefix) { return row.series(prefix); });
            EXPECT_TRUE(verdict.holds) << expectation << "\n  is " << verdict.text
                                       << "\n  tolerance: " << prediction.tolerance;
            RecordProperty(expectation, verdict.text);
        }
        for (const auto& [name, run] : row.runs()) {
            EXPECT_EQ(exceeded_bounds(*run), "") << "run " << name;
            EXPECT_EQ(run->at("unexplained_pixels"), 0) << "run " << name;
        }
    } catch (const sim::InputError& error) {
        FAIL() << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(physics, PredictionTest, testing::ValuesIn(rows_with_runs()),
                         [](const auto& info) { return info.param.test_name(); });

std::vector<std::string> all_ids() {
    std::vector<std::string> ids;
    for (const auto& [letter, count] :
         std::vector<std::pair<char, int>>{{'R', 10}, {'H', 20}, {'C', 6}, {'N', 5}, {'S', 7}, {'L', 3}})
        for (int i = 1; i <= count; ++i) ids.push_back(fmt::format("{}{}", letter, i));
    return ids;
}

/// "R1" of "PHY_R1", of "PredictionTest/IsMet/PHY_R1_Long" and so on; empty without one.
std::string id_in(const std::string& test) {
    const std::size_t at = test.find("PHY_");
    if (at == std::string::npos) return {};
    const std::string rest = test.substr(at + 4);
    return rest.substr(0, rest.find('_'));
}

TEST(PredictionTable, HasEveryPredictionOnce) {
    std::vector<std::string> ids;
    for (const Prediction& row : read_predictions()) ids.push_back(row.id);
    EXPECT_EQ(ids, all_ids());
}

TEST(PredictionTable, EveryRowHasExactlyOneTest) {
    std::map<std::string, std::vector<std::string>> tests;
    const testing::UnitTest& program = *testing::UnitTest::GetInstance();
    for (int i = 0; i < program.total_test_suite_count(); ++i) {
        const testing::TestSuite& suite = *program.GetTestSuite(i);
        for (int j = 0; j < suite.total_test_count(); ++j) {
            const std::string test = suite.GetTestInfo(j)->name();
            if (!id_in(test).empty()) tests[id_in(test)].push_back(fmt::format("{}.{}", suite.name(), test));
        }
    }
    std::set<std::string> ids;
    for (const Prediction& row : read_predictions()) {
        ids.insert(row.id);
        ASSERT_EQ(tests[row.id].size(), 1U) << row.id;
        if (!row.test.empty()) {
            EXPECT_EQ(tests[row.id].front(), row.test);
        }
        EXPECT_EQ(row.effort == Prediction::Effort::long_, tests[row.id].front().find("Long") != std::string::npos)
            << row.id;
    }
    for (const auto& [id, list] : tests) EXPECT_TRUE(ids.contains(id)) << list.front();
}

TEST(PredictionTable, AnUnknownKeyIsAnErrorThatNamesIt) {
    PredictionRun run{.name = "a",
                      .scene = "gen:quads?n=1",
                      .workload = "transparency",
                      .gpu = "neutral",
                      .design = "existing",
                      .width = 8,
                      .height = 8,
                      .workload_settings = {},
                      .settings = {"rop.unitz=4"}};
    try {
        numbers_of(run);
        FAIL() << "expected an error";
    } catch (const sim::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("rop.unitz"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace physics
