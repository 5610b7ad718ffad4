#include "sim/wake_queue.hpp"

#include "sim/check.hpp"

#include <gtest/gtest.h>
#include <map>
#include <rapidcheck/gtest.h>
#include <set>
#include <tuple>
#include <vector>

namespace {

using sim::Cycle;
using sim::WakeQueue;

std::vector<std::uint32_t> take_all(WakeQueue& queue) {
    std::vector<std::uint32_t> due;
    for (std::size_t word = 0; word < queue.words(); ++word)
        for (std::uint64_t bits = queue.take(word); bits != 0; bits &= bits - 1)
            due.push_back(static_cast<std::uint32_t>(word * 64) + static_cast<std::uint32_t>(std::countr_zero(bits)));
    return due;
}

using Due = std::vector<std::uint32_t>;

TEST(WakeQueue, IsEmptyAtFirst) {
    WakeQueue queue;
    EXPECT_EQ(queue.next(), WakeQueue::none);
    queue.add_component();
    EXPECT_EQ(queue.next(), WakeQueue::none);
    EXPECT_EQ(queue.current(), WakeQueue::none);
}

TEST(WakeQueue, TheFirstEdgeIsZero) {
    WakeQueue queue;
    queue.wake(queue.add_component(), 0);
    EXPECT_EQ(queue.next(), 0U);
    queue.advance(0);
    EXPECT_EQ(take_all(queue), Due{0});
    EXPECT_EQ(queue.next(), WakeQueue::none);
}

TEST(WakeQueue, WakingTwiceIsWakingOnce) {
    for (const Cycle at : {Cycle{5}, Cycle{100'000}}) {
        WakeQueue queue;
        queue.wake(queue.add_component(), at);
        queue.wake(0, at);
        queue.advance(queue.next());
        EXPECT_EQ(queue.current(), at);
        EXPECT_EQ(take_all(queue), Due{0});
        EXPECT_EQ(queue.next(), WakeQueue::none);
    }
}

TEST(WakeQueue, TheWheelReachesAsFarAsItsEdgesDiffer) {
    WakeQueue queue;
    queue.add_component();
    queue.wake(0, 70);
    queue.advance(70);
    take_all(queue);
    EXPECT_FALSE(queue.wake_near(0, 69));
    EXPECT_FALSE(queue.wake_near(0, 70));
    EXPECT_TRUE(queue.wake_near(0, 71));
    EXPECT_TRUE(queue.wake_near(0, 70 + WakeQueue::reach - 1));
    EXPECT_FALSE(queue.wake_near(0, 70 + WakeQueue::reach));
}

TEST(WakeQueue, AnEdgeThatHasPassedIsRefused) {
    WakeQueue queue;
    queue.add_component();
    queue.advance(70);
    EXPECT_THROW(queue.wake(0, 70), sim::InternalError);
    EXPECT_THROW(queue.wake(0, 3), sim::InternalError);
    EXPECT_THROW(queue.wake(0, WakeQueue::none), sim::InternalError);
}

TEST(WakeQueue, GrowingKeepsWhatIsFiled) {
    WakeQueue queue;
    Due all;
    for (std::uint32_t component = 0; component < 200; ++component) {
        ASSERT_EQ(queue.add_component(), component);
        queue.wake(component, 9);
        queue.wake(component, 2000 + component);
        all.push_back(component);
    }
    queue.advance(9);
    EXPECT_EQ(take_all(queue), all);
    EXPECT_EQ(queue.next(), 2000U);
}

RC_GTEST_PROP(WakeQueue, HandsOutWhatASortedMapWould, ()) {
    const auto count = *rc::gen::inRange<std::uint32_t>(1, 130);
    WakeQueue queue;
    for (std::uint32_t i = 0; i < count; ++i) queue.add_component();
    std::map<Cycle, std::set<std::uint32_t>> expected;
    Cycle now = 0; // the next edge that can still be asked for
    const auto steps = *rc::gen::container<std::vector<std::tuple<bool, std::uint32_t, std::uint32_t, Cycle>>>(
        rc::gen::tuple(rc::gen::arbitrary<bool>(), rc::gen::inRange<std::uint32_t>(0, count),
                       rc::gen::inRange<std::uint32_t>(0, 4), rc::gen::inRange<Cycle>(0, 80)));
    for (const auto& [serve, component, scale, distance] : steps) {
        if (!serve || expected.empty()) {
            const Cycle at = now + (distance << (scale * 2));
            queue.wake(component, at);
            expected[at].insert(component);
            continue;
        }
        RC_ASSERT(queue.next() == expected.begin()->first);
        queue.advance(queue.next());
        const Due due(expected.begin()->second.begin(), expected.begin()->second.end());
        RC_ASSERT(take_all(queue) == due);
        now = expected.begin()->first + 1;
        expected.erase(expected.begin());
    }
    RC_ASSERT(queue.next() == (expected.empty() ? WakeQueue::none : expected.begin()->first));
}

} // namespace
