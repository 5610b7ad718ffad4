// Every workload with every design that can run it: the protected ones give the reference, and all pictures are
// numbers.
#include "tests/support/program_run.hpp"
#include "tests/support/replay.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace workload_designs_test {

using support::Replay;

struct Case {
    std::string workload, scene;
    std::vector<std::string> knobs;
    bool peelable = true;
    bool blendable = true;
};

const std::vector<Case> cases{
    {"translucency", "gen:slabs", {}},
    {"translucency", "gen:csg", {"fresnel=true"}},
    {"translucency", "gen:csg", {"media=one"}},
    {"csg", "gen:csg", {"expression=A - B"}},
    {"depth-of-field", "gen:planes", {}},
    {"isosurface", "gen:tetrahedra?n=4", {}, false},
    {"volume", "gen:tetrahedra?n=4", {}, false, false},
    {"particles", "gen:particles?n=3000", {}, false},
    {"particles", "gen:particles?n=3000", {"method=layers"}},
    {"soft-shadows", "gen:blob?triangles=2000+ground", {"map_size=64"}},
};

std::string name_of(const Case& one) { return one.workload + " " + (one.knobs.empty() ? "" : one.knobs[0]); }

TEST(WorkloadDesigns, ProtectedOnesGiveTheReference) {
    for (const Case& one : cases) {
        SCOPED_TRACE(name_of(one));
        const Replay replay(one.scene, {.width = 48, .height = 48, .workload = one.workload, .knobs = one.knobs});
        ASSERT_EQ(replay.reference.picture.size(), 48U * 48U * 4U);
        std::vector<std::string> designs{"scoreboard"};
        if (one.blendable) designs.emplace_back("blender");
        if (one.peelable) designs.emplace_back("multipass");
        for (const std::string& design : designs) {
            const pipeline::RunResult run = replay.run(design);
            EXPECT_EQ(run.hazards.total(), 0U) << design;
            EXPECT_EQ(run.wrong_pixels, 0U) << design;
            EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer) << design;
        }
        EXPECT_GT(replay.run("existing").fragments, 0U);
    }
}

TEST(WorkloadDesigns, PicturesAreNumbersAndNotEmpty) {
    for (const Case& one : cases) {
        SCOPED_TRACE(name_of(one));
        const Replay replay(one.scene, {.width = 48, .height = 48, .workload = one.workload, .knobs = one.knobs});
        std::size_t drawn = 0;
        for (std::size_t i = 0; i < replay.reference.picture.size(); ++i) {
            const float value = replay.reference.picture[i];
            EXPECT_TRUE(std::isfinite(value) && value >= 0.0F) << i;
            drawn += i % 4 == 0 && value != 1.0F;
        }
        EXPECT_GT(drawn, 48U * 48U / 20U);
    }
}

TEST(WorkloadDesigns, TheProgramRefusesWhatADesignCannotRun) {
    const auto compare = [](const std::string& workload, const std::string& scene, const std::string& design) {
        return ropsim_test::run_program(
            {"compare", scene, "--workload", workload, "--designs", design, "--size", "32x32"});
    };
    const auto volume = compare("volume", "gen:tetrahedra?n=2", "blender");
    EXPECT_EQ(volume.status, 1);
    EXPECT_NE(volume.error.find("'blender' cannot run the program volume"), std::string::npos) << volume.error;
    const auto isosurface = compare("isosurface", "gen:tetrahedra?n=2", "multipass");
    EXPECT_EQ(isosurface.status, 1);
    EXPECT_NE(isosurface.error.find("'multipass' cannot run the program isosurface"), std::string::npos)
        << isosurface.error;
}

TEST(WorkloadDesigns, PixelsWithMoreFragmentsThanKAreCountedAndSaid) {
    const auto all = ropsim_test::run_program(
        {"compare", "gen:csg", "--workload", "csg", "--designs", "scoreboard", "--size", "32x32", "--k", "2"});
    EXPECT_EQ(all.status, 0);
    EXPECT_NE(all.out.find("152 pixels have more than k"), std::string::npos) << all.out;
    const auto none = ropsim_test::run_program(
        {"compare", "gen:csg", "--workload", "csg", "--designs", "scoreboard", "--size", "32x32", "--k", "8"});
    EXPECT_EQ(none.out.find("more than k"), std::string::npos) << none.out;
}

} // namespace workload_designs_test
