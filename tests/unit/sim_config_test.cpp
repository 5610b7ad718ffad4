#include "sim/config.hpp"
#include "sim/described_json.hpp"
#include "sim/suggest.hpp"

#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck/gtest.h>

namespace {

enum class Visibility { rop_cache, writeback, never_until_flush };

} // namespace

template <>
struct sim::EnumNames<Visibility> {
    static constexpr std::array<std::string_view, 3> names{"rop_cache", "writeback", "never_until_flush"};
};

namespace {

using sim::Config;

struct CacheParams {
    std::uint32_t lines = 64;
    std::string policy = "lru";
    static constexpr auto fields() {
        return std::tuple{sim::field<&CacheParams::lines>("Lines").unit("lines").range(1, 4096),
                          sim::field<&CacheParams::policy>("Whom to replace")};
    }
};
static_assert(sim::fully_described<CacheParams>);

struct RopParams {
    std::uint32_t tiles = 32;
    double clock_mhz = 650;
    Visibility visibility = Visibility::writeback;
    CacheParams cache;
    std::vector<double> weights;
    static constexpr auto fields() {
        return std::tuple{sim::field<&RopParams::tiles>("Tiles the cache holds").unit("tiles").range(1, 65536),
                          sim::field<&RopParams::clock_mhz>("Clock").unit("MHz").at_least(1),
                          sim::field<&RopParams::visibility>("When a store becomes visible to a texture read"),
                          sim::field<&RopParams::cache>("The cache"), sim::field<&RopParams::weights>("Weights")};
    }
};
static_assert(sim::fully_described<RopParams>);

RopParams read(Config& config) {
    RopParams params;
    config.read("rop", params);
    config.expect_all_used();
    return params;
}

template <class Act>
std::string error_of(Act&& act) {
    try {
        act();
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "no error";
}

std::string error_in(std::string_view toml) {
    return error_of([&] {
        Config config = Config::from_toml_text(toml, "g70.toml");
        read(config);
    });
}

std::string error_of_set(std::string_view assignment) {
    return error_of([&] {
        Config config;
        config.set(assignment);
        read(config);
    });
}

TEST(Config, ReadsSectionsIntoStructs) {
    Config config = Config::from_toml_text("[rop]\ntiles = 5\nclock_mhz = 500\nvisibility = 'rop_cache'\n"
                                           "weights = [1, 0.5]\ncache.lines = 7\n",
                                           "g70.toml");
    const RopParams params = read(config);
    EXPECT_EQ(params.tiles, 5U);
    EXPECT_EQ(params.clock_mhz, 500.0);
    EXPECT_EQ(params.visibility, Visibility::rop_cache);
    EXPECT_EQ(params.weights, (std::vector<double>{1, 0.5}));
    EXPECT_EQ(params.cache.lines, 7U);
    EXPECT_EQ(params.cache.policy, "lru");
}

TEST(Config, EffectiveReadsBack) {
    Config config = Config::from_toml_text("[rop]\ntiles = 5\n[rop.cache]\npolicy = 'fifo'\n", "g70.toml");
    const RopParams params = read(config);
    EXPECT_EQ(config.effective()["rop"], sim::to_json(params));
    RopParams again;
    sim::read_json(again, config.effective()["rop"], "effective");
    EXPECT_EQ(sim::to_json(again), sim::to_json(params));
}

TEST(Config, SectionsMayNest) {
    Config config = Config::from_toml_text("[gpu.pipe.rop]\ntiles = 5\n[gpu.pipe]\nlines = 3", "g70.toml");
    RopParams rop;
    CacheParams pipe;
    config.read("gpu.pipe", pipe);
    config.read("gpu.pipe.rop", rop);
    config.expect_all_used();
    EXPECT_EQ(rop.tiles, 5U);
    EXPECT_EQ(pipe.lines, 3U);
    EXPECT_EQ(config.effective()["gpu"]["pipe"]["rop"]["tiles"], 5);
    EXPECT_EQ(config.effective()["gpu"]["pipe"]["lines"], 3);
}

TEST(Config, TheRootIsASectionToo) {
    Config config = Config::from_toml_text("lines = 3", "g70.toml");
    CacheParams cache;
    config.read("", cache);
    config.expect_all_used();
    EXPECT_EQ(cache.lines, 3U);
    EXPECT_EQ(config.effective(), sim::to_json(cache));
}

TEST(Config, SetOverridesTheFileAndLaterOnesWin) {
    Config config = Config::from_toml_text("[rop]\ntiles = 5", "g70.toml");
    config.set("rop.tiles=6");
    config.set("rop.tiles = 7");
    EXPECT_EQ(error_of([&] { config.set("rop.tiles=7"); }), "no error");
    EXPECT_EQ(read(config).tiles, 7U);
}

TEST(Config, SetTakesTextWithoutQuotes) {
    Config config;
    config.set("rop.visibility=never_until_flush");
    config.set("rop.cache.policy=650");
    config.set("rop.weights=[1, 2]");
    config.set("rop.clock_mhz=1e3");
    const RopParams params = read(config);
    EXPECT_EQ(params.visibility, Visibility::never_until_flush);
    EXPECT_EQ(params.cache.policy, "650");
    EXPECT_EQ(params.weights, (std::vector<double>{1, 2}));
    EXPECT_EQ(params.clock_mhz, 1000.0);
}

TEST(Config, ErrorsOfSetNameTheOption) {
    EXPECT_EQ(error_of_set("rop.tiles=0"), "--set: rop.tiles: expected whole number 1 to 65536, got 0");
    EXPECT_EQ(error_of_set("rop.tils=1"), "--set: unknown key 'rop.tils'; did you mean 'rop.tiles'?");
    for (const char* bad : {"rop.tiles", "=3", "rop..tiles=3", "rop.tiles=3\nx=4", "rop tiles=3", "", "[rop]=3", "#=1"})
        EXPECT_EQ(error_of_set(bad).find("--set: expected SECTION.KEY=VALUE"), 0U) << error_of_set(bad);
}

TEST(Config, ErrorsNameFileLineAndColumn) {
    EXPECT_EQ(error_in("[rop]\ntils = 5"), "g70.toml:2:8: unknown key 'rop.tils'; did you mean 'rop.tiles'?");
    EXPECT_EQ(error_in("[rop]\n\ntiles = 'x'"), "g70.toml:3:9: rop.tiles: expected whole number 1 to 65536, got \"x\"");
    EXPECT_EQ(error_in("[rop]\ntiles = 5.5"), "g70.toml:2:9: rop.tiles: expected whole number 1 to 65536, got 5.5");
    EXPECT_EQ(error_in("[rop]\nclock_mhz = nan"), "g70.toml:2:13: rop.clock_mhz: expected number at least 1, got nan");
    EXPECT_EQ(error_in("[rop]\nvisibility = 'writebak'"),
              "g70.toml:2:14: rop.visibility: expected one of rop_cache | writeback | never_until_flush, got "
              "\"writebak\"; did you mean 'writeback'?");
    EXPECT_EQ(error_in("rop = 5"), "g70.toml:1:7: rop: expected a table, got 5");
    EXPECT_EQ(error_in("[rop]\ncache = 5"), "g70.toml:2:9: rop.cache: expected a table, got 5");
    EXPECT_EQ(error_in("[rop.tiles]\nx = 5"), "g70.toml:2:5: unknown key 'rop.tiles.x'; did you mean 'rop.tiles'?");
    EXPECT_EQ(error_in("[ropp]"), "g70.toml:1:1: unknown section 'ropp'; did you mean 'rop'?");
    EXPECT_EQ(error_in("[rop]\n[rop.cache]"), "no error");
}

TEST(Config, SyntaxErrorsNameTheirPlace) {
    const std::string error = error_in("[rop]\ntiles = = 5");
    EXPECT_EQ(error.find("g70.toml:2:9: "), 0U) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_EQ(error_in("[rop]\ntiles = 1\ntiles = 2").find("g70.toml:3:"), 0U);
}

TEST(Config, FilesThatCannotBeReadAreNamed) {
    EXPECT_EQ(error_of([] { Config::from_toml_file("/nowhere/g70.toml"); }),
              "/nowhere/g70.toml: there is no such file");
    EXPECT_EQ(error_of([] { Config::from_toml_file("/"); }), "/: expected a file, got a folder");
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "sim_config_test.toml";
    std::ofstream(path) << "[rop]\ntiles = 9\n";
    Config config = Config::from_toml_file(path);
    EXPECT_EQ(read(config).tiles, 9U);
    std::filesystem::remove(path);
}

RC_GTEST_PROP(Config, AnyTextIsReadOrRefusedInOneLine, ()) {
    const auto part = rc::gen::element<std::string>("[", "]", "rop", "tiles", ".", "=", "{", "}", "value", "origin",
                                                    "\"", "'", "\n", ",", " ", "5", "-1", "1e9", "true", "1979-05-27",
                                                    "#", "\\", "\xff", std::string(1, '\0'));
    std::string text;
    for (const std::string& piece : *rc::gen::container<std::vector<std::string>>(part)) text += piece;
    const std::string in_file = error_in(text);
    RC_ASSERT(in_file == "no error" || in_file.find("g70.toml:") == 0U);
    RC_ASSERT(in_file.find('\n') == std::string::npos);
    const std::string in_option = error_of_set(text);
    RC_ASSERT(in_option == "no error" || in_option.find("--set: ") == 0U);
}

TEST(Config, ValuesMayStateTheirOrigin) {
    Config config = Config::from_toml_text(
        "[rop]\nclock_mhz = { value = 500, origin = 'public', source = 'data sheet, page 3', note = 'boost' }\n"
        "tiles = { value = 3, origin = 'assumed' }\n[rop.cache]\nlines = 8\n",
        "g70.toml");
    config.set("rop.tiles=4");
    config.set("rop.cache.lines=9");
    const RopParams params = read(config);
    EXPECT_EQ(params.clock_mhz, 500.0);
    EXPECT_EQ(params.tiles, 4U);
    const auto origins = config.origins();
    EXPECT_EQ(origins.at("rop.clock_mhz"), (sim::Origin{"public", "data sheet, page 3", "boost"}));
    EXPECT_EQ(origins.at("rop.tiles"), (sim::Origin{"command line", "", ""}));
    EXPECT_EQ(origins.at("rop.cache.lines"), (sim::Origin{"command line", "", ""}));
    EXPECT_EQ(origins.size(), 3U);
}

TEST(Config, OriginsHaveKnownKeys) {
    EXPECT_EQ(error_in("[rop]\ntiles = { value = 3, orign = 'x' }"),
              "g70.toml:2:30: unknown key 'rop.tiles.orign'; did you mean 'rop.tiles.origin'?");
    EXPECT_EQ(error_in("[rop]\ntiles = { value = 3, origin = 1 }"),
              "g70.toml:2:31: rop.tiles.origin: expected text, got 1");
}

TEST(Config, HasFindsValuesAndSections) {
    const Config config = Config::from_toml_text("[rop.cache]\nlines = 1\n[empty]\n", "g70.toml");
    for (const char* path : {"rop", "rop.cache", "rop.cache.lines", "empty"}) EXPECT_TRUE(config.has(path)) << path;
    for (const char* path : {"ro", "rop.cache.line", "rop.cache.lines.x", "emptyy"})
        EXPECT_FALSE(config.has(path)) << path;
}

TEST(Config, ACopyIsIndependent) {
    Config first = Config::from_toml_text("[rop]\ntiles = 1", "g70.toml");
    Config second = first;
    second.set("rop.tiles=2");
    EXPECT_EQ(read(first).tiles, 1U);
    EXPECT_EQ(read(second).tiles, 2U);
}

TEST(Suggest, CountsEditsAndSwaps) {
    EXPECT_EQ(sim::edit_distance("", "abc"), 3U);
    EXPECT_EQ(sim::edit_distance("tiles", "tiles"), 0U);
    EXPECT_EQ(sim::edit_distance("tils", "tiles"), 1U);
    EXPECT_EQ(sim::edit_distance("tlies", "tiles"), 1U);
    EXPECT_EQ(sim::edit_distance("kitten", "sitting"), 3U);
}

TEST(Suggest, StaysSilentWhenNothingIsNear) {
    EXPECT_EQ(sim::did_you_mean("tils", {"lines", "tiles"}), "; did you mean 'tiles'?");
    EXPECT_EQ(sim::did_you_mean("zebra", {"lines", "tiles"}), "");
    EXPECT_EQ(sim::did_you_mean("x", {"a", "b"}), "");
    EXPECT_EQ(sim::did_you_mean("x", {}), "");
}

} // namespace
