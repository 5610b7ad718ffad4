// What the program says beside its numbers: notes, what makes a result meaningless, reasons, and what was typed.
#include "tests/support/effort.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"

#include <algorithm>
#include <csignal>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace cli_words_test {

using nlohmann::json;
using ropsim_test::ProgramOptions;
using ropsim_test::ProgramOutcome;
using ropsim_test::run_program;
using ropsim_test::TemporaryFolder;

std::size_t times(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// Looking away from everything.
const std::vector<std::string> away{"--size", "16x16", "--camera", "0,0,-5,0,0,-10,20", "--no-images"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

TEST(CliWords, CASE_F4_NothingDrawnIsSaidOnce) {
    for (const char* command : {"compare", "run", "sensitivity"}) {
        std::vector<std::string> arguments = with({command, "gen:slabs"}, away);
        if (arguments.front() == "sensitivity") {
            arguments.pop_back(); // it writes no pictures
            arguments.insert(arguments.end(), {"--designs", "blender", "--parameters", "rop.queue"});
        }
        const ProgramOutcome outcome = run_program(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.error;
        EXPECT_EQ(times(outcome.out, "nothing was drawn, so these numbers say nothing"), 1U) << outcome.out;
        EXPECT_EQ(outcome.error, "") << command;
        const ProgramOutcome document = run_program(with(arguments, {"--json"}));
        EXPECT_TRUE(json::accept(document.out));
        EXPECT_TRUE(document.error.starts_with("ropsim: note: nothing was drawn")) << document.error;
    }
}

TEST(CliWords, CASE_F4_ACheckOfNothingSaysNo) {
    const std::vector<std::string> arguments = with({"truth", "gen:slabs", "--check", "--no-cache"}, away);
    const ProgramOutcome outcome = run_program(arguments);
    if (outcome.error.find("ray tracing") != std::string::npos) GTEST_SKIP() << outcome.error;
    EXPECT_EQ(outcome.status, 4) << outcome.error;
    EXPECT_EQ(outcome.out.find(" yes"), std::string::npos) << outcome.out;
    EXPECT_EQ(times(outcome.out, "nothing was compared, so the check says no"), 1U) << outcome.out;
    const json document = json::parse(run_program(with(arguments, {"--json"})).out);
    EXPECT_FALSE(document["holds"].get<bool>());
    for (const json& error : document["errors"]) EXPECT_TRUE(error["holds"].is_null());
}

TEST(CliWords, CASE_F18_ASilhouetteAtPixelCentresIsDoubt) {
    const ProgramOutcome outcome = run_program({"truth", "gen:slabs", "--size", "65x65", "--camera", "5,0,0,0,0,0,20",
                                                "--no-cache", "--no-images", "--check", "--json"});
    if (outcome.error.find("ray tracing") != std::string::npos) GTEST_SKIP() << outcome.error;
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    const json document = json::parse(outcome.out);
    EXPECT_TRUE(document["holds"].get<bool>());
    EXPECT_GT(document["errors"][0]["compared"].get<int>(), 1000);
    EXPECT_GT(document["errors"][0]["doubtful"].get<int>(), 0);
}

TEST(CliWords, CASE_F5_NotesReachTheTerminal) {
    const auto path = ropsim_test::shared_file("cases/inputs/notes.glb");
    if (!path) GTEST_SKIP() << "no folder of cases";
    const std::vector<std::string> arguments{"compare",   path->string(), "--size",     "16x16",
                                             "--designs", "blender",      "--no-images"};
    const ProgramOutcome table = run_program(arguments);
    const std::size_t notes = table.out.find("\nNotes:\n");
    ASSERT_NE(notes, std::string::npos) << table.out;
    EXPECT_GT(notes, table.out.find("blender"));
    for (const char* word : {"extension", "animations (1)", "left out"}) {
        EXPECT_EQ(times(table.out.substr(notes), word), 1U) << word << table.out;
    }
    const ProgramOutcome document = run_program(with(arguments, {"--json"}));
    EXPECT_EQ(json::parse(document.out)["scene"]["notes"].size(), times(document.error, "ropsim: note: "));
    for (const char* command : {"geometry", "truth", "accuracy"}) {
        std::vector<std::string> other{command, path->string()};
        if (other.front() != "geometry") other = with(other, {"--size", "16x16", "--no-cache", "--no-images"});
        const ProgramOutcome outcome = run_program(other);
        if (outcome.error.find("ray tracing") != std::string::npos) continue;
        EXPECT_EQ(times(outcome.out, "animations (1)"), 1U) << command << outcome.out << outcome.error;
    }
}

TEST(CliWords, CASE_F9_LongWrongPixelsNameTheirReason) {
    struct Case {
        std::vector<std::string> settings;
        std::string reason, words;
    };
    const std::vector<Case> cases{
        {{"--set", "multipass.depth_format=d16"}, "depth_format", "nearer to each other than the depth format"},
        {{"--set", "multipass.rule=eps", "--set", "multipass.eps=0.01"}, "eps", "within eps of each other"}};
    for (const Case& one : cases) {
        const TemporaryFolder folder;
        // Several layers for each code of 16 bits, drawn from the back.
        const std::vector<std::string> arguments =
            with({"run", "gen:stack?n=300000&w=2&h=2&order=back-to-front", "--design", "multipass", "--size", "16x16",
                  "--no-images", "--out", folder.path().string()},
                 one.settings);
        const ProgramOutcome outcome = run_program(arguments);
        ASSERT_EQ(outcome.status, 0) << outcome.error;
        const json run = json::parse(ropsim_test::file_text(folder.path() / "result.json"))["designs"][0];
        EXPECT_GT(run["wrong_pixels"].get<int>(), 0);
        EXPECT_EQ(run["unexplained_pixels"], 0);
        EXPECT_EQ(run["wrong_because"][one.reason], run["wrong_pixels"]);
        EXPECT_NE(outcome.out.find(one.words), std::string::npos) << outcome.out;
        EXPECT_NE(ropsim_test::file_text(folder.path() / "report.html").find(one.words), std::string::npos);
    }
}

TEST(CliWords, CASE_F13_AProgramHasItsOwnNumberOfEntries) {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "one.kb").string();
    ropsim_test::write_text(file, "program \"one\" \"the nearest fragment\";\nk 1;\nentry r, g, b, z;\n"
                                  "empty z = largest;\norder any;\nfragment { if f.z < e[0].z { e[0] = f; } }\n");
    const std::vector<std::string> arguments{"run",    "gen:stack?n=4", "--program",   file,
                                             "--size", "16x16",         "--no-images", "--json"};
    const ProgramOutcome outcome = run_program(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_EQ(json::parse(outcome.out)["scene"]["kbuffer"]["k"], 1);
    const ProgramOutcome other = run_program(with(arguments, {"--k", "4"}));
    EXPECT_EQ(other.status, 1);
    EXPECT_NE(other.error.find("k: expected 1, got 4"), std::string::npos) << other.error;
}

TEST(CliWords, MessagesQuoteWhatWasTyped) {
    struct Case {
        std::vector<std::string> arguments;
        std::string says;
    };
    const std::vector<Case> cases{{{"--k", "4.5"}, "4.5"},
                                  {{"--set", "rop.queue=4.5"}, "4.5"},
                                  {{"--set", "rop.queue=8", "--set", "rop.queue=16"},
                                   "--set: 'rop.queue' is set twice, by 'rop.queue=8' and 'rop.queue=16'"},
                                  {{"--set", "workload.opacity=1", "--set", "workload.opacity=0.5"}, "is set twice"},
                                  {{"--k", "3", "--set", "workload.k=3"}, "'k' is set twice"},
                                  {{"--gpu", "missing.toml"}, "missing.toml: there is no such file"},
                                  {{"--gpu", "/"}, "/"},
                                  {{"--program", "missing.kb"}, "missing.kb: there is no such file"}};
    for (const Case& one : cases) {
        const ProgramOutcome outcome = run_program(with({"run", "gen:stack", "--size", "16x16"}, one.arguments));
        EXPECT_EQ(outcome.status, 1);
        EXPECT_NE(outcome.error.find(one.says), std::string::npos) << outcome.error;
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    }
    const ProgramOutcome truth =
        run_program({"truth", "gen:stack", "--size", "16x16", "--set", "workload.k=1", "--set", "workload.k=2"});
    EXPECT_NE(truth.error.find("is set twice"), std::string::npos) << truth.error;
    const ProgramOutcome geometry =
        run_program({"geometry", "gen:stack", "--set", "memory.partitions=1", "--set", "memory.partitions=2"});
    EXPECT_NE(geometry.error.find("is set twice"), std::string::npos) << geometry.error;
}

TEST(CliWords, FilesThatAreMissingUnreadableOrTooLargeAreToldApart) {
    const TemporaryFolder folder;
    const std::string large = (folder.path() / "large.kb").string();
    ropsim_test::write_text(large, std::string((1U << 20U) + 1, ' '));
    const auto error = [](const std::string& file) {
        return run_program({"run", "gen:stack", "--size", "16x16", "--program", file}).error;
    };
    EXPECT_NE(error(large).find("expected a file of at most 1,048,576 bytes"), std::string::npos) << error(large);
    std::filesystem::create_directory(folder.path() / "folder.kb");
    EXPECT_NE(error((folder.path() / "folder.kb").string()).find("got a folder"), std::string::npos);
    if (::geteuid() == 0) return; // who may read everything
    ropsim_test::write_text(folder.path() / "closed.kb", "k 1;");
    std::filesystem::permissions(folder.path() / "closed.kb", std::filesystem::perms::none);
    EXPECT_NE(error((folder.path() / "closed.kb").string()).find("cannot be read: Permission denied"),
              std::string::npos);
}

TEST(CliWords, OneIsNotMany) {
    const TemporaryFolder folder;
    ropsim_test::write_text(folder.path() / "one.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                       "max": [1, 1, 0]}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
                                                        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}");
    const std::string scene = (folder.path() / "one.gltf").string();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"compare", scene, "--size", "16x16", "--designs", "blender", "--no-images"},
          {"geometry", scene}}) {
        const ProgramOutcome outcome = run_program(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.error;
        EXPECT_NE(outcome.out.find("1 triangle"), std::string::npos) << outcome.out;
        EXPECT_EQ(outcome.out.find("1 triangles"), std::string::npos) << outcome.out;
    }
}

TEST(CliWords, CASE_F16_StandardErrorThatCannotBeWrittenAbortsNothing) {
    for (const char* redirection : {"2>&-", "2>/dev/full", "2>&1 1>&- 2>&-"}) {
        const std::string shell = "'" + ropsim_test::program().string() + "' run missing.glb " + redirection;
        const int status = std::system(shell.c_str());
        ASSERT_TRUE(WIFEXITED(status)) << redirection;
        EXPECT_EQ(WEXITSTATUS(status), 1) << redirection;
    }
}

TEST(CliWords, CASE_F16_ClosedStreamsAreNotTakenForFiles) {
    const TemporaryFolder folder;
    const std::string shell = "cd '" + folder.path().string() + "' && '" + ropsim_test::program().string() +
                              "' run gen:stack --size 16x16 --no-images --out o 1>&- 2>&-; test $? = 1";
    EXPECT_EQ(std::system(shell.c_str()), 0);
    for (const std::string& file : folder.files())
        EXPECT_EQ(ropsim_test::file_text(folder.path() / file).find("cannot be written"), std::string::npos) << file;
}

TEST(CliWords, CASE_F17_EveryCommandEndsWithinASecond) {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "x.glb").string();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"geometry", "gen:blob?triangles=3000000", "--prepare", "recommended", "--export",
                                   file},
          {"run", "gen:blob?triangles=3000000", "--size", "4096x4096", "--out", folder.path().string()},
          {"truth", "gen:blob?triangles=3000000", "--size", "2048x2048", "--no-cache", "--check"},
          {"study", "cache_size", "--out", folder.path().string()}}) {
        ProgramOptions options;
        std::chrono::steady_clock::time_point sent;
        options.while_running = [&sent](pid_t child) {
            std::this_thread::sleep_for(std::chrono::seconds(1));
            sent = std::chrono::steady_clock::now();
            ::kill(child, SIGINT);
        };
        const ProgramOutcome outcome = run_program(arguments, options);
        if (outcome.error.find("ray tracing") != std::string::npos) continue;
        EXPECT_EQ(outcome.status, 130) << arguments.front() << outcome.error;
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - sent).count();
        EXPECT_LT(seconds, tests::sanitized ? 10.0 : 2.0) << arguments.front();
    }
    for (const std::string& name : folder.files()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
}

TEST(CliWords, AFileThatGrowsTooLargeCannotBeWritten) {
    const TemporaryFolder folder;
    const std::string shell = "ulimit -f 8; cd '" + folder.path().string() + "'; '" + ropsim_test::program().string() +
                              "' run gen:stack --size 64x64 --no-images --out o 2> error; test $? = 1";
    EXPECT_EQ(std::system(shell.c_str()), 0);
    const std::string error = ropsim_test::file_text(folder.path() / "error");
    EXPECT_NE(error.find("cannot be written: File too large"), std::string::npos) << error;
}

TEST(CliWords, AReusedFolderHoldsNothingOfAnEarlierRun) {
    const TemporaryFolder folder;
    const std::string out = folder.path().string();
    const auto compare = [&out](const char* designs) {
        const ProgramOutcome outcome =
            run_program({"compare", "gen:stack", "--size", "16x16", "--designs", designs, "--no-images", "--out", out});
        EXPECT_EQ(outcome.status, 0) << outcome.error;
    };
    compare("blender");
    const std::vector<std::string> alone = folder.files();
    ropsim_test::write_text(folder.path() / "mine.txt", "not ropsim's");
    ASSERT_EQ(run_program({"geometry", "gen:stack", "--out", out}).status, 0);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "result.json"));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "geometry.json"));
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "mine.txt"));
    compare("blender");
    std::filesystem::remove(folder.path() / "mine.txt");
    EXPECT_EQ(folder.files(), alone);
}

TEST(CliWords, HelpNamesTheMatricesThatACameraMayBe) {
    EXPECT_EQ(times(run_program({"compare", "--help"}).out, "scene.view"), 1U);
}

TEST(CliWords, TablesFitNarrowTerminals) {
    ProgramOptions narrow;
    narrow.environment = {"COLUMNS=40"};
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"compare", "gen:stack", "--size", "16x16", "--no-images"},
          {"run", "gen:stack", "--size", "16x16", "--no-images"},
          {"geometry", "gen:blob?triangles=800"},
          {"describe", "designs"}}) {
        const ProgramOutcome outcome = run_program(arguments, narrow);
        ASSERT_EQ(outcome.status, 0) << outcome.error;
        std::size_t begin = 0;
        for (std::size_t end = outcome.out.find('\n'); end != std::string::npos; end = outcome.out.find('\n', begin)) {
            EXPECT_LE(end - begin, 40U) << arguments.front() << ": " << outcome.out.substr(begin, end - begin);
            begin = end + 1;
        }
    }
}

// Lists, and the same triangles as strips whose stitches are triangles without area.
TEST(CliWords, CASE_F6_StitchesAreNotSetUp) {
    const TemporaryFolder folder;
    const std::string strips = (folder.path() / "s.glb").string(), mesh = "gen:blob?triangles=800";
    ASSERT_EQ(run_program({"geometry", mesh, "--prepare", "strips", "--export", strips}).status, 0);
    const json frame = json::parse(
        run_program({"run", strips, "--workload", "geometry", "--size", "16x16", "--no-images", "--json"}).out);
    const json feed = json::parse(run_program({"geometry", strips, "--prepare", "batch", "--json"}).out)["cases"][0];
    const json &one = frame["designs"][0]["stages"], &other = feed["stages"];
    const json& culled = other["clip_cull"]["counters"]["culled_degenerate"];
    EXPECT_GT(culled.get<int>(), 0);
    EXPECT_EQ(one["clip_cull"]["counters"]["culled_degenerate"], culled);
    EXPECT_EQ(other["triangle_setup"]["counters"]["triangles"], 800);
}

TEST(CliWords, CASE_F10_OneMeaningOfAcmr) {
    const TemporaryFolder folder;
    const std::string strips = (folder.path() / "s.glb").string();
    ASSERT_EQ(run_program({"geometry", "gen:blob?triangles=800", "--prepare", "strips", "--export", strips}).status, 0);
    for (const char* fidelity : {"estimate", "detailed"}) {
        const json result = json::parse(run_program({"geometry", strips, "--json", "--fidelity", fidelity}).out);
        for (const json& one : result["cases"]) {
            if (one["mesh"]["draws"] != 1) continue;
            EXPECT_DOUBLE_EQ(one["mesh"]["acmr"].get<double>(), one["draws"][0]["acmr"].get<double>())
                << one["name"] << " " << fidelity;
        }
    }
}

TEST(CliWords, EqualMachinesRunOnce) {
    const std::vector<std::string> arguments{"compare", "gen:stack", "--workload",
                                             "opaque",  "--designs", "blender,scoreboard",
                                             "--size",  "16x16",     "--no-images"};
    const ProgramOutcome table = run_program(arguments);
    EXPECT_EQ(times(table.out, "equal machines were run once: scoreboard as blender"), 1U) << table.out;
    const json document = json::parse(run_program(with(arguments, {"--json"})).out);
    const json &one = document["designs"][0], &other = document["designs"][1];
    EXPECT_EQ(one["cycles"], other["cycles"]);
    EXPECT_EQ(one["stages"], other["stages"]);
    EXPECT_EQ(other["id"], "scoreboard");
    EXPECT_GT(document["host"]["designs"][0]["cpu_seconds"].get<double>(), 0.0);
    EXPECT_EQ(document["host"]["designs"][1]["seconds"], 0);
}

} // namespace cli_words_test
