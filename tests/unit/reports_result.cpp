// result.json says what the runs found, follows its schema, and keeps what depends on the host apart.
#include "reports/result.hpp"

#include "reports/atomic_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/sample_comparison.hpp"
#include "tests/support/schema.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using nlohmann::json;
using ropsim_test::sample_comparison;

json schema() { return json::parse(ropsim_test::file_text(ropsim_test::source_dir() / "reports/result.schema.json")); }

json result() { return json::parse(reports::result_text(reports::result_json(sample_comparison()))); }

// Every number of the schema says what it is and in which unit (or that it is a count of something).
void expect_described(const json& schema, const std::string& path) {
    if (schema.is_object()) {
        if (schema.contains("type") && schema["type"].is_string()) {
            EXPECT_TRUE(schema.contains("description")) << path;
        }
        for (const auto& item : schema.items()) expect_described(item.value(), path + "/" + item.key());
    }
}

TEST(ReportsResult, FollowsItsSchema) {
    EXPECT_EQ(ropsim_test::schema_violations(schema(), result()), std::vector<std::string>());
    const auto depths = json::parse(reports::result_text(reports::result_json(ropsim_test::sample_depth_comparison())));
    EXPECT_EQ(ropsim_test::schema_violations(schema(), depths), std::vector<std::string>());
}

TEST(ReportsResult, SchemaDescribesEveryValue) { expect_described(schema(), ""); }

TEST(ReportsResult, StatesHazardsByClassAndPerMillion) {
    const json hazards = result()["designs"][0]["hazards"];
    EXPECT_EQ(hazards["h1"], 1);
    EXPECT_EQ(hazards["h3"], 1);
    EXPECT_EQ(hazards["total"], 2);
    EXPECT_EQ(hazards["pixels"], 2);
    EXPECT_DOUBLE_EQ(hazards["per_million"], 2e6 / 40);
    EXPECT_EQ(hazards["concurrency"], 1);
    EXPECT_EQ(hazards["incoherence"], 1);
    EXPECT_EQ(hazards["h1_concurrency"], 1);
    EXPECT_EQ(hazards["h3_incoherence"], 1);
    EXPECT_DOUBLE_EQ(hazards["incoherence_per_million"], 1e6 / 40);
    int cells = 0;
    for (const auto& item : hazards.items())
        if (item.key().find('_') == 2) cells += item.value().get<int>();
    EXPECT_EQ(cells, hazards["total"]) << "the table adds up to all hazards";
}

TEST(ReportsResult, FramesPerSecondIsClockOverCycles) {
    EXPECT_DOUBLE_EQ(result()["designs"][0]["fps"], 100'000.0); // 650 MHz over 6500 cycles
    EXPECT_DOUBLE_EQ(result()["designs"][1]["milliseconds"], 0.02);
}

TEST(ReportsResult, NeedsStateWhatAllHaveInCommonAndDesignsTheirOwn) {
    const json all = result();
    EXPECT_EQ(all["needs"]["built"], json({"index_fetch", "rasterizer"}));
    EXPECT_EQ(all["needs"]["left_out"], json::parse(R"([{"unit": "stencil", "reason": "no pass tests it"}])"));
    EXPECT_FALSE(all["designs"][0].contains("needs"));
    EXPECT_EQ(all["designs"][1]["needs"]["built"].size(), 3U);
}

TEST(ReportsResult, RunsDifferBelowHostOnly) {
    reports::Comparison other = sample_comparison();
    other.host = {9, 3, 5, 1};
    for (pipeline::RunResult& run : other.runs) {
        run.host_seconds *= 3;
        run.host_ticks += 7;
    }
    json first = result(), second = json::parse(reports::result_text(reports::result_json(other)));
    EXPECT_NE(first, second);
    first.erase("host");
    second.erase("host");
    EXPECT_EQ(first, second);
}

TEST(ReportsResult, KeepsTheOrderOfKeys) {
    const std::string text = reports::result_text(reports::result_json(sample_comparison()));
    std::size_t last = 0;
    for (const char* key : {"\"ropsim\"", "\"scene\"", "\"gpu\"", "\"seed\"", "\"host\"", "\"needs\"", "\"designs\""}) {
        const std::size_t at = text.find(std::string("\n  ") + key);
        ASSERT_NE(at, std::string::npos) << key;
        EXPECT_GT(at, last) << key;
        last = at;
    }
    EXPECT_EQ(text.back(), '\n');
}

TEST(ReportsResult, SchemaCheckerFindsWhatIsWrong) {
    const auto violations = [](auto change) {
        json document = result();
        change(document);
        return ropsim_test::schema_violations(schema(), document).size();
    };
    EXPECT_EQ(violations([](json& j) { j["designs"][0]["cycles"] = 1.5; }), 1U);
    EXPECT_EQ(violations([](json& j) { j["designs"][0]["cycles"] = -1; }), 1U);
    EXPECT_EQ(violations([](json& j) { j["designs"][0].erase("cycles"); }), 1U);
    EXPECT_EQ(violations([](json& j) { j["designs"][0]["cycle"] = 1; }), 1U);
    EXPECT_EQ(violations([](json& j) { j["seed"] = "1"; }), 1U);
    EXPECT_EQ(violations([](json& j) { j["needs"]["left_out"][0]["why"] = "?"; }), 1U);
}

} // namespace
