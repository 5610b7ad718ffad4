// Everything that can be chosen is listed, once, with what it means.
#include "reports/catalogue.hpp"

#include "reports/counter_reference.hpp"
#include "reports/left_out.hpp"
#include "tests/support/sample_comparison.hpp"

#include <gtest/gtest.h>
#include <set>

namespace {

TEST(ReportsCatalogue, EveryEntryHasAUniqueNameAndASummary) {
    for (const auto& topic : reports::catalogue_topics()) {
        std::set<std::string> names;
        const auto entries = topic.entries();
        EXPECT_FALSE(entries.empty()) << topic.name;
        for (const auto& entry : entries) {
            EXPECT_EQ(entry.topic, topic.name);
            EXPECT_TRUE(names.insert(entry.name).second) << topic.name << ": " << entry.name;
            EXPECT_FALSE(entry.summary.empty()) << entry.name;
        }
    }
}

TEST(ReportsCatalogue, NamesAreThoseOfTheEntries) {
    for (const auto& topic : reports::catalogue_topics()) {
        std::vector<std::string> names;
        for (const auto& entry : topic.entries()) names.push_back(entry.name);
        EXPECT_EQ(topic.names(), names) << topic.name;
    }
}

TEST(ReportsCatalogue, ParametersOfGpuDesignsAndWorkloadsAreInOneList) {
    for (const char* name : {"rop.queue", "scoreboard.side_buffer", "workload.k"})
        EXPECT_FALSE(reports::catalogue_find(name).empty()) << name;
}

TEST(ReportsCatalogue, GeneratorsAreFoundWithAndWithoutPrefix) {
    EXPECT_EQ(reports::catalogue_find("gen:stack").size(), 1U);
    EXPECT_EQ(reports::catalogue_find("stack").size(), 1U);
}

TEST(ReportsCatalogue, ShippedProgramFilesAreListed) {
    for (const char* file : {"nearest_k.kb", "order_and_blend.kb", "nearest_k.glsl", "order_and_blend.glsl"}) {
        const auto found = reports::catalogue_find(file);
        ASSERT_EQ(found.size(), 1U) << file;
        EXPECT_EQ(found.front().topic, "programs");
        EXPECT_NE(found.front().summary.find("k = 4: "), std::string::npos) << found.front().summary;
    }
}

TEST(ReportsCatalogue, AStageNameStandsForAllItsCounters) {
    EXPECT_GT(reports::catalogue_find("rasterizer").size(), 3U);
    EXPECT_TRUE(reports::catalogue_find("rasteriz").empty());
}

TEST(ReportsCatalogue, CountersHaveNoDefault) {
    for (const auto& stage : reports::stage_reference())
        for (const auto& counter : stage.counters)
            EXPECT_EQ(reports::detail_text(counter).find("by default"), std::string::npos) << counter.path;
}

TEST(ReportsCatalogue, PartsOfHistogramsAndArraysBelongToTheirCounter) {
    ASSERT_NE(reports::find_counter("memory_partition", "bytes.3"), nullptr);
    EXPECT_EQ(reports::find_counter("memory_partition", "bytes.3")->path, "bytes");
    EXPECT_EQ(reports::counter_name("memory_partition", "bytes.3"), "bytes.kbuffer_read");
    EXPECT_EQ(reports::counter_name("memory_partition", "bytes.99"), "bytes.99");
    EXPECT_EQ(reports::counter_name("rop", "quads"), "quads");
    EXPECT_EQ(reports::find_counter("rop", "no_such_counter"), nullptr);
    EXPECT_EQ(reports::find_counter("no_such_stage", "quads"), nullptr);
}

TEST(ReportsCatalogue, WhatAllLackComesFirst) {
    auto comparison = ropsim_test::sample_comparison();
    comparison.runs[0].left_out.insert(comparison.runs[0].left_out.begin(), {"blender", "not in this design"});
    const auto entries = reports::left_out_entries(comparison);
    ASSERT_EQ(entries.size(), 2U);
    EXPECT_EQ(entries[0].unit, "stencil");
    EXPECT_TRUE(entries[0].by_all);
    EXPECT_EQ(entries[1].designs, std::vector<std::string>{"racy bypass_l1=false"});
}

} // namespace
