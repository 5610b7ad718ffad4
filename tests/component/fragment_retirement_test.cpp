// The reorder buffer of designs that need no order: quads leave as they complete.
#include "pipeline/fragment/reorder_buffer.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/sim_kit.hpp"

#include <algorithm>
#include <numeric>
#include <random>

namespace fragment_retirement_test {

using Cycles = std::vector<sim::Cycle>;
using pipeline::Completion;
using pipeline::QuadTask;

struct Bench {
    tests::Rig rig;
    pipeline::ReorderBuffer unit;
    tests::Source<QuadTask> order;
    tests::Source<Completion> pipe;
    tests::Sink<QuadTask> sink;

    Bench(const std::vector<std::uint32_t>& completed, tests::SourceOptions options, std::uint32_t places = 1024,
          std::uint32_t width = 4)
        : unit(rig.context("reorder_buffer"), {0, width}, 1, places, pipeline::Retirement::out_of_order),
          order(rig.context("order"), tasks(completed.size())),
          pipe(rig.context("pipe"), completions(completed), options),
          sink(rig.context("sink")) {
        sim::connect(order.out, unit.order_in, {1, 8, 32});
        sim::connect(pipe.out, unit.completions_in[0], {1, 1, 4});
        sim::connect(unit.quads_out, sink.in, {1, width, 4 * width});
        rig.simulation.run();
    }

    static std::vector<QuadTask> tasks(std::size_t count) {
        std::vector<QuadTask> list(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            list[i].quad = i;
            list[i].sequence = i;
            list[i].mask = 15;
        }
        return list;
    }
    static std::vector<Completion> completions(const std::vector<std::uint32_t>& sequences) {
        std::vector<Completion> list;
        for (const std::uint32_t sequence : sequences) list.push_back({sequence, 15});
        return list;
    }
};

TEST(OutOfOrderRetirement, QuadsLeaveInTheCycleTheirCompletionArrives) {
    const Bench bench({2, 0, 1}, {.start = 20, .gap = 10});
    EXPECT_EQ(tests::quads_of(bench.sink.values()), (std::vector<pipeline::QuadId>{2, 0, 1}));
    EXPECT_EQ(bench.sink.cycles(), (Cycles{22, 32, 42})); // in order all three would leave at 42
}

TEST(OutOfOrderRetirement, EveryQuadLeavesOnceWhateverTheOrder) {
    std::vector<std::uint32_t> any(20'000);
    std::iota(any.begin(), any.end(), 0U);
    // Completions lie at most 600 quads from dispatch order, as those of pipes do.
    std::mt19937 random(5);
    for (std::size_t i = 0; i + 600 <= any.size(); i += 600)
        std::shuffle(any.begin() + static_cast<std::ptrdiff_t>(i), any.begin() + static_cast<std::ptrdiff_t>(i) + 600,
                     random);
    const Bench bench(any, {.start = 300});
    auto left = tests::quads_of(bench.sink.values());
    EXPECT_EQ(left, any);
    EXPECT_EQ(bench.unit.stats().retired, any.size());
}

TEST(OutOfOrderRetirement, PlacesBoundTheQuadsInside) {
    // Two places: the third quad is taken in when one of the first two has left.
    const Bench bench({1, 0, 3, 2}, {.start = 40, .gap = 10}, 2);
    EXPECT_EQ(tests::quads_of(bench.sink.values()), (std::vector<pipeline::QuadId>{1, 0, 3, 2}));
    EXPECT_EQ(bench.sink.cycles(), (Cycles{42, 52, 62, 72}));
}

TEST(OutOfOrderRetirement, AnOldQuadThatNeverEndsDoesNotStopTheOthers) {
    std::vector<std::uint32_t> rest(50'000);
    std::iota(rest.begin(), rest.end(), 1U);
    rest.push_back(0);
    const Bench bench(rest, {.start = 300});
    EXPECT_EQ(tests::quads_of(bench.sink.values()).back(), 0U);
    EXPECT_EQ(bench.unit.stats().retired, rest.size());
}

} // namespace fragment_retirement_test
