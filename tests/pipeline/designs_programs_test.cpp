// Programs whose result depends on the order of fragments, and programs that users wrote, in the designs.
// Source: specification 004, sections 6.1 and 6.3 and check K13; DESIGN section 2.
#include "sim/check.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace designs_programs_test {

using pipeline::RunResult;
using support::Replay;

using Settings = std::vector<std::string>;

const std::vector<std::string> scenes{"gen:discs?n=120&overlap=8&width=32&height=32",
                                      "gen:stack?n=24&x=1&y=1&w=29&h=29&order=random"};
const std::vector<std::string> ordered_programs{"order-and-blend", "mlab", "order_and_blend.kb"};

Replay replay_of(const std::string& scene, const std::string& program, const Settings& more = {}) {
    Settings knobs{"program=" + program, "k=3"};
    knobs.insert(knobs.end(), more.begin(), more.end());
    return Replay(scene, {.width = 32, .height = 32, .knobs = knobs});
}

void expect_reference(const Replay& replay, const RunResult& run) {
    EXPECT_EQ(run.hazards.total(), 0U);
    EXPECT_EQ(run.wrong_pixels, 0U);
    EXPECT_TRUE(run.kbuffer == replay.reference.kbuffer);
}

std::size_t different_floats(const std::vector<float>& a, const std::vector<float>& b) {
    std::size_t count = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += a[i] != b[i] ? 1U : 0U;
    return count;
}

TEST(Programs, K13_ProtectedDesignsGiveTheReferenceWhereOrderMatters) {
    for (const std::string& scene : scenes)
        for (const std::string& program : ordered_programs) {
            const Replay replay = replay_of(scene, program);
            for (const char* design : {"scoreboard", "blender"}) {
                SCOPED_TRACE(fmt::format("{} {} {}", design, program, scene));
                expect_reference(replay, replay.run(design));
            }
        }
}

TEST(Programs, K13_WithoutProtectionHazardsSpoilTheImage) {
    for (const std::string& scene : scenes)
        for (const std::string& program : ordered_programs) {
            SCOPED_TRACE(program + " " + scene);
            const Replay replay = replay_of(scene, program);
            const RunResult run = replay.run("existing");
            EXPECT_GT(run.hazards.total(), 0U);
            EXPECT_GT(run.wrong_pixels, 0U);
            EXPECT_FALSE(run.kbuffer == replay.reference.kbuffer);
        }
}

// No hazard, no wrong pixel: the same unprotected hardware with a flush after every triangle.
TEST(Programs, K13_WithoutHazardsTheImageIsTheReference) {
    for (const std::string& program : ordered_programs) {
        SCOPED_TRACE(program);
        const Replay replay = replay_of(scenes.front(), program);
        expect_reference(replay, replay.run("existing", {"existing.flush_triangles=1"}));
    }
}

TEST(Programs, ProgramsThatAreWrittenGiveThePicturesOfTheBuiltInOnes) {
    for (const std::string& scene : scenes)
        for (const auto& [built_in, written] : {std::pair<std::string, std::string>{"nearest-k", "nearest_k.kb"},
                                                {"order-and-blend", "order_and_blend.kb"}}) {
            SCOPED_TRACE(written + " " + scene);
            const Replay a = replay_of(scene, built_in, {"opacity=0.3"}),
                         b = replay_of(scene, written, {"opacity=0.3"});
            EXPECT_FALSE(a.reference.picture.empty());
            EXPECT_TRUE(a.reference.picture == b.reference.picture);
            EXPECT_TRUE(a.reference.kbuffer == b.reference.kbuffer);
            for (const char* design : {"scoreboard", "blender"}) {
                const RunResult of_a = a.run(design), of_b = b.run(design);
                EXPECT_EQ(of_a.cycles, of_b.cycles) << design;
                EXPECT_TRUE(of_a.kbuffer == of_b.kbuffer) << design;
            }
        }
    const Replay peeled = replay_of(scenes.front(), "nearest_k.kb");
    expect_reference(peeled, peeled.run("multipass"));
}

TEST(Programs, AllCompositesAgreeOnAFrontToBackStackThatFits) {
    const std::string scene = "gen:stack?n=3&x=1&y=1&w=29&h=29&order=front-to-back";
    const Replay layers = replay_of(scene, "nearest-k"), blended = replay_of(scene, "order-and-blend");
    EXPECT_EQ(different_floats(layers.reference.picture, blended.reference.picture), 0U);
    const Replay nodes = replay_of(scene, "mlab");
    ASSERT_EQ(nodes.reference.picture.size(), layers.reference.picture.size());
    std::size_t covered = 0;
    for (std::size_t i = 0; i < layers.reference.picture.size(); ++i) {
        EXPECT_NEAR(nodes.reference.picture[i], layers.reference.picture[i], 1e-6F);
        covered += layers.reference.picture[i] < 1.0F ? 1U : 0U;
    }
    EXPECT_GT(covered, 1000U);
}

TEST(Programs, TheProgramRunsThemAsAUserWould) {
    const ropsim_test::TemporaryFolder folder;
    const std::string mine = (folder.path() / "mine.kb").string();
    ropsim_test::write_text(mine, "program \"mine\";\nk 4 from 1 to 8;\nentry z;\nempty z = largest;\n"
                                  "fragment { if f.z < e[0].z { e[0] = f; } }\n");
    const std::vector<std::string> compare{"compare", scenes.front(), "--size", "32x32", "--no-images", "--program"};
    const auto run = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = compare;
        arguments.insert(arguments.end(), more.begin(), more.end());
        return ropsim_test::run_program(arguments);
    };
    for (const std::string& program : {mine, std::string("order-and-blend"), std::string("mlab")}) {
        const auto outcome = run({program, "--designs", "existing,scoreboard,blender"});
        EXPECT_EQ(outcome.status, 0) << outcome.error;
        EXPECT_NE(outcome.out.find("blender"), std::string::npos);
    }
    ropsim_test::write_text(mine, "program \"mine\";\nentry z;\nfragment { e[0] = g; }\n");
    const auto wrong = run({mine, "--designs", "existing"});
    EXPECT_EQ(wrong.status, 1);
    EXPECT_NE(wrong.error.find(mine + ":3:19: expected a name that is declared, got 'g'"), std::string::npos)
        << wrong.error;
    const auto refused = run({"order-and-blend", "--designs", "multipass"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.error.find("'multipass' cannot run the program order-and-blend"), std::string::npos);
    EXPECT_EQ(run({"nearest", "--designs", "existing"}).status, 1);
}

} // namespace designs_programs_test
