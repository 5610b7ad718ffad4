#include "sim/described_json.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck/gtest.h>

namespace {

enum class Order { row_major, tiled };

} // namespace

template <>
struct sim::EnumNames<Order> {
    static constexpr std::array<std::string_view, 2> names{"row_major", "tiled"};
};

namespace {

using nlohmann::ordered_json;

struct Lines {
    std::uint8_t lines = 4;
    static constexpr auto fields() { return std::tuple{sim::field<&Lines::lines>("Lines").range(1, 100)}; }
    friend bool operator==(const Lines&, const Lines&) = default;
};
static_assert(sim::fully_described<Lines>);

struct Everything {
    bool flag = false;
    std::int64_t whole = 0;
    std::uint64_t natural = 0;
    double real = 0;
    float single = 0;
    Order order = Order::tiled;
    std::string text;
    Lines lines;
    std::vector<Lines> list;
    std::array<std::int32_t, 2> pair{};
    sim::Counter counter;
    sim::HighWater mark;
    sim::Histogram histogram;
    static constexpr auto fields() {
        return std::tuple{sim::field<&Everything::flag>(""),     sim::field<&Everything::whole>(""),
                          sim::field<&Everything::natural>(""),  sim::field<&Everything::real>(""),
                          sim::field<&Everything::single>(""),   sim::field<&Everything::order>(""),
                          sim::field<&Everything::text>(""),     sim::field<&Everything::lines>(""),
                          sim::field<&Everything::list>(""),     sim::field<&Everything::pair>("").at_most(9),
                          sim::field<&Everything::counter>(""),  sim::field<&Everything::mark>(""),
                          sim::field<&Everything::histogram>("")};
    }
    friend bool operator==(const Everything&, const Everything&) = default;
};
static_assert(sim::fully_described<Everything>);

std::string error_of(const char* json) {
    Everything object;
    try {
        sim::read_json(object, ordered_json::parse(json), "x.json");
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "no error";
}

RC_GTEST_PROP(DescribedJson, ReadsBackWhatItWrites, ()) {
    Everything object;
    object.flag = *rc::gen::arbitrary<bool>();
    object.whole = *rc::gen::arbitrary<std::int64_t>();
    object.natural = *rc::gen::arbitrary<std::uint64_t>();
    object.real = *rc::gen::arbitrary<double>();
    object.single = *rc::gen::arbitrary<float>();
    object.order = *rc::gen::element(Order::row_major, Order::tiled);
    object.text = *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127));
    for (const auto lines : *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::inRange<std::uint8_t>(1, 101)))
        object.list.push_back({lines});
    object.pair[1] = *rc::gen::inRange(-100, 10);
    object.counter += *rc::gen::arbitrary<std::uint64_t>();
    object.mark.note(*rc::gen::arbitrary<std::uint64_t>());
    if (*rc::gen::arbitrary<bool>()) object.histogram = sim::Histogram::linear(*rc::gen::inRange(1U, 50U));
    for (const auto value : *rc::gen::arbitrary<std::vector<std::uint32_t>>()) object.histogram.note(value);
    Everything read;
    sim::read_json(read, ordered_json::parse(sim::to_json(object).dump()), "x.json");
    RC_ASSERT(read == object);
}

TEST(DescribedJson, KeepsTheOrderOfFields) {
    EXPECT_EQ(sim::to_json(Lines()).dump(), R"({"lines":4})");
    EXPECT_EQ(sim::to_json(Everything()).begin().key(), "flag");
}

TEST(DescribedJson, HistogramNamesTheStartsOfItsBins) {
    sim::Histogram histogram;
    histogram.note(5, 3);
    histogram.note(0);
    Everything object;
    object.histogram = histogram;
    EXPECT_EQ(sim::to_json(object)["histogram"]["bins"].dump(), R"({"0":1,"4":3})");
}

TEST(DescribedJson, ReadsOnlyWhatIsThere) {
    Everything object;
    object.natural = 7;
    sim::read_json(object, ordered_json::parse(R"({"flag": true, "lines": {"lines": 9}})"), "x.json");
    EXPECT_TRUE(object.flag);
    EXPECT_EQ(object.natural, 7U);
    EXPECT_EQ(object.lines.lines, 9);
}

TEST(DescribedJson, NamesUnknownKeysWithASuggestion) {
    EXPECT_EQ(error_of(R"({"falg": 1})"), "x.json: unknown key 'falg'; did you mean 'flag'?");
    EXPECT_EQ(error_of(R"({"lines": {"line": 1}})"), "x.json: unknown key 'lines.line'; did you mean 'lines.lines'?");
    EXPECT_EQ(error_of(R"({"zebra": 1})"), "x.json: unknown key 'zebra'");
}

TEST(DescribedJson, SaysWhatWasExpected) {
    EXPECT_EQ(error_of("[]"), "x.json: expected a table, got []");
    EXPECT_EQ(error_of(R"({"flag": 1})"), "x.json: flag: expected true or false, got 1");
    EXPECT_EQ(error_of(R"({"natural": -1})"), "x.json: natural: expected whole number, got -1");
    EXPECT_EQ(error_of(R"({"whole": 9223372036854775808})"),
              "x.json: whole: expected whole number, got 9223372036854775808");
    EXPECT_EQ(error_of(R"({"whole": 1.5})"), "x.json: whole: expected whole number, got 1.5");
    EXPECT_EQ(error_of(R"({"real": "1"})"), "x.json: real: expected number, got \"1\"");
    EXPECT_EQ(error_of(R"({"single": 1e300})"), "x.json: single: expected number, got 1e+300");
    EXPECT_EQ(error_of(R"({"text": 1})"), "x.json: text: expected text, got 1");
    EXPECT_EQ(error_of(R"({"order": "tield"})"),
              "x.json: order: expected one of row_major | tiled, got \"tield\"; did you mean 'tiled'?");
    EXPECT_EQ(error_of(R"({"order": 1})"), "x.json: order: expected one of row_major | tiled, got 1");
    EXPECT_EQ(error_of(R"({"lines": 3})"), "x.json: lines: expected a table, got 3");
    EXPECT_EQ(error_of(R"({"lines": {"lines": 0}})"), "x.json: lines.lines: expected whole number 1 to 100, got 0");
    EXPECT_EQ(error_of(R"({"lines": {"lines": 300}})"), "x.json: lines.lines: expected whole number 1 to 100, got 300");
    EXPECT_EQ(error_of(R"({"list": [{"lines": 1}, {"lines": 0}]})"),
              "x.json: list.1.lines: expected whole number 1 to 100, got 0");
    EXPECT_EQ(error_of(R"({"pair": [1]})"), "x.json: pair: expected 2 values, got [1]");
    EXPECT_EQ(error_of(R"({"pair": [1, 10]})"), "x.json: pair.1: expected whole number at most 9, got 10");
    EXPECT_EQ(error_of(R"({"pair": 5})"), "x.json: pair: expected list of whole number, got 5");
    EXPECT_EQ(error_of(R"({"counter": -1})"), "x.json: counter: expected counter, got -1");
    EXPECT_EQ(error_of(R"({"histogram": {"bins": {"3": 1}}})"),
              "x.json: histogram.bins: expected starts of bins as keys, got \"3\"");
    EXPECT_EQ(error_of(R"({"histogram": {"bins": {"99999999999999999999": 1}}})"),
              "x.json: histogram.bins: expected starts of bins as keys, got \"99999999999999999999\"");
}

TEST(DescribedJson, AnErrorLeavesTheValueAsItWas) {
    Everything object;
    object.pair = {1, 2};
    EXPECT_THROW(sim::read_json(object, ordered_json::parse(R"({"pair": [3, 4, 5]})"), "x"), sim::InputError);
    EXPECT_EQ(object.pair, (std::array<std::int32_t, 2>{1, 2}));
}

} // namespace
