// The built program's results: documented, the same for any number of threads, and pictures only when asked for.
#include "reports/counter_reference.hpp"
#include "reports/flatten.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/schema.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

namespace cli_results_test {

using nlohmann::json;
using ropsim_test::file_text;
using ropsim_test::run_program;
using ropsim_test::TemporaryFolder;

std::vector<std::string> comparison(std::vector<std::string> further) {
    std::vector<std::string> arguments{"compare", "gen:discs?n=200", "--size", "64x64", "--designs", "all"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return arguments;
}

json json_of(const std::vector<std::string>& arguments) {
    const auto outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    std::istringstream lines(outcome.error);
    for (std::string line; std::getline(lines, line);) EXPECT_TRUE(line.starts_with("ropsim: note: ")) << line;
    return json::parse(outcome.out);
}

TEST(CliResults, JsonIsOneDocumentThatFollowsTheSchema) {
    const json schema = json::parse(file_text(ropsim_test::source_dir() / "reports/result.schema.json"));
    EXPECT_EQ(ropsim_test::schema_violations(schema, json_of(comparison({"--json"}))), std::vector<std::string>());
    EXPECT_EQ(ropsim_test::schema_violations(schema, json_of(comparison({"--json", "--workload", "opaque"}))),
              std::vector<std::string>());
}

TEST(CliResults, WithoutDesignsUnprotectedHardwareIsShownAtEveryVisibility) {
    const json result = json_of({"compare", "gen:discs?n=200", "--size", "64x64", "--json"});
    std::vector<std::string> variants;
    for (const json& design : result["designs"]) variants.push_back(design["variant"]);
    EXPECT_EQ(variants, (std::vector<std::string>{"existing?visibility=rop_cache", "existing?visibility=writeback",
                                                  "existing?visibility=never_until_flush", "scoreboard", "blender",
                                                  "multipass"}));
    const auto text = run_program({"compare", "gen:discs?n=200", "--size", "64x64"});
    EXPECT_NE(text.out.find("speed: times that of existing writeback"), std::string::npos) << text.out;
}

TEST(CliResults, EveryVariantHasARowAColumnAndAFolderOfItsOwn) {
    const json schema = json::parse(file_text(ropsim_test::source_dir() / "reports/result.schema.json"));
    const TemporaryFolder folder;
    const json result = json_of({"compare", "gen:discs?n=200", "--size", "64x64", "--designs",
                                 "existing?bypass_l1=true&visibility=rop_cache,existing,blender?rop.queue=64,multipass",
                                 "--json", "--out", folder.path().string()});
    EXPECT_EQ(ropsim_test::schema_violations(schema, result), std::vector<std::string>());
    std::vector<std::string> ids;
    for (const json& design : result["designs"]) {
        ids.push_back(design["id"]);
        EXPECT_TRUE(std::filesystem::is_directory(folder.path() / ids.back())) << ids.back();
    }
    EXPECT_EQ(ids, (std::vector<std::string>{"existing-1", "existing-2", "blender-1", "multipass"}));
    EXPECT_EQ(result["designs"][0]["parameters"]["bypass_l1"], true);
    EXPECT_EQ(result["designs"][1]["parameters"]["bypass_l1"], false);
    EXPECT_EQ(result["designs"][2]["gpu_changes"], json({{"rop.queue", 64}}));
    const std::string table = file_text(folder.path() / "designs.csv");
    EXPECT_NE(table.find("existing-1,existing?bypass_l1=true&visibility=rop_cache,"), std::string::npos) << table;
}

TEST(CliResults, ADesignMayBringItsSettingsWhereverOneIsNamed) {
    const json run =
        json_of({"run", "gen:stack", "--size", "16x16", "--design", "scoreboard?side_buffer=64", "--json"});
    EXPECT_EQ(run["designs"][0]["parameters"]["side_buffer"], 64);
}

TEST(CliResults, EqualAreaSaysWhatTheCachesGotAndWhatDoesNotFit) {
    const json schema = json::parse(file_text(ropsim_test::source_dir() / "reports/result.schema.json"));
    const std::vector<std::string> arguments{"compare",      "gen:discs?n=200", "--size",
                                             "64x64",        "--designs",       "existing,blender,multipass",
                                             "--equal-area", "300000"};
    auto with_json = arguments;
    with_json.emplace_back("--json");
    const json result = json_of(with_json);
    EXPECT_EQ(ropsim_test::schema_violations(schema, result), std::vector<std::string>());
    EXPECT_EQ(result["equal_area"]["bytes"], 300000);
    EXPECT_EQ(result["equal_area"]["does_not_fit"][0]["id"], "existing");
    for (const json& design : result["designs"]) EXPECT_LE(design["area"]["total_bytes"], 300000);
    const std::string text = run_program(arguments).out;
    EXPECT_NE(text.find("existing  does not fit: needs "), std::string::npos) << text;
    EXPECT_NE(text.find("tile caches got"), std::string::npos) << text;
    auto largest = arguments;
    largest.pop_back();
    EXPECT_EQ(run_program(largest).status, 0);
}

TEST(CliResults, SensitivityWritesItsTablesAndItsPage) {
    const TemporaryFolder folder;
    const json result =
        json_of({"sensitivity", "gen:discs?n=50&width=32&height=32", "--size", "32x32", "--designs",
                 "interlock,blender", "--parameters", "rop.queue", "--json", "--out", folder.path().string()});
    EXPECT_EQ(result["parameters"][0]["steps"].size(), 2U);
    EXPECT_EQ(result["conclusions"].size(), 1U);
    for (const char* file : {"sensitivity.json", "sensitivity.csv", "conclusions.csv", "report.html"})
        EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
}

TEST(CliResults, SamplesAreStatedAndCounted) {
    const json schema = json::parse(file_text(ropsim_test::source_dir() / "reports/result.schema.json"));
    const json one = json_of(comparison({"--json"})), four = json_of(comparison({"--json", "--samples", "4"}));
    EXPECT_EQ(ropsim_test::schema_violations(schema, four), std::vector<std::string>());
    EXPECT_EQ(one["scene"]["samples"], 1);
    EXPECT_EQ(four["scene"]["samples"], 4);
    for (std::size_t i = 0; i < one["designs"].size(); ++i) {
        const json &single = one["designs"][i], &sampled = four["designs"][i];
        SCOPED_TRACE(single["id"]);
        EXPECT_GT(sampled["fragments"], 3 * single["fragments"].get<std::uint64_t>());
        EXPECT_GT(sampled["cycles"], single["cycles"]);
        EXPECT_LE(sampled["wrong_pixels"], 64 * 64);
        const auto shaded = [](const json& design) {
            return design["stages"]["fragment_pipeline"]["counters"]["quads"].get<double>();
        };
        const double growth = shaded(sampled) / shaded(single);
        if (sampled["supports"]["antialiasing"] == "per sample")
            EXPECT_LT(growth, 1.5); // more only along edges
        else
            EXPECT_GT(growth, 3.0);
    }
}

TEST(CliResults, EqualForAnyNumberOfThreads) {
    json one = json_of(comparison({"--json", "--threads", "1"}));
    json two = json_of(comparison({"--json", "--threads", "2"}));
    one.erase("host");
    two.erase("host");
    EXPECT_EQ(one, two);
}

TEST(CliResults, FilesAreEqualForAnyNumberOfThreads) {
    const TemporaryFolder one, two;
    run_program(comparison({"--threads", "1", "--out", one.path().string()}));
    run_program(comparison({"--threads", "2", "--out", two.path().string()}));
    ASSERT_EQ(one.files(), two.files());
    EXPECT_GT(one.files().size(), 8U);
    for (const std::string& file : one.files())
        if (file != "result.json" && file != "report.html" &&
            file != ".ropsim-files") { // which lists them as they ended
            EXPECT_EQ(file_text(one.path() / file), file_text(two.path() / file)) << file;
        }
}

TEST(CliResults, FileAndStandardOutputSayTheSame) {
    const TemporaryFolder folder;
    const json printed = json_of(comparison({"--json", "--no-images", "--out", folder.path().string()}));
    EXPECT_EQ(json::parse(file_text(folder.path() / "result.json")), printed);
}

TEST(CliResults, EveryCounterHasAUnitAndAMeaning) {
    const json result = json_of(comparison({"--json"}));
    for (const auto& design : result["designs"])
        for (const auto& stage : design["stages"].items())
            for (const auto& [path, value] : reports::flatten(stage.value().value("counters", json::object()))) {
                const sim::FieldInfo* info = reports::find_counter(stage.key(), path);
                ASSERT_NE(info, nullptr) << stage.key() << "." << path;
                EXPECT_FALSE(info->text.empty()) << stage.key() << "." << path;
                EXPECT_FALSE(info->unit.empty()) << stage.key() << "." << path;
            }
}

TEST(CliResults, RunPrintsCountersWithTheirMeaning) {
    const auto outcome = run_program({"run", "gen:stack", "--size", "32x32", "--design", "blender"});
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_NE(outcome.out.find("Fragments run through the blender's program"), std::string::npos);
    EXPECT_NE(outcome.out.find("seed 1"), std::string::npos);
    EXPECT_NE(outcome.out.find("Left out:"), std::string::npos);
    EXPECT_EQ(outcome.out.find('\033'), std::string::npos) << "no colours outside a terminal";
}

// LD_DEBUG=libs names every library that the loader opens.
TEST(CliResults, OpenImageIoIsLoadedOnlyForPictures) {
    const TemporaryFolder folder;
    const auto loads_oiio = [&](std::vector<std::string> arguments) {
        ropsim_test::ProgramOptions options;
        options.environment = {"LD_DEBUG=libs", "LD_DEBUG_OUTPUT=" + (folder.path() / "loader").string()};
        EXPECT_EQ(run_program(arguments, options).status, 0);
        bool found = false;
        for (const std::string& file : folder.files())
            if (file.starts_with("loader")) {
                found = found || file_text(folder.path() / file).find("libOpenImageIO") != std::string::npos;
                std::filesystem::remove(folder.path() / file);
            }
        return found;
    };
    const std::string out = (folder.path() / "out").string();
    EXPECT_FALSE(loads_oiio({"compare", "gen:stack", "--size", "16x16"}));
    EXPECT_FALSE(loads_oiio({"compare", "gen:stack", "--size", "16x16", "--no-images", "--out", out}));
    EXPECT_TRUE(loads_oiio({"compare", "gen:stack", "--size", "16x16", "--out", out}));
}

TEST(CliResults, MissingImageModuleIsToldBeforeTheRun) {
    const TemporaryFolder folder, modules;
    ropsim_test::write_text(modules.path() / "ropsim_images.so", "no library");
    ropsim_test::ProgramOptions options;
    options.environment = {"ROPSIM_MODULE_DIR=" + modules.path().string()};
    const auto outcome = run_program({"compare", "gen:stack", "--out", folder.path().string()}, options);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.error.find("use --no-images"), std::string::npos) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
}

TEST(CliResults, VersionAndHelp) {
    EXPECT_TRUE(run_program({"--version"}).out.starts_with("ropsim "));
    for (const char* command : {"compare", "run", "describe"}) {
        const auto outcome = run_program({command, "--help"});
        EXPECT_EQ(outcome.status, 0);
        EXPECT_NE(outcome.out.find("Examples:"), std::string::npos) << command;
        EXPECT_NE(outcome.out.find(std::string("Usage: ropsim ") + command), std::string::npos) << outcome.out;
    }
}

TEST(CliResults, DescribeKnowsEveryTopicAndEveryNameInIt) {
    for (const char* topic : {"gpus", "designs", "programs", "workloads", "generators", "params", "stats"}) {
        const auto names = run_program({"describe", "--names", topic});
        EXPECT_EQ(names.status, 0);
        ASSERT_FALSE(names.out.empty()) << topic;
        const std::string first = names.out.substr(0, names.out.find('\n'));
        EXPECT_EQ(run_program({"describe", first}).status, 0) << first;
        const json list = json_of({"describe", topic, "--json"});
        EXPECT_EQ(list.size(), static_cast<std::size_t>(std::count(names.out.begin(), names.out.end(), '\n'))) << topic;
    }
}

} // namespace cli_results_test
