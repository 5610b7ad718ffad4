// The pass that makes the picture of a k-buffer, where it takes time (workload.composite=timed).
#include "tests/support/replay.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace timed_composite_test {

using support::Replay;

struct Case {
    const char* workload;
    const char* scene;
    std::vector<std::string> settings;
};

const std::vector<Case> cases{{"transparency", "gen:discs?n=60", {}},
                              {"transparency", "gen:discs?n=60", {"program=mlab"}},
                              {"translucency", "gen:csg", {}},
                              {"csg", "gen:csg", {"expression=A & !B"}},
                              {"isosurface", "gen:tetrahedra?n=3", {}},
                              {"volume", "gen:tetrahedra?n=3", {}},
                              {"particles", "gen:particles?n=300", {"method=layers"}}};

Replay drawn(const Case& of, const std::string& composite, std::uint32_t samples = 1) {
    support::ReplayOptions options;
    options.workload = of.workload;
    options.knobs = of.settings;
    options.knobs.push_back("composite=" + composite);
    options.width = 48;
    options.height = 36;
    options.samples = samples;
    return Replay(of.scene, options);
}

// Every entry of every pixel has to come from memory, as no cache between it and the shader has seen it.
TEST(TimedComposite, FetchesTheWholeKBufferAndShowsTheSame) {
    for (const Case& of : cases) {
        const Replay free = drawn(of, "free"), timed = drawn(of, "timed");
        for (const char* design : {"blender", "interlock", "existing", "multipass", "linked-list"}) {
            const auto able = timed.designs();
            if (std::find(able.begin(), able.end(), design) == able.end()) continue;
            const pipeline::RunResult without = free.run(design), with = timed.run(design);
            EXPECT_EQ(without.colour, with.colour) << of.workload << ' ' << design;
            EXPECT_EQ(with.unexplained_pixels(), 0U) << of.workload << ' ' << design;
            EXPECT_EQ(with.hazards.total(), without.hazards.total()) << of.workload << ' ' << design;
            const pipeline::PassResult& picture = support::pass_named(with, "picture");
            EXPECT_EQ(with.cycles, without.cycles + picture.cycles) << of.workload << ' ' << design;
            const std::uint64_t bytes = std::uint64_t{48} * 36 * timed.frame.program->bytes_per_pixel();
            EXPECT_GE(support::counter(picture.counters, "fragment/l1/texture_misses") * 64, bytes)
                << of.workload << ' ' << design;
        }
    }
}

TEST(TimedComposite, MakesOnePictureOfAllSamples) {
    const Replay free = drawn(cases[0], "free", 4), timed = drawn(cases[0], "timed", 4);
    const pipeline::RunResult without = free.run("blender"), with = timed.run("blender");
    EXPECT_EQ(without.colour, with.colour);
    EXPECT_EQ(with.wrong_pixels, 0U);
}

TEST(TimedComposite, WithoutThePassNothingIsBuiltForIt) {
    const Replay free = drawn(cases[0], "free");
    EXPECT_FALSE(free.frame.screen_draw.has_value());
    for (const pipeline::PassResult& pass : free.run("blender").passes) EXPECT_NE(pass.name, "picture");
}

} // namespace timed_composite_test
