// The cache of truths: gives back every byte or nothing.
#include "reports/truth/truth_cache.hpp"

#include "tests/support/program_run.hpp"
#include "traces/camera.hpp"
#include "traces/workloads.hpp"

#include <gtest/gtest.h>
#include <set>

namespace reports_truth_cache_test {

using reports::Truth;
using reports::TruthCache;
using ropsim_test::file_text;
using ropsim_test::TemporaryFolder;

Truth sample() {
    Truth truth;
    truth.width = 2;
    truth.height = 1;
    truth.layers = 2;
    truth.surfaces = {3, 0};
    truth.depths = {1.5F, 2.5F, 0.0F, 0.0F};
    truth.colours = {0.1F, 0.2F, 0.3F, 1.0F, 1.0F, 1.0F, 1.0F, 1.0F};
    truth.visibility = {0.25F, 1.0F};
    truth.channels = {{"solid", "distance", false, {2.5F, 0.0F}, {1, 0}}, {"inside", "length", true, {0.5F, 1.0F}}};
    truth.marks = {1, 0};
    truth.counts.surfaces = 3;
    truth.counts.light_rays = 1024;
    return truth;
}

const std::string key = "0123456789abcdef";

TEST(TruthCache, GivesBackWhatItWasGiven) {
    const TemporaryFolder folder;
    const TruthCache cache(folder.path() / "not" / "yet");
    EXPECT_FALSE(cache.find(key).truth);
    EXPECT_EQ(cache.find(key).note, "");
    EXPECT_EQ(cache.keep(key, sample()), "");
    const auto found = cache.find(key).truth;
    ASSERT_TRUE(found);
    EXPECT_EQ(found->width, 2U);
    EXPECT_EQ(found->surfaces, sample().surfaces);
    EXPECT_EQ(found->depths, sample().depths);
    EXPECT_EQ(found->colours, sample().colours);
    EXPECT_EQ(found->visibility, sample().visibility);
    ASSERT_EQ(found->channels.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        const traces::TruthChannel kept = found->channels[i], given = sample().channels[i];
        EXPECT_EQ(kept.name, given.name);
        EXPECT_EQ(kept.quantity, given.quantity);
        EXPECT_EQ(kept.everywhere, given.everywhere);
        EXPECT_EQ(kept.values, given.values);
        EXPECT_EQ(kept.known, given.known);
    }
    EXPECT_EQ(found->marks, sample().marks);
    EXPECT_EQ(found->counts.light_rays, 1024U);
    EXPECT_FALSE(cache.find("0123456789abcdee").truth);
}

TEST(TruthCache, FindsNothingInADamagedFileAndSaysSo) {
    const TemporaryFolder folder;
    const TruthCache cache(folder.path());
    ASSERT_EQ(cache.keep(key, sample()), "");
    const std::string whole = file_text(cache.file_of(key));
    const auto expect_damaged = [&](const std::string& bytes, std::size_t at) {
        ropsim_test::write_text(cache.file_of(key), bytes);
        const auto found = cache.find(key);
        EXPECT_FALSE(found.truth) << at;
        EXPECT_NE(found.note.find("is damaged"), std::string::npos);
    };
    for (std::size_t length = 0; length < whole.size(); ++length) expect_damaged(whole.substr(0, length), length);
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
        expect_damaged(bytes, at);
    }
    expect_damaged(whole + "x", whole.size());
    ropsim_test::write_text(cache.file_of("fedcba9876543210"), whole); // another truth's file
    EXPECT_FALSE(cache.find("fedcba9876543210").truth);
}

TEST(TruthCache, WhatCannotBeKeptIsANote) {
    const TemporaryFolder folder;
    ropsim_test::write_text(folder.path() / "file", "");
    EXPECT_TRUE(TruthCache(folder.path() / "file").keep(key, sample()).starts_with("the truth is not kept: "));
}

TEST(TruthCache, EveryParameterIsPartOfTheKey) {
    const traces::Scene scene = traces::load_scene("gen:slabs");
    const auto frame = [&](const std::string& workload, std::uint32_t width) {
        return traces::build_frame(scene, traces::make_view(scene, "auto", width, 16), workload);
    };
    const auto slabs = frame("transparency", 16);
    reports::TruthPlan plan, lit;
    lit.light.emplace();
    std::vector<reports::TruthPlan> plans{plan, lit, lit, lit, lit};
    plans[0].layers = 3;
    plans[2].sampling.rays = 99;
    plans[3].sampling.seed = 2;
    plans[4].light->u.x = 1.0;
    std::set<std::string> keys;
    for (const auto& other : plans) keys.insert(reports::truth_key("a", slabs, "", other));
    keys.insert(reports::truth_key("a", slabs, "", plan));
    keys.insert(reports::truth_key("b", slabs, "", plan));
    keys.insert(reports::truth_key("a", frame("translucency", 16), "", plan));
    keys.insert(reports::truth_key("a", frame("transparency", 17), "", plan));
    keys.insert(reports::truth_key("a", slabs, "opacity=0.5", plan));
    keys.insert(reports::truth_key("a", slabs, "opacity=0.25", plan));
    EXPECT_EQ(keys.size(), 11U);
    EXPECT_EQ(reports::truth_key("a", slabs, "", plan), reports::truth_key("a", slabs, "", plan));
}

} // namespace reports_truth_cache_test
