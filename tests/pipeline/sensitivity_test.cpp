// Sensitivity analyses: which parameters, which values, and what follows from the runs.
#include "reports/sensitivity/parameters.hpp"
#include "reports/sensitivity/sensitivity.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using reports::Sensitivity;
using reports::SensitivityParameter;
using reports::SensitivityRequest;
using reports::SensitivityStep;

std::vector<std::string> values_of(const std::vector<SensitivityStep>& steps) {
    std::vector<std::string> values;
    for (const SensitivityStep& step : steps) values.push_back(step.value);
    return values;
}

std::vector<std::string> steps(const std::string& type, const std::string& range, const std::string& value,
                               const std::string& unit = "", double factor = 2) {
    sim::FieldInfo field;
    field.type = type;
    field.range = range;
    field.unit = unit;
    return values_of(reports::steps_of(field, value, factor));
}

using Values = std::vector<std::string>;

TEST(SensitivitySteps, NumbersGoDownAndUpByTheFactorWithinTheirRange) {
    EXPECT_EQ(steps("whole number", "1 to 64", "32"), (Values{"16", "64"}));
    EXPECT_EQ(steps("whole number", "1 to 64", "48"), (Values{"24", "64"}));
    EXPECT_EQ(steps("whole number", "1 to 64", "1"), (Values{"2"}));
    EXPECT_EQ(steps("whole number", "at least 4", "6", "", 3), (Values{"4", "18"}));
    EXPECT_EQ(steps("number", "0.5 to 1000", "51.2"), (Values{"25.6", "102.4"}));
    EXPECT_EQ(steps("number", "at most 8", "8"), (Values{"4"}));
}

TEST(SensitivitySteps, ZerosBecomeAFirstNoticeableAmount) {
    EXPECT_EQ(steps("whole number", "0 to 100", "0", "cycles"), (Values{"1"}));
    EXPECT_EQ(steps("number", "0 to 1e6", "0.0", "us"), (Values{"10"}));
    EXPECT_EQ(steps("number", "0 to 100000", "0.0", "bytes per cycle"), (Values{"64"}));
}

TEST(SensitivitySteps, TruthValuesAndChoicesTakeTheirOthers) {
    EXPECT_EQ(steps("true or false", "", "false"), (Values{"true"}));
    EXPECT_EQ(steps("choice", "a | b | c", "b"), (Values{"a", "c"}));
    EXPECT_TRUE(steps("text", "", "x").empty());
}

SensitivityRequest small(const std::vector<std::string>& parameters) {
    SensitivityRequest request;
    request.comparison.scene = "gen:discs?n=20";
    request.comparison.width = request.comparison.height = 32;
    request.comparison.designs = {"existing", "interlock", "blender", "blender?rop.queue=2"};
    request.parameters = parameters;
    return request;
}

const Sensitivity& measured() {
    static const Sensitivity result =
        reports::measure_sensitivity(small({"rop.queue", "rop.fast_clear", "memory.bandwidth", "blender.lanes"}));
    return result;
}

const SensitivityParameter& parameter(const Sensitivity& result, const std::string& path) {
    const auto found = std::find_if(result.parameters.begin(), result.parameters.end(),
                                    [&path](const auto& one) { return one.path == path; });
    if (found == result.parameters.end()) throw std::runtime_error(path);
    return *found;
}

TEST(SensitivityRuns, EveryStepIsTheComparisonWithThatSetting) {
    for (const auto& [path, value] : std::vector<std::pair<std::string, std::string>>{
             {"rop.queue", "64"}, {"rop.fast_clear", "true"}, {"blender.lanes", "2"}}) {
        reports::ComparisonRequest request = small({}).comparison;
        request.gpu_settings = {path + "=" + value};
        const auto comparison = reports::compare(reports::prepare(request));
        const auto& all = parameter(measured(), path).steps;
        const auto step = std::find_if(all.begin(), all.end(),
                                       [&value = value](const SensitivityStep& one) { return one.value == value; });
        ASSERT_NE(step, all.end()) << path;
        ASSERT_EQ(step->runs.size(), comparison.runs.size());
        for (std::size_t i = 0; i < step->runs.size(); ++i) {
            EXPECT_EQ(step->runs[i].cycles, comparison.runs[i].cycles) << path;
            EXPECT_EQ(step->runs[i].hazards.by, comparison.runs[i].hazards.by) << path;
            EXPECT_EQ(step->runs[i].wrong_pixels, comparison.runs[i].wrong_pixels) << path;
        }
    }
}

TEST(SensitivityRuns, ASettingOfTheDesignStaysWhatItIs) {
    for (const SensitivityStep& step : parameter(measured(), "rop.queue").steps)
        EXPECT_EQ(step.runs[3].cycles, measured().base[3].cycles) << step.value;
}

TEST(SensitivityRuns, RanksFollowTheTime) {
    for (const SensitivityParameter& one : measured().parameters)
        for (const SensitivityStep& step : one.steps)
            for (const auto& a : step.runs)
                for (const auto& b : step.runs) EXPECT_EQ(a.rank < b.rank, a.milliseconds < b.milliseconds) << one.path;
}

TEST(SensitivityRuns, AConclusionIsTheLeastRatioOverAllRuns) {
    const Sensitivity& result = measured();
    EXPECT_GE(result.conclusions.size(), 3U) << "interlock and both blenders are correct";
    for (const reports::Conclusion& one : result.conclusions) {
        double least = one.ratio;
        EXPECT_GE(one.ratio, 1.0);
        for (const SensitivityParameter& of : result.parameters)
            for (const SensitivityStep& step : of.steps)
                least = std::min(least, step.runs[one.slower].milliseconds / step.runs[one.faster].milliseconds);
        EXPECT_DOUBLE_EQ(one.worst_ratio, least);
        EXPECT_EQ(one.survives(), least >= 0.99);
    }
}

TEST(SensitivityRuns, EqualForAnyNumberOfThreads) {
    SensitivityRequest one = small({"rop.queue", "crossbar"}), two = one;
    one.comparison.threads = 1;
    two.comparison.threads = 3;
    EXPECT_EQ(reports::sensitivity_json(reports::measure_sensitivity(one)),
              reports::sensitivity_json(reports::measure_sensitivity(two)));
}

TEST(SensitivityRuns, AValueThatNoMachineCanHaveIsNamedAndNotRun) {
    SensitivityRequest request = small({"rop.units"});
    request.comparison.gpu_settings = {"rop.units=4"};
    request.comparison.designs = {"blender?lanes=1", "interlock"};
    request.parameters = {"memory.interleave"};
    request.factor = 3; // no power of two
    const Sensitivity result = reports::measure_sensitivity(request);
    for (const SensitivityStep& step : result.parameters.at(0).steps) {
        EXPECT_EQ(step.runs.empty(), !step.refused.empty());
        EXPECT_NE(step.refused.find("power"), std::string::npos) << step.value << ": " << step.refused;
    }
}

TEST(SensitivityParameters, ByDefaultAllThatIsAssumedAndReadInAFixedOrder) {
    SensitivityRequest request = small({});
    const auto input = reports::prepare(request.comparison);
    const auto choice = reports::choose_parameters(request, input, {"k-buffer read path of the shaders"});
    std::vector<std::string> paths;
    for (const SensitivityParameter& one : choice.chosen) paths.push_back(one.path);
    const auto has = [&paths](const char* path) { return std::count(paths.begin(), paths.end(), path) == 1; };
    EXPECT_TRUE(has("rop.read_request_latency"));
    EXPECT_TRUE(has("rop.read_return_latency"));
    EXPECT_TRUE(has("fragment.pipes"));
    EXPECT_TRUE(has("rop.fast_clear"));
    EXPECT_FALSE(has("host.bus_gbps")) << "published";
    EXPECT_FALSE(has("early_depth.latency")) << "not built";
    EXPECT_FALSE(has("rop.depth_cache_bytes")) << "not built";
    EXPECT_FALSE(has("host.convert.normal.u16_ns")) << "no such vertices";
    EXPECT_TRUE(std::any_of(choice.skipped.begin(), choice.skipped.end(),
                            [](const auto& one) { return one.first == "early_depth.latency" && !one.second.empty(); }));
    for (const SensitivityParameter& one : choice.chosen) EXPECT_FALSE(one.steps.empty()) << one.path;
}

TEST(SensitivityParameters, SectionsStandForAllThatLiesBelowAndUnknownOnesAreRefused) {
    SensitivityRequest request = small({"crossbar", "interlock.grants_per_clk"});
    const auto input = reports::prepare(request.comparison);
    const auto choice = reports::choose_parameters(request, input, {});
    ASSERT_GE(choice.chosen.size(), 3U);
    for (const SensitivityParameter& one : choice.chosen)
        EXPECT_TRUE(one.path.starts_with("crossbar.") || one.path == "interlock.grants_per_clk") << one.path;
    request.parameters = {"rop.quee"};
    try {
        reports::choose_parameters(request, input, {});
        FAIL();
    } catch (const sim::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean 'rop.queue'?"), std::string::npos) << error.what();
    }
}

TEST(SensitivityReport, SaysTheSameInEveryForm) {
    const Sensitivity& result = measured();
    const auto document = reports::sensitivity_json(result);
    EXPECT_EQ(document.at("parameters").size(), result.parameters.size());
    EXPECT_EQ(document.at("conclusions").size(), result.conclusions.size());
    const auto table = reports::sensitivity_table(result);
    std::size_t rows = result.base.size();
    for (const SensitivityParameter& one : result.parameters)
        for (const SensitivityStep& step : one.steps) rows += step.runs.size();
    EXPECT_EQ(table.rows.size(), rows);
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
    const std::string text = reports::sensitivity_text(result, {}), page = reports::sensitivity_page(result);
    for (const SensitivityParameter& one : result.parameters) {
        EXPECT_NE(text.find(one.path), std::string::npos);
        EXPECT_NE(page.find(one.path), std::string::npos);
    }
    EXPECT_NE(page.find("\"tornado\":true"), std::string::npos);
}

} // namespace
