// What a user can get wrong ends with one line that says so, and with the exit status that fits.
#include "tests/support/program_run.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace cli_bad_input_test {

using ropsim_test::run_program;
using ropsim_test::TemporaryFolder;

struct Mistake {
    std::vector<std::string> arguments;
    int status;
    std::string says; ///< part of the line
};

void expect_one_line(const ropsim_test::ProgramOutcome& outcome, const Mistake& mistake) {
    std::string command;
    for (const std::string& argument : mistake.arguments) command += argument + " ";
    EXPECT_EQ(outcome.status, mistake.status) << command << outcome.error;
    EXPECT_EQ(outcome.out, "") << command;
    EXPECT_TRUE(outcome.error.starts_with("ropsim: ")) << command << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << command << outcome.error;
    EXPECT_NE(outcome.error.find(mistake.says), std::string::npos) << command << outcome.error;
}

std::vector<std::string> compare_with(const std::string& option, const std::string& value) {
    return {"compare", "gen:stack", "--size", "16x16", option, value};
}

class CliBadInput : public ::testing::TestWithParam<Mistake> {};

TEST_P(CliBadInput, IsOneLineAndTheRightStatus) { expect_one_line(run_program(GetParam().arguments), GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Arguments, CliBadInput,
    ::testing::Values(
        Mistake{{},
                2,
                "expected a subcommand: compare, run, truth, accuracy, geometry, validate, calibrate, study, "
                "sensitivity, stability, capture, record, import, replay, trace, describe"},
        Mistake{{"record", "-o", "x.rtrace"}, 2, "program is required"},
        Mistake{{"record", "--frames", "3", "-o", "x.rtrace", "true"}, 2, "expected two numbers as in 2:5, got '3'"},
        Mistake{{"record", "--frames", "3:3", "-o", "x.rtrace", "true"}, 2, "expected at least one frame, got '3:3'"},
        Mistake{{"record", "--frame", "3:4", "-o", "x.rtrace", "true"}, 2, "did you mean '--frames'?"},
        Mistake{{"record", "-o", "x.rtrace", "glxgears", "-info"}, 2, "unknown option -info (those of the program"},
        Mistake{{"record", "-o", "/no/such/x.rtrace", "--", "true"},
                1,
                "/no/such/x.rtrace: cannot be written: No such file or directory"},
        Mistake{{"record", "-o", "/dev/full", "--", "true"}, 1, "/dev/full: expected the name of a file to write"},
        Mistake{{"record", "-o", "/", "--", "true"}, 1, "/: expected the name of a file to write"},
        Mistake{{"capture", "gen:stack", "-o", "/dev/null"}, 1, "/dev/null: expected the name of a file to write"},
        Mistake{{"import", "none.trace"}, 2, "--output is required"},
        Mistake{{"import", "none.trace", "-o", "x.rtrace"}, 1, "none.trace: expected a file that can be read"},
        Mistake{{"compar"}, 2, "did you mean 'compare'?"}, Mistake{{"compare"}, 2, "scene is required"},
        Mistake{{"compare", "gen:stack", "--desings", "x"}, 2, "did you mean '--designs'?"},
        Mistake{{"compare", "gen:stack", "more"}, 2, "unexpected argument 'more'"},
        Mistake{{"compare", "gen:stack", "--size"}, 2, "--size"},
        Mistake{{"run", "gen:stack", "--timeline"}, 2, "--timeline requires --out"},
        Mistake{{"run", "gen:stack", "--designs", "blender"}, 2, "did you mean '--design'?"},
        Mistake{{"accuracy", "gen:stack", "--workload", "opaque"}, 1, "expected a workload with a truth and knobs"},
        Mistake{{"accuracy", "gen:stack", "--sweep", "k"}, 1, "--sweep: expected KNOB=VALUE,VALUE..., got 'k'"},
        Mistake{{"accuracy", "gen:stack", "--sweep", "kk=1"}, 1, "unknown key 'kk'"},
        Mistake{{"accuracy", "gen:stack", "--k", "2", "--sweep", "k=1"}, 1, "--sweep: 'k' is set for all points"},
        Mistake{{"accuracy", "gen:stack", "--sweep", "k=1", "--averaged", "4"}, 1, "--averaged"},
        Mistake{{"accuracy", "gen:stack", "--design", "a,b"}, 1, "--design: expected one design"},
        Mistake{{"sensitivity", "gen:stack", "--factor", "1"}, 1, "--factor: expected a number above 1"},
        Mistake{{"sensitivity", "gen:stack", "--size", "16x16", "--parameters", "rop.quee"},
                1,
                "did you mean 'rop.queue'?"},
        Mistake{{"stability", "--filter", "half.tye"}, 1, "did you mean 'half.tie'?"},
        Mistake{{"describe", "scorebord"}, 1, "did you mean 'scoreboard'?"}));

INSTANTIATE_TEST_SUITE_P(
    Values, CliBadInput,
    ::testing::Values(Mistake{compare_with("--k", "0"), 1, "k: expected whole number 1 to 64, got 0"},
                      Mistake{compare_with("--k", "65"), 1, "k: expected whole number 1 to 64, got 65"},
                      Mistake{compare_with("--k", "four"), 1, "k: expected whole number 1 to 64"},
                      Mistake{compare_with("--entry", "rgb"), 1, "did you mean 'rgbz'?"},
                      Mistake{{"compare", "gen:stack", "--size", "0x0"}, 1, "--size: expected WIDTHxHEIGHT"},
                      Mistake{{"compare", "gen:stack", "--size", "100000x100000"}, 1, "1 to 16384"},
                      Mistake{{"compare", "gen:stack", "--size", "16384x16384", "--k", "64"}, 1, "memory"},
                      Mistake{{"compare", "gen:stack", "--size", "-4x4"}, 1, "--size"},
                      Mistake{compare_with("--samples", "2"), 1, "--samples: expected 1, 4 or 8, got '2'"},
                      Mistake{compare_with("--samples", "many"), 1, "--samples: expected 1, 4 or 8"},
                      Mistake{{"compare", "gen:stack", "--size", "8x16384", "--samples", "8"}, 1, "at most 8192 rows"},
                      Mistake{compare_with("--designs", "blendr"), 1, "did you mean 'blender'?"},
                      Mistake{compare_with("--designs", "blender,blender"), 1, "named twice"},
                      Mistake{compare_with("--designs", ","), 1, "separated by commas"},
                      Mistake{compare_with("--designs", "existing?visibilty=x"), 1,
                              "did you mean 'existing.visibility'?"},
                      Mistake{compare_with("--designs", "blender?scene=gen:stack"), 1, "is of the frame"},
                      Mistake{compare_with("--equal-area", "much"), 1, "--equal-area: expected bytes"},
                      Mistake{compare_with("--equal-area", "10"), 1, "no design fits into 10 bytes"},
                      Mistake{compare_with("--gpu", "neutrl"), 1, "did you mean 'neutral'?"},
                      Mistake{compare_with("--workload", "transparancy"), 1, "did you mean 'transparency'?"},
                      Mistake{compare_with("--set", "rop.quue=3"), 1, "did you mean 'rop.queue'?"},
                      Mistake{compare_with("--set", "rop.queue"), 1, "expected SECTION.KEY=VALUE"},
                      Mistake{compare_with("--set", "rop.queue=many"), 1, "rop.queue"},
                      Mistake{compare_with("--set", "workload.opcity=1"), 1, "did you mean 'opacity'?"},
                      Mistake{compare_with("--threads", "0"), 1, "--threads: expected a whole number from 1 to 1024"},
                      Mistake{compare_with("--seed", "-1"), 1, "--seed"},
                      Mistake{compare_with("--camera", "7"), 1, "camera '7'"},
                      Mistake{compare_with("--camera", "1,2,3"), 1, "ex,ey,ez,tx,ty,tz,fovy"},
                      Mistake{{"compare", "gen:stak"}, 1, "did you mean 'stack'?"}));

INSTANTIATE_TEST_SUITE_P(
    GeometryFeed, CliBadInput,
    ::testing::Values(
        Mistake{{"geometry", "gen:stack", "--prepare", "reordr"}, 1, "did you mean 'reorder'?"},
        Mistake{{"geometry", "gen:stack", "--prepare", "batch?vertices=2"}, 1, "vertices: expected 0 or at least 3"},
        Mistake{{"geometry", "gen:stack", "--submission", "bufers"}, 1, "did you mean 'buffers'?"},
        Mistake{{"geometry", "gen:stack", "--fidelity", "exact"}, 1, "--fidelity: expected one of estimate, detailed"},
        Mistake{{"geometry", "gen:stack", "--reads", "some"}, 1, "--reads: expected all or position"},
        Mistake{{"geometry", "gen:stack", "--export", "x.glb"}, 1, "--export: expected a --prepare"},
        Mistake{{"geometry", "gen:grass?blades=10", "--prepare", "batch", "--export", "/no/such/x.glb"}, 1, "/no/such"},
        Mistake{{"geometry", "gen:grass?index=u16"}, 1, "at most 65536 vertices in a draw"},
        Mistake{{"geometry", "gen:grass?attributes=normal:5f32"}, 1, "1 to 4 components"},
        Mistake{{"geometry"}, 2, "scene is required"},
        Mistake{{"validate", "geometri"}, 1, "expected geometry, peeling or deferred, got 'geometri'"},
        Mistake{{"validate", "geometry", "--gpus", "g80"}, 1, "'g80' was not measured"},
        Mistake{{"validate", "peeling", "--gpus", "g70"}, 1, "'g70' was not measured"},
        Mistake{{"validate", "peeling", "--lights", "2"}, 1, "validate peeling has neither"},
        Mistake{{"validate", "deferred", "--gpus", "g70"}, 1, "'g70' was not measured"},
        Mistake{{"validate", "deferred", "--lights", "3"}, 1, "3 were not measured"},
        Mistake{{"validate", "deferred", "--size", "0x0"}, 1, "'0x0'"},
        Mistake{{"validate", "peeling", "--fidelity", "estimate"}, 1, "expected one of sampled, detailed"},
        Mistake{{"calibrate", "geometry", "--write", "/no/such"}, 1, "--write: /no/such"},
        Mistake{{"calibrate", "geometri"}, 1, "expected geometry or peeling, got 'geometri'"},
        Mistake{{"calibrate", "geometry", "--gpus", "g80"}, 1, "'g80' was not measured"},
        Mistake{{"calibrate", "geometry", "--folds", "1"}, 1, "--folds: expected a whole number from 2 to 1000"},
        Mistake{{"calibrate", "geometry", "--folds", "two"}, 1, "--folds"},
        Mistake{{"calibrate", "geometry", "--folds", "2", "--write", "."}, 1, "--folds: what folds find is not"},
        Mistake{{"calibrate", "peeling", "--gpus", "g70"}, 1, "'g70' was not measured"},
        Mistake{{"calibrate", "peeling", "--fidelity", "estimate"}, 1, "expected one of sampled, detailed"},
        Mistake{{"study", "batchin"}, 1, "did you mean 'batching'?"},
        Mistake{{"study", "/no/such.toml"}, 1, "/no/such.toml: there is no such file"}));

std::vector<std::string> deferred_with(const std::string& option, const std::string& value) {
    return {"run", "gen:slabs", "--workload", "deferred", "--size", "16x16", option, value};
}

INSTANTIATE_TEST_SUITE_P(
    Deferred, CliBadInput,
    ::testing::Values(
        Mistake{deferred_with("--set", "workload.method=pn"), 1,
                "workload deferred: method: expected one of pm | dp | fwd | fw | kg, got \"pn\"; did you mean 'pm'?"},
        Mistake{deferred_with("--set", "workload.lights=-1"), 1, "lights: expected whole number 0 to 64, got -1"},
        Mistake{deferred_with("--set", "workload.lights=65"), 1, "lights: expected whole number 0 to 64, got 65"},
        Mistake{deferred_with("--set", "workload.lights=many"), 1,
                "lights: expected whole number 0 to 64, got \"many\""},
        Mistake{deferred_with("--set", "workload.lights=1.5"), 1, "lights: expected whole number 0 to 64, got 1.5"},
        Mistake{deferred_with("--set", "workload.map_size=0"), 1, "map_size: expected whole number 2 to 8192, got 0"},
        Mistake{deferred_with("--set", "workload.map_size=1"), 1, "map_size: expected whole number 2 to 8192, got 1"},
        Mistake{deferred_with("--set", "workload.map_size=8193"), 1, "map_size: expected whole number 2 to 8192"},
        Mistake{deferred_with("--set", "workload.refraction_coefficient=nan"), 1,
                "refraction_coefficient: expected number 0 to 1, got \"nan\""},
        Mistake{deferred_with("--set", "workload.refraction_coefficient=inf"), 1,
                "refraction_coefficient: expected number 0 to 1, got \"inf\""},
        Mistake{deferred_with("--set", "workload.refraction_coefficient=-1"), 1,
                "refraction_coefficient: expected number 0 to 1, got -1"},
        Mistake{deferred_with("--set", "workload.intensity=inf"), 1, "intensity: expected number 0 to 1000"},
        Mistake{deferred_with("--samples", "4"), 1, "whose rows are told apart by number, got 4"},
        Mistake{deferred_with("--camera", "1,0,0,0,0,1,0,0,0,0,1,0,0,0,-5,1,1,0,0,0,0,1,0,0,0,0,-0.1,0,0,0,-1,1"), 1,
                "workload deferred: expected a perspective camera, got a parallel projection"},
        Mistake{{"run", "gen:stack", "--workload", "deferred", "--size", "16x16"},
                1,
                "workload deferred: expected a scene with places in a world, those of gen:stack are on the screen"},
        Mistake{{"run", "gen:slabs", "--workload", "deferred", "--size", "0x1"}, 1, "--size: expected WIDTHxHEIGHT"},
        Mistake{{"run", "gen:slabs", "--workload", "deferred", "--size", "16x16385"}, 1, "1 to 16384 pixels"}));

// A triangle as glTF, so that one thing at a time can be made wrong.
std::string triangle(const std::string& buffer, int index_count, int largest_count, const std::string& length) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"buffers":[{"byteLength":)" +
           length + R"(,"uri":")" + buffer + R"("}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
"accessors":[{"bufferView":0,"componentType":5126,"count":)" +
           std::to_string(largest_count) +
           R"(,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5123,"count":)" +
           std::to_string(index_count) + R"(,"type":"SCALAR"}]})";
}

std::string bytes_of(const std::vector<float>& positions, const std::vector<std::uint16_t>& indices) {
    std::string bytes(reinterpret_cast<const char*>(positions.data()), positions.size() * 4);
    return bytes.append(reinterpret_cast<const char*>(indices.data()), indices.size() * 2);
}

class CliBadScene : public ::testing::Test {
  protected:
    void expect_refused(const std::string& file) {
        const std::string path = (folder.path() / file).string();
        const std::vector<std::string> arguments{"compare", path, "--size", "16x16", "--no-images"};
        expect_one_line(run_program(arguments), {arguments, 1, file});
    }
    void write(const std::string& name, const std::string& text) {
        ropsim_test::write_text(folder.path() / name, text);
    }
    TemporaryFolder folder;
    const std::vector<float> good{0, 0, 0, 1, 0, 0, 0, 1, 0};
};

TEST_F(CliBadScene, NoFile) { expect_refused("none.glb"); }

TEST_F(CliBadScene, NoGltf) {
    write("text.glb", "this is no scene");
    write("text.gltf", "this is no scene");
    write("empty.glb", "");
    for (const char* file : {"text.glb", "text.gltf", "empty.glb"}) expect_refused(file);
}

TEST_F(CliBadScene, TruncatedBinary) {
    write("short.glb", std::string("glTF\x02\0\0\0\xff\xff\0\0", 12));
    expect_refused("short.glb");
}

TEST_F(CliBadScene, MissingBuffer) {
    write("missing.gltf", triangle("nowhere.bin", 3, 3, "42"));
    expect_refused("missing.gltf");
}

TEST_F(CliBadScene, IndexOutOfRange) {
    write("a.bin", bytes_of(good, {0, 1, 9}));
    write("index.gltf", triangle("a.bin", 3, 3, "42"));
    expect_refused("index.gltf");
}

TEST_F(CliBadScene, AccessorBeyondItsBuffer) {
    write("a.bin", bytes_of(good, {0, 1, 2}));
    write("accessor.gltf", triangle("a.bin", 3, 3000, "42"));
    expect_refused("accessor.gltf");
}

TEST_F(CliBadScene, PositionsThatAreNoNumbers) {
    std::vector<float> positions = good;
    positions[4] = std::numeric_limits<float>::quiet_NaN();
    write("a.bin", bytes_of(positions, {0, 1, 2}));
    write("nan.gltf", triangle("a.bin", 3, 3, "42"));
    expect_refused("nan.gltf");
}

TEST_F(CliBadScene, NoTriangles) {
    write("nothing.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}]})");
    expect_refused("nothing.gltf");
}

TEST_F(CliBadScene, GoodOneIsAccepted) {
    write("a.bin", bytes_of(good, {0, 1, 2}));
    write("good.gltf", triangle("a.bin", 3, 3, "42"));
    const auto outcome = run_program({"compare", (folder.path() / "good.gltf").string(), "--size", "16x16"});
    EXPECT_EQ(outcome.status, 0) << outcome.error;
}

// What deferred shading takes, however odd it looks, and what it says of it.
TEST_F(CliBadScene, DeferredShadingWithLittleToShow) {
    write("a.bin", bytes_of(good, {0, 1, 2}));
    write("good.gltf", triangle("a.bin", 3, 3, "42"));
    const std::string path = (folder.path() / "good.gltf").string();
    const std::string small = "workload.map_size=16";
    const std::vector<std::pair<std::vector<std::string>, std::string>> uses{
        {{"--size", "16x16", "--set", small}, "some draws have no normals: those of their triangles are taken"},
        {{"--size", "16x16", "--set", "workload.lights=0"}, "no lights: surfaces are seen in the ambient light alone"},
        {{"--size", "16x16", "--set", "workload.map_size=3"}, ""},
        {{"--size", "1x1", "--set", small}, ""},
        {{"--size", "1x2", "--set", small}, ""},
        {{"--size", "16x16384", "--set", small, "--set", "workload.lights=1"}, ""}};
    for (const auto& [options, note] : uses) {
        std::vector<std::string> arguments{"run", path, "--workload", "deferred"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const auto outcome = run_program(arguments);
        EXPECT_EQ(outcome.status, 0) << options[1] << outcome.error;
        EXPECT_NE(outcome.out.find(note), std::string::npos) << options[1] << outcome.out;
    }
}

TEST_F(CliBadScene, DeferredShadingOfNothing) {
    write("nothing.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}]})");
    const std::vector<std::string> arguments{"run", (folder.path() / "nothing.gltf").string(), "--workload",
                                             "deferred"};
    expect_one_line(run_program(arguments), {arguments, 1, "nothing.gltf"});
}

} // namespace cli_bad_input_test
