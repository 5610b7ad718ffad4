// Cache tags against the plainest model of them: one list per set, most recently used first.
#include "pipeline/memory/cache.hpp"

#include <gtest/gtest.h>
#include <list>
#include <rapidcheck/gtest.h>

namespace memory_cache_test {

using pipeline::Cache;
using pipeline::CacheAccess;
using pipeline::CacheParams;

class BruteForceCache {
  public:
    explicit BruteForceCache(const CacheParams& params) : ways_(params.ways), sets_(params.lines() / params.ways) {}

    struct Outcome {
        bool hit = false, evicted = false, dirty = false;
        std::uint64_t victim = 0;
    };
    Outcome access(std::uint64_t line, bool write) {
        std::list<Entry>& set = sets_[line % sets_.size()];
        Outcome outcome;
        Entry entry{line, false};
        for (auto place = set.begin(); place != set.end(); ++place)
            if (place->line == line) {
                outcome.hit = true;
                entry = *place;
                set.erase(place);
                break;
            }
        if (set.size() == ways_) {
            outcome.evicted = true;
            outcome.dirty = set.back().dirty;
            outcome.victim = set.back().line;
            set.pop_back();
        }
        entry.dirty |= write;
        set.push_front(entry);
        return outcome;
    }
    void invalidate(std::uint64_t line) {
        sets_[line % sets_.size()].remove_if([&](const Entry& entry) { return entry.line == line; });
    }

  private:
    struct Entry {
        std::uint64_t line;
        bool dirty;
    };
    std::size_t ways_;
    std::vector<std::list<Entry>> sets_;
};

RC_GTEST_PROP(Cache, EqualsBruteForceModel, ()) {
    const auto ways = *rc::gen::inRange(1U, 9U);
    const auto sets = *rc::gen::inRange(1U, 9U);
    const CacheParams params{.bytes = 32 * ways * sets, .line = 32, .ways = ways};
    Cache cache(params, "cache");
    BruteForceCache model(params);
    const auto lines = *rc::gen::container<std::vector<std::uint32_t>>(rc::gen::inRange(0U, 4 * ways * sets));
    const auto actions = *rc::gen::container<std::vector<int>>(lines.size(), rc::gen::inRange(0, 10));
    std::uint64_t hits = 0;
    std::uint64_t evictions = 0;
    std::uint64_t writebacks = 0;
    std::uint64_t accesses = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (actions[i] == 0) { // a line is dropped now and then
            cache.invalidate(lines[i]);
            model.invalidate(lines[i]);
            continue;
        }
        const auto expected = model.access(lines[i], actions[i] < 4);
        const bool held = cache.find(lines[i]) != Cache::no_slot;
        const CacheAccess got = cache.access(lines[i], actions[i] < 4);
        RC_ASSERT(got.hit == expected.hit);
        RC_ASSERT(held == expected.hit);
        RC_ASSERT(got.evicted == expected.evicted);
        if (expected.evicted) RC_ASSERT(got.victim == expected.victim && got.dirty == expected.dirty);
        RC_ASSERT(cache.line_in(got.slot) == lines[i]);
        ++accesses;
        hits += expected.hit ? 1 : 0;
        evictions += expected.evicted ? 1 : 0;
        writebacks += expected.dirty ? 1 : 0;
    }
    RC_ASSERT(cache.stats().hits.value == hits);
    RC_ASSERT(cache.stats().accesses() == accesses);
    RC_ASSERT(cache.stats().evictions.value == evictions);
    RC_ASSERT(cache.stats().writebacks.value == writebacks);
}

TEST(Cache, CleanVisitsEveryDirtyLineOnce) {
    Cache cache({.bytes = 256, .line = 32, .ways = 2}, "cache");
    for (const std::uint64_t line : {0U, 1U, 2U, 5U}) cache.access(line, line != 1);
    std::vector<std::uint64_t> cleaned;
    const auto note = [&](std::uint64_t line, std::uint32_t) { cleaned.push_back(line); };
    cache.clean(note);
    cache.clean(note);
    EXPECT_EQ(cleaned, (std::vector<std::uint64_t>{0, 5, 2}));
    EXPECT_EQ(cache.stats().writebacks.value, 3U);
}

TEST(Cache, ClearForgetsEveryLine) {
    Cache cache({.bytes = 128, .line = 32, .ways = 4}, "cache");
    cache.access(7);
    cache.clear();
    EXPECT_EQ(cache.find(7), Cache::no_slot);
    EXPECT_FALSE(cache.access(7).evicted);
}

TEST(Cache, TouchIsAHitThatKeepsTheLine) {
    Cache cache({.bytes = 64, .line = 32, .ways = 2}, "cache");
    const std::uint32_t slot = cache.access(1).slot;
    cache.access(2);
    cache.touch(slot);
    EXPECT_EQ(cache.access(3).victim, 2U);
    EXPECT_EQ(cache.stats().hits.value, 1U);
}

TEST(Cache, ShapesThatDoNotFitAreInputErrorsThatNameTheKey) {
    const auto message = [](CacheParams params) -> std::string {
        try {
            Cache cache(params, "vertex_fetch.cache");
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_EQ(message({.bytes = 128, .line = 24, .ways = 1}),
              "vertex_fetch.cache.line: expected a power of two, got 24");
    EXPECT_EQ(message({.bytes = 100, .line = 32, .ways = 2}),
              "vertex_fetch.cache.bytes: expected a multiple of line * ways = 64, got 100");
    EXPECT_EQ(message({.bytes = 32, .line = 32, .ways = 2}),
              "vertex_fetch.cache.bytes: expected a multiple of line * ways = 64, got 32");
    EXPECT_EQ(message({.bytes = 96, .line = 32, .ways = 1}), "none"); // three sets are fine
}

} // namespace memory_cache_test
