// Inputs that went wrong for somebody, by their id; ../shared/cases/README.md says what is right and why.
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace cases_input_test {

using nlohmann::json;
using ropsim_test::run_program;

const std::filesystem::path inputs = "cases/inputs";

std::string input(const std::string& name) {
    const auto file = ropsim_test::shared_file(inputs / name);
    return file ? file->string() : std::string();
}

// With GTEST_SKIP in the test's own body, so that it ends there.
#define SKIP_WITHOUT_CASES()                                                                                           \
    if (!ropsim_test::shared_file(inputs)) GTEST_SKIP() << "no folder " << inputs << " among the further files"

json compared(const std::string& scene, const std::vector<std::string>& further = {}) {
    std::vector<std::string> arguments{"compare", scene, "--size", "64x64", "--no-images", "--json"};
    if (std::find(further.begin(), further.end(), "--designs") == further.end())
        arguments.insert(arguments.end(), {"--designs", "blender"});
    arguments.insert(arguments.end(), further.begin(), further.end());
    const auto outcome = run_program(arguments);
    EXPECT_EQ(outcome.status, 0) << scene << ": " << outcome.error;
    return outcome.status == 0 ? json::parse(outcome.out) : json();
}

struct Drawn {
    int triangles = 0, fragments = 0;

    bool operator==(const Drawn&) const = default;
    friend std::ostream& operator<<(std::ostream& out, const Drawn& drawn) {
        return out << drawn.triangles << " triangles, " << drawn.fragments << " fragments";
    }
};

Drawn drawn(const std::string& name, const std::vector<std::string>& further = {}) {
    const json result = compared(input(name), further);
    if (result.is_null()) return {};
    return {result["scene"]["triangles_drawn"], result["designs"][0]["fragments"]};
}

std::string notes_of(const json& result) { return result.is_null() ? "" : result["scene"]["notes"].dump(); }

TEST(InputCases, CASE_F1) {
    SKIP_WITHOUT_CASES();
    EXPECT_EQ(drawn("three.gltf"), (Drawn{6, 456}));
    EXPECT_EQ(drawn("three_child_1.0.gltf"), (Drawn{6, 456}));
    EXPECT_EQ(drawn("plain.gltf"), (Drawn{2, 1024}));
    EXPECT_EQ(drawn("indices_dot0.gltf"), (Drawn{2, 1024}));
    const auto refused = run_program({"compare", input("three_indices_neg.gltf"), "--no-images"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.error.find("meshes[0].primitives[0].indices: expected the number of one of 2 accessors, got -1"),
              std::string::npos)
        << refused.error;
}

TEST(InputCases, CASE_F2) {
    SKIP_WITHOUT_CASES();
    const ropsim_test::TemporaryFolder small, large;
    const auto picture = [](const std::string& name, const std::string& iso, const std::filesystem::path& folder) {
        const auto outcome = run_program({"compare", input(name), "--designs", "blender", "--workload", "isosurface",
                                          "--set", "workload.iso=" + iso, "--size", "32x32", "--out", folder.string()});
        EXPECT_EQ(outcome.status, 0) << outcome.error;
    };
    picture("p1.vtk", "[3.5]", small.path());
    picture("p1e4.vtk", "[35000]", large.path());
    EXPECT_EQ(ropsim_test::file_text(small.path() / "reference" / "composite.png"),
              ropsim_test::file_text(large.path() / "reference" / "composite.png"));
    const auto notes = [](const char* iso) {
        return notes_of(compared(input("p1e4.vtk"), {"--workload", "isosurface", "--set", iso}));
    };
    EXPECT_EQ(notes("workload.iso=[35000]").find("iso-value"), std::string::npos);
    EXPECT_NE(notes("workload.iso=[70001]").find("iso-value 70001 has no surface: the scalars are 0 to 70000"),
              std::string::npos)
        << notes("workload.iso=[70001]");
}

TEST(InputCases, CASE_F3) {
    SKIP_WITHOUT_CASES();
    for (const char* name : {"box1e0.glb", "box1e5.glb", "boxat10000.glb"}) {
        const auto outcome = run_program({"accuracy", input(name) + "+ground", "--workload", "soft-shadows", "--size",
                                          "64x64", "--set", "workload.map_size=256", "--rays", "256", "--sweep",
                                          "layers=3", "--no-images", "--no-cache", "--json"});
        ASSERT_EQ(outcome.status, 0) << outcome.error;
        const json result = json::parse(outcome.out);
        EXPECT_NEAR(result["points"][0]["rmse"].get<double>(), 0.009, 0.003) << name;
        EXPECT_EQ(outcome.error.find("rgba16f cannot hold") != std::string::npos, std::string(name) != "box1e0.glb")
            << name;
    }
}

TEST(InputCases, CASE_F4) {
    SKIP_WITHOUT_CASES();
    const std::vector<std::string> material{"--set", "workload.faces=material"};
    const std::vector<std::string> opaque{"--workload", "opaque", "--designs", "existing"};
    EXPECT_EQ(drawn("root_plain.glb", material), (Drawn{4, 512}));
    EXPECT_EQ(drawn("root_mirror_x.glb", material), (Drawn{4, 512}));
    EXPECT_EQ(drawn("root_mirror_x.glb", opaque), drawn("root_plain.glb", opaque));
}

TEST(InputCases, CASE_F7) {
    SKIP_WITHOUT_CASES();
    EXPECT_EQ(drawn("mirrored.glb", {"--set", "workload.faces=material"}), (Drawn{2, 1024}));
}

TEST(InputCases, CASE_F8) {
    SKIP_WITHOUT_CASES();
    EXPECT_EQ(notes_of(compared(input("u8n.glb"))).find("COLOR_0"), std::string::npos);
    EXPECT_NE(notes_of(compared(input("u8_not_normalized.glb"))).find("COLOR_0 of integers that are not normalized"),
              std::string::npos);
}

TEST(InputCases, CASE_F11) {
    SKIP_WITHOUT_CASES();
    EXPECT_EQ(drawn("skin_plain.glb"), (Drawn{2, 1024}));
    EXPECT_EQ(drawn("no_ibm.glb"), (Drawn{2, 1024}));
}

TEST(InputCases, CASE_F12) {
    SKIP_WITHOUT_CASES();
    EXPECT_EQ(drawn("longer_bin.gltf"), (Drawn{2, 1024}));
}

TEST(InputCases, CASE_F14) {
    SKIP_WITHOUT_CASES();
    for (const char* name : {"p1.vtk", "color_scalars.vtk", "v51_int32.vtk", "plus.vtk"})
        EXPECT_EQ(drawn(name, {"--k", "8", "--entry", "z"}), (Drawn{18, 5489})) << name;
}

TEST(InputCases, CASE_F15) {
    SKIP_WITHOUT_CASES();
    const json result = compared(input("no_position.glb"));
    ASSERT_FALSE(result.is_null());
    EXPECT_EQ(result["designs"][0]["fragments"], 1024);
    EXPECT_NE(notes_of(result).find("1 draw of primitives without POSITION is left out"), std::string::npos);
}

} // namespace cases_input_test
