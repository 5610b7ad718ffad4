// Studies of k-buffer designs: a file's runs are the comparisons it names, and its mistakes are one clear line.
#include "reports/comparison.hpp"
#include "reports/run_numbers.hpp"
#include "reports/run_values.hpp"
#include "reports/study.hpp"
#include "tests/support/program_run.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace study_designs_test {

constexpr const char* head = "title = \"t\"\nquestion = \"q\"\nx = \"triangles\"\nsize = \"64x48\"\n";
constexpr const char* points = "points = [ { x = 400 }, { x = 3000 } ]\n";
constexpr const char* series = "[[series]]\nname = \"unprotected\"\nscene = \"gen:blob?triangles={x}\"\n"
                               "design = \"existing\"\nsettings = [\"workload.k=2\", "
                               "\"existing.visibility=rop_cache\", \"memory.controller.jitter_cycles=128\"]\n"
                               "[[series]]\nname = \"scoreboard\"\nscene = \"gen:blob?triangles={x}\"\n"
                               "design = \"scoreboard\"\n";

const std::vector<std::string> hardware{"existing.visibility=rop_cache", "memory.controller.jitter_cycles=128"};

reports::Study study_of(const std::string& text) {
    const ropsim_test::TemporaryFolder folder;
    const auto path = folder.path() / "mine.toml";
    ropsim_test::write_text(path, text);
    return reports::load_study(path.string());
}

reports::StudyResult run(const reports::Study& study, unsigned threads = 1) {
    reports::GeometryRunOptions options;
    options.threads = threads;
    return reports::run_study(study, {}, options);
}

/// The line that a file ends with; "" when it runs.
std::string mistake(const std::string& text) {
    try {
        run(study_of(text));
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "";
}

reports::Comparison compared(const std::string& design, const std::vector<std::string>& workload,
                             const std::vector<std::string>& gpu, std::uint64_t seed) {
    reports::ComparisonRequest request;
    request.scene = "gen:blob?triangles=3000";
    request.width = 64;
    request.height = 48;
    request.workload_settings = workload;
    request.gpu_settings = gpu;
    request.designs = {design};
    request.seed = seed;
    return reports::compare(reports::prepare(request));
}

TEST(StudyOfDesigns, ASeriesMayNameADesignWithSettings) {
    const auto series_of = [](const std::string& design, const std::string& settings) {
        return std::string(head) + "points = [ { x = 400 } ]\nmeasure = \"hazards.concurrency_per_million\"\n" +
               "[[series]]\nname = \"s\"\nscene = \"gen:blob?triangles={x}\"\ndesign = \"" + design +
               "\"\nsettings = [" + settings + "]\n";
    };
    const auto variant = run(study_of(series_of("existing?visibility=rop_cache&fragment.pipes=2", "")));
    const auto set = run(study_of(series_of("existing", "\"existing.visibility=rop_cache\", \"fragment.pipes=2\"")));
    EXPECT_EQ(variant.values.at(0).measure, set.values.at(0).measure);
    EXPECT_GT(set.values.at(0).measure, 0.0);
    EXPECT_NE(mistake(series_of("exsting?visibility=rop_cache", "")).find("did you mean 'existing'?"),
              std::string::npos);
    EXPECT_NE(mistake(series_of("existing?visibilty=rop_cache", "")).find("did you mean 'existing.visibility'?"),
              std::string::npos);
}

TEST(StudyOfDesigns, NumbersAreThoseOfTheComparisons) {
    const reports::StudyResult result =
        run(study_of(std::string(head) + points +
                     "measures = [ { value = \"hazards.per_million\" }, { value = \"wrong_share\" }, { value = "
                     "\"stages.rop.counters.stores / fragments\" }, { value = \"cycles\", over = \"scoreboard\" } ]\n" +
                     series));
    ASSERT_EQ(result.values.size(), 4U);
    const reports::StudyValue& unprotected = result.values[2];
    EXPECT_EQ(unprotected.x, "3000");
    EXPECT_EQ(unprotected.series, "unprotected");
    const reports::Comparison existing = compared("existing", {"k=2"}, hardware, 1);
    const reports::Comparison scoreboard = compared("scoreboard", {}, {}, 1);
    ASSERT_GT(existing.runs[0].hazards.total(), 0U);
    ASSERT_GT(existing.runs[0].wrong_pixels, 0U);
    std::uint64_t drawn = 0;
    for (const std::uint32_t depth : existing.depth_complexity) drawn += depth != 0 ? 1 : 0;
    EXPECT_EQ(unprotected.numbers[0].mean, reports::hazards_per_million(existing.runs[0]));
    EXPECT_EQ(unprotected.numbers[1].mean,
              static_cast<double>(existing.runs[0].wrong_pixels) / static_cast<double>(drawn));
    EXPECT_EQ(unprotected.numbers[2].mean, 1.0);
    EXPECT_EQ(unprotected.numbers[3].mean,
              static_cast<double>(existing.runs[0].cycles) / static_cast<double>(scoreboard.runs[0].cycles));
    EXPECT_EQ(result.values[3].numbers[0].mean, 0.0);
    EXPECT_EQ(result.values[3].numbers[3].mean, 1.0);
}

TEST(StudyOfDesigns, SeedsGiveMeanSpreadAndChange) {
    const std::string text = std::string(head) +
                             "points = [ { x = 3000 } ]\nseeds = 3\nmeasures = [ { value = \"cycles\" }, { value = "
                             "\"frame_change\" }, { value = \"frame_change_worst\" } ]\n" +
                             series;
    const reports::StudyResult result = run(study_of(text));
    std::vector<double> cycles;
    reports::FrameChange change;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const reports::Comparison comparison = compared("existing", {"k=2"}, hardware, seed);
        cycles.push_back(static_cast<double>(comparison.runs[0].cycles));
        change.add(comparison, 0);
    }
    const std::vector<reports::StudyNumber>& numbers = result.values[0].numbers;
    EXPECT_DOUBLE_EQ(numbers[0].mean, (cycles[0] + cycles[1] + cycles[2]) / 3);
    EXPECT_EQ(numbers[0].low, *std::min_element(cycles.begin(), cycles.end()));
    EXPECT_EQ(numbers[0].high, *std::max_element(cycles.begin(), cycles.end()));
    EXPECT_LT(numbers[0].low, numbers[0].high);
    EXPECT_EQ(numbers[1].mean, change.mean());
    EXPECT_EQ(numbers[2].mean, change.worst());
    EXPECT_GT(numbers[1].mean, 0.0);
    EXPECT_GT(numbers[2].mean, numbers[1].mean);
    for (const reports::StudyNumber& number : {result.values[1].numbers[1], result.values[1].numbers[2]})
        EXPECT_EQ(number.mean, 0.0) << "a correct design gives the same frame whatever the latencies";
}

TEST(StudyOfDesigns, NumberOfThreadsChangesNothing) {
    const reports::Study study = study_of(std::string(head) + points +
                                          "seeds = 2\nmeasures = [ { value = \"hazards.per_million\" } ]\n" + series);
    EXPECT_EQ(reports::study_json(run(study, 1)), reports::study_json(run(study, 4)));
}

TEST(StudyOfDesigns, NumberThatSomeRunsLackIsAGap) {
    const reports::StudyResult result =
        run(study_of(std::string(head) + points +
                     "measures = [ { value = \"area.added.scoreboard\", optional = true } ]\n" + series));
    EXPECT_TRUE(std::isnan(result.values[0].numbers[0].mean));
    EXPECT_GT(result.values[1].numbers[0].mean, 0.0);
    EXPECT_EQ(reports::study_json(result).at("values").at(0).at("area.added.scoreboard").dump(), "null");
    EXPECT_EQ(reports::study_table(result).rows[0][3], "");
}

TEST(StudyOfDesigns, MistakesAreNamed) {
    const std::string good = std::string(head) + points;
    const auto with = [&](const std::string& measure) {
        return good + "measures = [ { " + measure + " } ]\n" + series;
    };
    EXPECT_EQ(mistake(with("value = \"cycles\"")), "");
    EXPECT_NE(mistake(with("value = \"hazards.per_milion\""))
                  .find("study mine: series 'unprotected' at 400: the run has no value 'hazards.per_milion'; did you "
                        "mean 'hazards.per_million'?"),
              std::string::npos);
    EXPECT_NE(mistake(with("value = \"nothing.such\", optional = true")).find("no run has the value 'nothing.such'"),
              std::string::npos);
    EXPECT_NE(mistake(with("title = \"x\"")).find("mine.toml:6:14: value: expected a text"), std::string::npos);
    EXPECT_NE(mistake(with("value = \"cycles\", over = \"scorebord\"")).find("did you mean 'scoreboard'?"),
              std::string::npos);
    const std::string measure = "measure = \"cycles\"\n";
    const auto design = [&](const std::string& id) {
        return good + measure + "[[series]]\nname = \"s\"\nscene = \"gen:stack\"\ndesign = \"" + id + "\"\n";
    };
    EXPECT_NE(mistake(design("existin")).find("design: expected one of existing, "), std::string::npos);
    EXPECT_NE(mistake(design("existin")).find("did you mean 'existing'?"), std::string::npos);
    EXPECT_NE(mistake(design("d{x}")).find("study mine: series 's' at 400: unknown design 'd400'"), std::string::npos);
    EXPECT_NE(mistake(design("{y}")).find("names a variable"), std::string::npos);
    EXPECT_NE(mistake(good + measure + "seeds = 0\n" + series).find("seeds: expected 1 to 1024"), std::string::npos);
    EXPECT_NE(mistake(good + measure + "workload = \"shadow\"\n" + series).find("workload: expected one of"),
              std::string::npos);
    EXPECT_NE(mistake(good + measure + series + "[[series]]\nname = \"g\"\nscene = \"gen:grass\"\n")
                  .find("series: expected a design in all of them or in none"),
              std::string::npos);
    EXPECT_NE(mistake("title = \"t\"\n").find("question: expected a text"), std::string::npos);
    EXPECT_NE(mistake(good + measure + series + "sede = 3\n").find("unknown key 'sede'"), std::string::npos);
}

TEST(StudyOfDesigns, EveryStudyOnHandHasAnAnswerOnRecord) {
    std::size_t seen = 0;
    for (const std::string& name : reports::study_names()) {
        const reports::Study study = reports::load_study(name);
        if (!study.of_designs()) continue;
        ++seen;
        EXPECT_FALSE(study.answer.empty()) << name;
        EXPECT_FALSE(study.source.empty()) << name;
    }
    EXPECT_GE(seen, 16U);
}

TEST(StudyOfDesigns, PointsThatDrawNothingAreNamed) { // the stack leaves the picture on the right
    const std::string text = "title = \"t\"\nquestion = \"q\"\nx = \"gap\"\nsize = \"8x8\"\nworkload = \"opaque\"\n"
                             "measure = \"cycles\"\npoints = [ { x = 0 }, { x = 99 } ]\n"
                             "[[series]]\nname = \"one\"\nscene = \"gen:stack?n=1&x={x}&y=0&w=2&h=2\"\n"
                             "design = \"blender\"\n";
    const reports::StudyResult result = run(study_of(text));
    EXPECT_TRUE(result.values[0].drew);
    EXPECT_EQ(reports::nothing_drawn(result),
              "no fragment reached the pixels at gap = 99: numbers of these points say nothing");
}

} // namespace study_designs_test
