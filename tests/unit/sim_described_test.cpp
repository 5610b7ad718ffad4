// Structs that say once what their members are, and what derives from that.
#include "sim/described.hpp"

#include <gtest/gtest.h>

namespace {

enum class Policy { round_robin, oldest_first };

} // namespace

template <>
struct sim::EnumNames<Policy> {
    static constexpr std::array<std::string_view, 2> names{"round_robin", "oldest_first"};
};

namespace {

struct CacheStats {
    sim::Counter hits, misses;
    sim::HighWater queue;
    static constexpr auto fields() {
        return std::tuple{sim::field<&CacheStats::hits>("Lines found").unit("lines"),
                          sim::field<&CacheStats::misses>("Lines fetched").unit("lines"),
                          sim::field<&CacheStats::queue>("Longest queue").unit("requests")};
    }
    friend bool operator==(const CacheStats&, const CacheStats&) = default;
};
static_assert(sim::fully_described<CacheStats>);

struct UnitStats {
    sim::Counter fragments;
    CacheStats cache;
    std::array<sim::Counter, 2> by_side;
    sim::Histogram latency;
    double bytes = 0;
    std::vector<std::uint32_t> spread;
    static constexpr auto fields() {
        return std::tuple{sim::field<&UnitStats::fragments>("Fragments retired"),
                          sim::field<&UnitStats::cache>("The cache"),
                          sim::field<&UnitStats::by_side>("Per side").unit("quads"),
                          sim::field<&UnitStats::latency>("From read to write").unit("cycles"),
                          sim::field<&UnitStats::bytes>("Moved").unit("B"),
                          sim::field<&UnitStats::spread>("Per lane")};
    }
    friend bool operator==(const UnitStats&, const UnitStats&) = default;
};
static_assert(sim::fully_described<UnitStats>);

struct UnitParams {
    bool interlock = true;
    std::int8_t offset = -3;
    std::uint64_t bytes = 1;
    float scale = 0.1F;
    double exact = 0.1;
    Policy policy = Policy::oldest_first;
    std::string name = "rop";
    static constexpr auto fields() {
        return std::tuple{sim::field<&UnitParams::interlock>("Hold overlapping quads"),
                          sim::field<&UnitParams::offset>("Offset").at_least(-8),
                          sim::field<&UnitParams::bytes>("Bytes").unit("B").range(1, 1U << 20U),
                          sim::field<&UnitParams::scale>("Scale").at_most(2),
                          sim::field<&UnitParams::exact>("Exact"),
                          sim::field<&UnitParams::policy>("Who goes first"),
                          sim::field<&UnitParams::name>("Name")};
    }
};
static_assert(sim::fully_described<UnitParams>);

struct Forgotten {
    int listed = 0;
    CacheStats nested;
    std::string forgotten;
    static constexpr auto fields() {
        return std::tuple{sim::field<&Forgotten::listed>(""), sim::field<&Forgotten::nested>("")};
    }
};
static_assert(!sim::fully_described<Forgotten>);

struct Twice {
    int once = 0, twice = 0;
    static constexpr auto fields() { return std::tuple{sim::field<&Twice::twice>(""), sim::field<&Twice::twice>("")}; }
};
static_assert(!sim::fully_described<Twice>);

struct OnlyAStruct {
    CacheStats nested;
    static constexpr auto fields() { return std::tuple{sim::field<&OnlyAStruct::nested>("")}; }
};
static_assert(sim::fully_described<OnlyAStruct>);

struct Nothing {
    static constexpr auto fields() { return std::tuple<>{}; }
};
static_assert(sim::fully_described<Nothing>);

static_assert(sim::field_names<CacheStats> == std::array<std::string_view, 3>{"hits", "misses", "queue"});
static_assert(sim::enum_name(Policy::oldest_first) == "oldest_first");

UnitStats some_stats() {
    UnitStats stats;
    stats.fragments += 10;
    ++stats.cache.hits;
    stats.cache.misses += 2;
    stats.cache.queue.note(7);
    stats.by_side[1] += 5;
    stats.latency.note(4, 2);
    stats.bytes = 0.5;
    stats.spread = {1, 2};
    return stats;
}

TEST(Described, ForEachFieldVisitsInOrder) {
    UnitParams params;
    std::vector<std::string> seen;
    sim::for_each_field(params, [&](const auto& field, auto& member) {
        seen.emplace_back(field.name);
        if constexpr (std::is_same_v<std::remove_reference_t<decltype(member)>, bool>) member = false;
    });
    EXPECT_EQ(seen, (std::vector<std::string>{"interlock", "offset", "bytes", "scale", "exact", "policy", "name"}));
    EXPECT_FALSE(params.interlock);
}

TEST(Described, DescribeListsNestedFieldsWithDefaultsAndRanges) {
    std::vector<std::string> lines;
    for (const sim::FieldInfo& info : sim::describe<UnitParams>("rop"))
        lines.push_back(info.path + "|" + info.type + "|" + info.unit + "|" + info.text + "|" + info.default_value +
                        "|" + info.range);
    EXPECT_EQ(lines, (std::vector<std::string>{
                         "rop.interlock|true or false||Hold overlapping quads|true|",
                         "rop.offset|whole number||Offset|-3|at least -8",
                         "rop.bytes|whole number|B|Bytes|1|1 to 1048576",
                         "rop.scale|number||Scale|0.1|at most 2",
                         "rop.exact|number||Exact|0.1|",
                         "rop.policy|choice||Who goes first|oldest_first|round_robin | oldest_first",
                         "rop.name|text||Name|rop|",
                     }));
    const auto stats = sim::describe<UnitStats>();
    ASSERT_EQ(stats.size(), 8U);
    EXPECT_EQ(stats[2].path, "cache.misses");
    EXPECT_EQ(stats[3].type, "high water");
    EXPECT_EQ(stats[4].type, "list of counter");
    EXPECT_EQ(stats[5].type, "histogram");
}

TEST(Described, CsvColumnsCarryUnitsAndFitTheCells) {
    EXPECT_EQ(sim::csv_header<UnitStats>("rop"),
              (std::vector<std::string>{"rop.fragments", "rop.cache.hits [lines]", "rop.cache.misses [lines]",
                                        "rop.cache.queue [requests]", "rop.by_side.0 [quads]", "rop.by_side.1 [quads]",
                                        "rop.latency.count", "rop.latency.mean [cycles]", "rop.latency.min [cycles]",
                                        "rop.latency.max [cycles]", "rop.bytes [B]", "rop.spread"}));
    EXPECT_EQ(sim::csv_row(some_stats()),
              (std::vector<std::string>{"10", "1", "2", "7", "0", "5", "2", "4", "4", "4", "0.5", "1 2"}));
    EXPECT_EQ(sim::csv_header<UnitParams>().size(), sim::csv_row(UnitParams()).size());
}

TEST(Described, CsvLineQuotesWhatNeedsIt) {
    EXPECT_EQ(sim::csv_line({"a", "b,c", "d\"e", ""}), "a,\"b,c\",\"d\"\"e\",\n");
}

TEST(Described, AddSumsParallelUnits) {
    UnitStats sum = some_stats();
    UnitStats other;
    other.fragments += 1;
    other.cache.queue.note(3);
    other.latency.note(100);
    other.bytes = 0.25;
    other.spread = {1, 1, 1};
    sim::add(sum, other);
    EXPECT_EQ(sum.fragments, 11U);
    EXPECT_EQ(sum.cache.hits, 1U);
    EXPECT_EQ(sum.cache.queue, 7U);
    EXPECT_EQ(sum.by_side[1], 5U);
    EXPECT_EQ(sum.latency.count(), 3U);
    EXPECT_EQ(sum.latency.max(), 100U);
    EXPECT_EQ(sum.bytes, 0.75);
    EXPECT_EQ(sum.spread, (std::vector<std::uint32_t>{2, 3, 1}));
}

TEST(Described, AddLeavesChoicesAsTheyAre) {
    UnitParams into, from;
    from.policy = Policy::round_robin;
    from.name = "other";
    sim::add(into, from);
    EXPECT_EQ(into.policy, Policy::oldest_first);
    EXPECT_EQ(into.name, "rop");
}

TEST(Described, DifferenceUndoesAdd) {
    const UnitStats before = some_stats();
    UnitStats step;
    step.fragments += 3;
    step.cache.misses += 4;
    step.latency.note(4, 5);
    step.by_side[0] += 1;
    step.spread = {5, 5};
    UnitStats after = before;
    sim::add(after, step);
    UnitStats difference = sim::difference(after, before);
    EXPECT_EQ(difference.cache.queue, 7U); // the mark of the later one: that of the step alone is not known
    difference.cache.queue = {};
    EXPECT_EQ(difference, step);
}

TEST(Described, DifferenceFromALaterCopyIsRefused) {
    EXPECT_THROW(sim::difference(UnitStats(), some_stats()), sim::InternalError);
}

TEST(Described, StatsAreValues) {
    UnitStats stats = some_stats();
    const UnitStats copy = stats;
    EXPECT_EQ(stats, copy);
    stats = {};
    EXPECT_NE(stats, copy);
    EXPECT_EQ(stats, UnitStats());
}

TEST(Histogram, BinsByPowersOfTwo) {
    sim::Histogram histogram;
    EXPECT_EQ(histogram.min(), 0U);
    EXPECT_EQ(histogram.mean(), 0.0);
    for (const std::uint64_t value : {0U, 1U, 2U, 3U, 4U, 7U, 8U}) histogram.note(value);
    histogram.note(~std::uint64_t{0}, 0); // not at all
    EXPECT_EQ(histogram.bins()[0], 1U);
    EXPECT_EQ(histogram.bins()[1], 1U);
    EXPECT_EQ(histogram.bins()[2], 2U);
    EXPECT_EQ(histogram.bins()[3], 2U);
    EXPECT_EQ(histogram.bins()[4], 1U);
    EXPECT_EQ(histogram.count(), 7U);
    EXPECT_EQ(histogram.sum(), 25U);
    EXPECT_EQ(histogram.min(), 0U);
    EXPECT_EQ(histogram.max(), 8U);
    EXPECT_EQ(histogram.bin_of(~std::uint64_t{0}), 64U);
    for (std::size_t bin = 0; bin < sim::Histogram::bin_count; ++bin)
        EXPECT_EQ(histogram.bin_of(histogram.bin_start(bin)), bin);
}

TEST(Histogram, LinearBinsEndInOneForTheRest) {
    sim::Histogram histogram = sim::Histogram::linear(10);
    histogram.note(9);
    histogram.note(10);
    histogram.note(639);
    histogram.note(640);
    histogram.note(1'000'000);
    EXPECT_EQ(histogram.bins()[0], 1U);
    EXPECT_EQ(histogram.bins()[1], 1U);
    EXPECT_EQ(histogram.bins()[63], 1U);
    EXPECT_EQ(histogram.bins()[64], 2U);
    EXPECT_EQ(histogram.bin_start(64), 640U);
}

TEST(Histogram, MergesEqualBinsOnly) {
    sim::Histogram powers, tens = sim::Histogram::linear(10);
    powers.note(1);
    tens.note(1);
    EXPECT_THROW(powers.merge(tens), sim::InternalError);
    sim::Histogram empty;
    empty.merge(tens);
    EXPECT_EQ(empty, tens);
    tens.merge(sim::Histogram());
    EXPECT_EQ(empty, tens);
}

} // namespace
