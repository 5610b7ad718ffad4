// `ropsim truth`: what it prints and writes, and the cache that makes a second run instant.
#include "reports/truth/ray_scene.hpp"
#include "sim/check.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/ray_kit.hpp"

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace cli_truth_test {

using nlohmann::json;
using ropsim_test::file_text;
using ropsim_test::ProgramOutcome;
using ropsim_test::TemporaryFolder;

/// Runs of the program that share a cache of their own.
class CliTruth : public support::RayTest {
  protected:
    ProgramOutcome run(const std::vector<std::string>& further, std::vector<std::string> environment = {}) const {
        std::vector<std::string> arguments{"truth", "gen:slabs", "--size", "48x48"};
        arguments.insert(arguments.end(), further.begin(), further.end());
        ropsim_test::ProgramOptions options;
        options.environment = std::move(environment);
        options.environment.push_back("XDG_CACHE_HOME=" + cache_.path().string());
        return ropsim_test::run_program(arguments, options);
    }
    json json_of(std::vector<std::string> further) const {
        further.emplace_back("--json");
        const ProgramOutcome outcome = run(further);
        EXPECT_EQ(outcome.status, 0) << outcome.error;
        return json::parse(outcome.out);
    }
    std::filesystem::path cached_file() const { return cache_.path() / cache_.files().at(0); }

    TemporaryFolder cache_;
};

const std::vector<std::string> lit{"--light", "0,6,0,1,0,0,0,0,1", "--rays", "16"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& further) {
    arguments.insert(arguments.end(), further.begin(), further.end());
    return arguments;
}

TEST_F(CliTruth, JsonSaysWhatWasTracedAndChecked) {
    const json document = json_of(with(lit, {"--check"}));
    EXPECT_EQ(document["scene"]["workload"], "transparency");
    const json& truth = document["truth"];
    EXPECT_EQ(truth["pixel_rays"], 2 * 48 * 48);
    EXPECT_EQ(truth["deepest"], 4);
    EXPECT_EQ(truth["light_rays"], 16 * truth["pixels_seen"].get<int>());
    EXPECT_EQ(document["light"]["rays_per_point"], 16);
    ASSERT_EQ(document["errors"].size(), 5U);
    for (const json& error : document["errors"]) EXPECT_EQ(error["holds"], true) << error;
    EXPECT_EQ(document["host"]["cached"], false);
}

TEST_F(CliTruth, SecondRunFindsTheSameInTheCache) {
    const TemporaryFolder first, second;
    json traced = json_of(with(lit, {"--out", first.path().string()}));
    json found = json_of(with(lit, {"--out", second.path().string()}));
    EXPECT_EQ(traced["host"]["cached"], false);
    EXPECT_EQ(found["host"]["cached"], true);
    traced.erase("host");
    found.erase("host");
    EXPECT_EQ(traced, found);
    ASSERT_EQ(first.files(), second.files());
    const std::vector<std::string> expected{".ropsim-files", "composite.exr", "composite.png", "layer0.png",
                                            "layer1.png",    "layer2.png",    "layer3.png",    "layers.exr",
                                            "overlap.exr",   "overlap.png",   "truth.json",    "visibility.exr",
                                            "visibility.png"};
    EXPECT_EQ(first.files(), expected);
    for (const std::string& file : first.files())
        if (file != "truth.json") {
            EXPECT_EQ(file_text(first.path() / file), file_text(second.path() / file)) << file;
        }
    EXPECT_EQ(cache_.files().size(), 1U);
    EXPECT_EQ(json_of(with(lit, {"--seed", "2"}))["host"]["cached"], false);
    EXPECT_EQ(json_of(with(lit, {"--no-cache"}))["host"]["cached"], false);
}

TEST_F(CliTruth, ThreadsDoNotMatter) {
    const auto files = [&](const std::string& threads) {
        const TemporaryFolder folder;
        json_of(with(lit, {"--threads", threads, "--no-cache", "--out", folder.path().string()}));
        std::string all;
        for (const std::string& file : folder.files())
            if (file != "truth.json") all += file + file_text(folder.path() / file);
        return all;
    };
    EXPECT_EQ(files("1"), files("3"));
    EXPECT_EQ(cache_.files().size(), 0U);
}

TEST_F(CliTruth, DamagedCacheIsComputedAgainWithOneNote) {
    json before = json_of({});
    std::string bytes = file_text(cached_file());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    ropsim_test::write_text(cached_file(), bytes);
    const ProgramOutcome outcome = run({"--json"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_NE(outcome.error.find("is damaged; the truth is computed again"), std::string::npos) << outcome.error;
    json after = json::parse(outcome.out);
    EXPECT_EQ(after["host"]["cached"], false);
    EXPECT_EQ(before["truth"], after["truth"]);
    EXPECT_EQ(json_of({})["host"]["cached"], true);
}

TEST_F(CliTruth, CacheThatCannotBeWrittenIsOneNote) {
    ropsim_test::write_text(cache_.path() / "ropsim", "a file where the folder would be");
    const ProgramOutcome outcome = run({});
    EXPECT_EQ(outcome.status, 0);
    const std::string all = outcome.out + outcome.error;
    const std::size_t note = all.find("the truth is not kept: ");
    EXPECT_NE(note, std::string::npos) << all;
    EXPECT_EQ(all.find("the truth is not kept: ", note + 1), std::string::npos) << all;
}

TEST_F(CliTruth, SaysWhatIsWrongInOneLine) {
    const auto expect = [&](const std::vector<std::string>& arguments, int status, const std::string& says) {
        const ProgramOutcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, status) << outcome.error;
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
        EXPECT_NE(outcome.error.find(says), std::string::npos) << outcome.error;
    };
    expect({"--workload", "blended"}, 1,
           "truth: expected a workload of transparency, opaque, translucency, csg, soft-shadows, deferred");
    expect({"--workload", "transparancy"}, 1, "did you mean 'transparency'?");
    expect({"--light", "1,2,3"}, 1, "--light: expected nine numbers");
    expect({"--light", "0,6,0,1,0,0,1,0,1"}, 1, "--light: expected two half edges at right angles");
    expect({"--light", "0,6,0,0,0,0,1,0,1"}, 1, "--light: expected two half edges at right angles");
    expect({"--rays", "0"}, 1, "--rays: expected a whole number from 1 to 1000000, got '0'");
    expect({"--layers", "65"}, 1, "--layers: expected a whole number from 1 to 64");
    expect({"--set", "rop.queue=3"}, 1, "--set: expected workload.KEY=VALUE");
    expect({"--set", "workload.opacitty=1"}, 1, "opacity");
    expect({"--lihgt", "1"}, 2, "did you mean '--light'?");
    expect({"--out", "/proc/none"}, 1, "/proc/none");
}

// LD_DEBUG=libs names every library that the loader opens.
TEST_F(CliTruth, EmbreeIsLoadedOnlyToTraceRays) {
    const TemporaryFolder folder;
    const auto loads_embree = [&](std::vector<std::string> arguments) {
        ropsim_test::ProgramOptions options;
        options.environment = {"LD_DEBUG=libs", "LD_DEBUG_OUTPUT=" + (folder.path() / "loader").string(),
                               "XDG_CACHE_HOME=" + cache_.path().string()};
        EXPECT_EQ(ropsim_test::run_program(arguments, options).status, 0);
        bool found = false;
        for (const std::string& file : folder.files()) {
            found = found || file_text(folder.path() / file).find("libembree") != std::string::npos;
            std::filesystem::remove(folder.path() / file);
        }
        return found;
    };
    EXPECT_FALSE(loads_embree({"compare", "gen:stack", "--size", "16x16", "--no-images"}));
    EXPECT_FALSE(loads_embree({"run", "gen:stack", "--size", "16x16"}));
    EXPECT_TRUE(loads_embree({"truth", "gen:stack", "--size", "16x16"}));
    EXPECT_FALSE(loads_embree({"truth", "gen:stack", "--size", "16x16"})) << "the second one is in the cache";
}

TEST_F(CliTruth, MissingModuleIsOneLine) {
    const TemporaryFolder modules;
    ropsim_test::write_text(modules.path() / "ropsim_rays.so", "no library");
    const ProgramOutcome outcome = run({}, {"ROPSIM_MODULE_DIR=" + modules.path().string()});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_TRUE(outcome.error.starts_with("ropsim: ray tracing needs ropsim_rays.so and Embree")) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
}

} // namespace cli_truth_test
