// Replaying a captured frame gives the bytes of comparing it directly, whatever the workload.
#include "reports/comparison.hpp"
#include "reports/report_files.hpp"
#include "reports/result.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/schema.hpp"
#include "traces/glsl.hpp"
#include "traces/trace.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trace_replay_test {

using nlohmann::json;
using ropsim_test::file_text;
using ropsim_test::run_program;
using ropsim_test::TemporaryFolder;

struct Case {
    std::string scene, workload;
    std::vector<std::string> settings = {};
    std::uint32_t samples = 1;
    std::string camera = "auto";
};

const std::vector<Case> cases{
    {"gen:discs?n=40", "transparency", {"k=2", "background=[0.1,0.2,0.3]"}},
    {"gen:showroom", "transparency", {"program=mlab", "transparent=materials"}, 1, "4,3,6,0,0,0,40"},
    {"gen:stack?n=5", "transparency", {"program=nearest_k.kb"}, 4},
    {"gen:discs?n=40", "transparency", {"program=order_and_blend.glsl", "k=3", "opacity=0.3"}},
    {"gen:grid-soup?boxes=8", "opaque", {}, 8},
    {"gen:discs?n=40", "blended", {}},
    {"gen:grass?blades=20", "geometry"},
    {"gen:slabs", "translucency", {"fresnel=true"}},
    {"gen:csg", "csg", {"expression=A & !B"}},
    {"gen:planes", "depth-of-field", {}},
    {"gen:tetrahedra?n=3", "isosurface", {"iso=0.4"}},
    {"gen:tetrahedra?n=3", "volume"},
    {"gen:particles?n=60", "particles"},
    {"gen:blob?triangles=500+ground", "soft-shadows", {"map_size=32"}},
    // Its images are decoded when they are read.
    {(ropsim_test::source_dir() / "tests/fuzz/seeds/gltf/features.glb").string(), "opaque", {}},
    {"gen:showroom", "deferred", {"method=dp", "lights=2", "map_size=64"}},
};

reports::ComparisonRequest machine(std::vector<std::string> designs) {
    reports::ComparisonRequest request;
    request.gpu_settings = {"rop.queue=16"};
    request.designs = std::move(designs);
    request.only_able_designs = true;
    return request;
}

/// What tells a replay from the comparison, and nothing else, taken out.
json comparable(const reports::Comparison& comparison) {
    json result = json::parse(reports::result_text(reports::result_json(comparison)));
    result.erase("host");
    for (const char* key : {"name", "hash", "captured"}) result["scene"].erase(key);
    return result;
}

void expect_equal_files(const std::filesystem::path& a, const std::filesystem::path& b, const TemporaryFolder& one) {
    std::size_t compared = 0;
    for (const std::string& name : one.files()) {
        // Those that name the scene and the host's seconds; result.json is compared by its parts. The last one lists
        // the files in the order in which threads finished them.
        if (name == "report.html" || name == "result.json" || name == ".ropsim-files") continue;
        ++compared;
        EXPECT_EQ(file_text(a / name), file_text(b / name)) << name;
    }
    EXPECT_GT(compared, 2U);
}

class TraceReplayOf : public ::testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        for (const std::string& setting : GetParam().settings)
            if (setting.ends_with(".glsl") && !traces::can_compile_glsl()) GTEST_SKIP() << "built without glslang";
    }
};

TEST_P(TraceReplayOf, GivesTheSameBytes) {
    const Case& one = GetParam();
    const TemporaryFolder folder, directly, replayed;
    reports::ComparisonRequest request = machine({"existing", "blender"});
    request.scene = one.scene;
    request.camera = one.camera;
    request.workload = one.workload;
    request.workload_settings = one.settings;
    request.width = 24;
    request.height = 20;
    request.samples = one.samples;
    const reports::Comparison direct = reports::compare(reports::prepare(request));

    const std::string file = (folder.path() / "x.rtrace").string();
    traces::write_trace(traces::capture({.scene = one.scene,
                                         .camera = one.camera,
                                         .width = 24,
                                         .height = 20,
                                         .samples = one.samples,
                                         .workload = one.workload,
                                         .settings = one.settings,
                                         .writer = "a test",
                                         .name = {},
                                         .licence = {}}),
                        file);
    reports::ComparisonRequest again = machine({"existing", "blender"});
    again.scene = file;
    again.replay = true;
    const reports::Comparison replay = reports::compare(reports::prepare(again));

    EXPECT_EQ(comparable(replay), comparable(direct));
    EXPECT_EQ(replay.scene.name, "x.rtrace");
    ASSERT_TRUE(replay.scene.captured);
    EXPECT_EQ(replay.scene.captured->name, direct.scene.name);
    EXPECT_EQ(replay.scene.captured->hash, direct.scene.hash);
    EXPECT_EQ(replay.reference.composite, direct.reference.composite);
    ASSERT_EQ(replay.pixels.size(), direct.pixels.size());
    for (std::size_t i = 0; i < direct.pixels.size(); ++i) {
        EXPECT_EQ(replay.pixels[i].composite, direct.pixels[i].composite);
        EXPECT_EQ(replay.pixels[i].kbuffer, direct.pixels[i].kbuffer);
        EXPECT_EQ(replay.pixels[i].colour, direct.pixels[i].colour);
        EXPECT_EQ(replay.pixels[i].depth, direct.pixels[i].depth);
    }
    reports::write_report(direct, directly.path(), {false, nullptr});
    reports::write_report(replay, replayed.path(), {false, nullptr});
    EXPECT_EQ(directly.files(), replayed.files());
    expect_equal_files(directly.path(), replayed.path(), directly);
}

INSTANTIATE_TEST_SUITE_P(Workloads, TraceReplayOf, ::testing::ValuesIn(cases),
                         [](const auto& one) { return fmt::format("{}", one.index); });

TEST(TraceReplay, EveryWorkloadIsAmongThem) {
    for (const traces::Workload& workload : traces::workloads())
        EXPECT_TRUE(std::any_of(cases.begin(), cases.end(), [&](const Case& one) {
            return one.workload == workload.id;
        })) << workload.id;
}

TEST(TraceReplay, TheProgramWritesTheSamePicturesAndFollowsTheSchema) {
    const TemporaryFolder folder, directly, replayed;
    const std::string file = (folder.path() / "x.rtrace").string();
    const std::vector<std::string> frame{"gen:discs?n=60", "--size", "32x32", "--k", "3"};
    std::vector<std::string> compare{"compare"}, capture{"capture"};
    compare.insert(compare.end(), frame.begin(), frame.end());
    capture.insert(capture.end(), frame.begin(), frame.end());
    compare.insert(compare.end(), {"--designs", "existing,scoreboard", "--out", directly.path().string()});
    capture.insert(capture.end(), {"-o", file, "--licence", "none"});
    const auto captured = run_program(capture);
    ASSERT_EQ(captured.status, 0) << captured.error;
    EXPECT_NE(captured.out.find("1 draw of 1,920 triangles"), std::string::npos) << captured.out;
    ASSERT_EQ(run_program(compare).status, 0);
    const auto replay =
        run_program({"replay", file, "--designs", "existing,scoreboard", "--out", replayed.path().string(), "--json"});
    ASSERT_EQ(replay.status, 0) << replay.error;
    EXPECT_EQ(directly.files(), replayed.files());
    expect_equal_files(directly.path(), replayed.path(), directly);
    const json schema = json::parse(file_text(ropsim_test::source_dir() / "reports/result.schema.json"));
    const json result = json::parse(replay.out);
    EXPECT_EQ(ropsim_test::schema_violations(schema, result), std::vector<std::string>());
    EXPECT_EQ(result["scene"]["captured"]["name"], "gen:discs?n=60");
}

TEST(TraceReplay, AProgramOfTheUsersTravelsInTheTrace) {
    const TemporaryFolder folder;
    const auto program = folder.path() / "one.kb";
    ropsim_test::write_text(program, "program \"one\" \"the nearest fragment\";\nk 1;\nentry r, g, b, z;\n"
                                     "empty z = largest;\norder any;\nfragment { if f.z < e[0].z { e[0] = f; } }\n");
    const std::string file = (folder.path() / "x.rtrace").string();
    ASSERT_EQ(
        run_program({"capture", "gen:stack?n=4", "--size", "16x16", "--program", program.string(), "-o", file}).status,
        0);
    std::filesystem::remove(program);
    const auto replay = run_program({"replay", file, "--designs", "blender", "--json"});
    ASSERT_EQ(replay.status, 0) << replay.error;
    EXPECT_EQ(json::parse(replay.out)["scene"]["kbuffer"]["program"], "one");
}

TEST(TraceReplay, TheSceneOfATraceCanBeDrawnInOtherWays) {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "x.rtrace").string();
    ASSERT_EQ(run_program({"capture", "gen:slabs", "--size", "16x16", "-o", file}).status, 0);
    const auto outcome = run_program({"compare", file + "+ground", "--workload", "opaque", "--size", "16x16",
                                      "--designs", "existing", "--no-images", "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_EQ(json::parse(outcome.out)["scene"]["name"], "x.rtrace+ground");
}

TEST(TraceReplay, SubcommandsSayWhatATraceIs) {
    const TemporaryFolder folder;
    const std::string a = (folder.path() / "a.rtrace").string(), b = (folder.path() / "b.rtrace").string();
    ASSERT_EQ(run_program({"capture", "gen:csg", "--size", "16x16", "-o", a}).status, 0);
    ASSERT_EQ(run_program({"capture", "gen:csg", "--size", "16x8", "-o", b}).status, 0);
    const auto info = run_program({"trace", "info", a});
    EXPECT_EQ(info.status, 0) << info.error;
    for (const char* part : {"2 draws", "passes: ", "rgba32f", "vertex formats: ", "BLOB", "DONE"})
        EXPECT_NE(info.out.find(part), std::string::npos) << part << info.out;
    EXPECT_EQ(run_program({"trace", "validate", a}).status, 0);
    EXPECT_EQ(run_program({"trace", "diff", a, a}).status, 0);
    const auto diff = run_program({"trace", "diff", a, b});
    EXPECT_EQ(diff.status, 1);
    EXPECT_NE(diff.out.find("CAPT: height: 16 | 8"), std::string::npos) << diff.out;
    const auto dump = run_program({"trace", "dump", a});
    EXPECT_NE(dump.out.find("geometry 0 attribute 0: semantic=position type=f32"), std::string::npos) << dump.out;
    std::string bytes = file_text(a);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    ropsim_test::write_text(a, bytes);
    const auto faulty = run_program({"trace", "validate", a});
    EXPECT_EQ(faulty.status, 1);
    EXPECT_NE(faulty.out.find("a.rtrace: byte "), std::string::npos) << faulty.out;
    EXPECT_EQ(run_program({"replay", a}).status, 1);
    EXPECT_NE(run_program({"replay", b, "--set", "workload.k=2"}).error.find("a trace has its own"), std::string::npos);
    EXPECT_EQ(run_program({"trace", "inof", a}).status, 2);
    EXPECT_EQ(run_program({"trace", "diff", a}).status, 2);
    const auto cut = run_program({"trace", "cut", b, "--frames", "0:1", "-o", a});
    EXPECT_EQ(cut.status, 1);
    EXPECT_NE(cut.error.find("expected recorded frames to cut, got a captured one"), std::string::npos) << cut.error;
    EXPECT_EQ(run_program({"trace", "info", b, "--frames", "0:1"}).status, 2);
}

TEST(TraceReplay, SubcommandsSayWhatARecordedTraceIs) {
    const TemporaryFolder folder;
    const std::string a = (folder.path() / "a.rtrace").string(), b = (folder.path() / "b.rtrace").string();
    traces::write_trace(support::recorded_trace(support::rich_recording()), a);
    const auto info = run_program({"trace", "info", a});
    EXPECT_EQ(info.status, 0) << info.error;
    for (const char* part :
         {"a.rtrace: 2 frames of 118 draws, ", "recorded from: a program", "frame 7: 16 x 12, 18 draws in ",
          ", 2 clears, 1 copy, ", "frame 9: ", "surfaces r8: ", "2 programs, 2 textures",
          "not recorded: glPolygonMode (3 times)", "vertex formats: ", "FRAM", "OMIT"})
        EXPECT_NE(info.out.find(part), std::string::npos) << part << "\n" << info.out;
    const auto document = run_program({"trace", "info", a, "--json"});
    const json facts = json::parse(document.out);
    EXPECT_EQ(facts["frames"][1]["draws"], 100);
    EXPECT_EQ(facts["frames"][1]["passes"], 1);
    EXPECT_EQ(facts["frames"][1]["vertices"], 600);
    EXPECT_EQ(facts["frames"][1]["primitives"], 200);
    EXPECT_EQ(facts["not_recorded"][0]["times"], 3);
    EXPECT_EQ(run_program({"trace", "validate", a}).out, "");

    const auto cut = run_program({"trace", "cut", a, "--frames", "9:10", "--draws", "10:12", "-o", b});
    EXPECT_EQ(cut.status, 0) << cut.error;
    EXPECT_NE(cut.out.find("b.rtrace: 1 frame of 2 draws, 4 primitives"), std::string::npos) << cut.out;
    EXPECT_EQ(run_program({"trace", "validate", b}).status, 0);
    EXPECT_EQ(run_program({"trace", "diff", a, b}).status, 1);
    const auto none = run_program({"trace", "cut", a, "--frames", "3:4", "-o", b});
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.error.find("a.rtrace: expected frames within 7:10, at least one, got 3:4"), std::string::npos)
        << none.error;
    EXPECT_EQ(run_program({"trace", "cut", a, "--frames", "3", "-o", b}).status, 2);
    EXPECT_EQ(run_program({"trace", "cut", a, "-o", b}).status, 2);
    EXPECT_EQ(run_program({"trace", "cut", a, "--frames", "7:8"}).status, 2);
}

} // namespace trace_replay_test
