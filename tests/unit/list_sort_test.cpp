// What the shader that sorts lists of fragments executes, counted by hand from its listing.
#include "models/programs/library.hpp"
#include "pipeline/list_sort.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <memory>
#include <vector>

namespace {

using Depths = std::array<std::vector<float>, 4>;
using pipeline::list_sort_work;
using pipeline::ListSort;
using pipeline::ListSortWork;
using pipeline::ListsSite;

std::shared_ptr<const pipeline::ModifyProgram> nearest() { return models::make_program("nearest-k", "rgbz", 4); }

ListsSite in_registers(std::uint32_t registers) {
    ListsSite site;
    site.array_registers = registers;
    return site;
}

/// Depths in the order in which the shader finds them: the newest fragment first.
ListSortWork work_of(std::vector<float> found, const ListsSite& site = in_registers(24)) {
    std::reverse(found.begin(), found.end());
    return list_sort_work(site, *nearest(), {found, {}, {}, {}});
}

// Two instructions for the head, seven for a node of 32 bytes, four for the entries' way out.
constexpr std::uint32_t around(std::uint32_t nodes) { return 2 + 7 * nodes + 4; }

} // namespace

TEST(ListSort, PHY_P6_CountsTheListing) {
    EXPECT_EQ(work_of({}).instructions, around(0));
    // The first node is put down, every step looks at a place (4), every row ends with a move (1).
    EXPECT_EQ(work_of({0.5F}).instructions, around(1) + 1);
    EXPECT_EQ(work_of({0.2F, 0.8F}).instructions, around(2) + 1 + (4 + 1));
    EXPECT_EQ(work_of({0.8F, 0.2F}).instructions, around(2) + 1 + (4 + 1));
    // From the front to the back one look each, from the back to the front at all of them.
    EXPECT_EQ(work_of({0.1F, 0.2F, 0.3F, 0.4F, 0.5F}).instructions, around(5) + 5 + 4 * (1 + 1 + 1 + 1));
    EXPECT_EQ(work_of({0.5F, 0.4F, 0.3F, 0.2F, 0.1F}).instructions, around(5) + 5 + 4 * (1 + 2 + 3 + 4));
}

TEST(ListSort, AnOlderFragmentGoesBeforeANewerOneOfItsDepth) {
    EXPECT_EQ(work_of({0.5F, 0.5F, 0.5F}).instructions, around(3) + 3 + 4 * (1 + 2));
    ListsSite site = in_registers(24);
    site.chained = false; // in order of arrival
    EXPECT_EQ(work_of({0.5F, 0.5F, 0.5F}, site).instructions, around(3) + 3 + 4 * (1 + 1));
}

TEST(ListSort, AQuadTakesTheLongestRowOfItsLanes) {
    const Depths same{std::vector{0.3F, 0.2F, 0.1F}, {0.3F, 0.2F, 0.1F}, {0.3F, 0.2F, 0.1F}, {0.3F, 0.2F, 0.1F}};
    // Lane 1 has the longest second row, lane 2 the longest third one, lane 0 is the longest list.
    const Depths mixed{std::vector{0.4F, 0.3F, 0.2F, 0.1F}, {0.1F, 0.2F}, {0.1F, 0.8F, 0.9F}, {}};
    EXPECT_EQ(list_sort_work(in_registers(24), *nearest(), same).instructions,
              work_of({0.1F, 0.2F, 0.3F}).instructions);
    const ListSortWork work = list_sort_work(in_registers(24), *nearest(), mixed);
    EXPECT_EQ(work.longest, 4U);
    EXPECT_EQ(work.instructions, around(4) + 4 + 4 * (1 + 2 + 1));
}

TEST(ListSort, WhatIsNotInRegistersIsLoadedAndStoredAtEachLook) {
    const std::vector<float> worst{0.5F, 0.4F, 0.3F, 0.2F, 0.1F};
    const ListSortWork registers = work_of(worst), some = work_of(worst, in_registers(2)), none = work_of(worst, {});
    EXPECT_EQ(registers.local_loads + registers.local_stores, 0U);
    // Rows of 3 and 4 older ones look at 1 and 2 places of local memory, those of 2, 3 and 4 write 1, 2 and 3; two of
    // the four nearest come from there.
    EXPECT_EQ(some.local_loads, 1U + 2U + 2U);
    EXPECT_EQ(some.local_stores, 1U + 2U + 3U);
    // All looks load, and each row of this order writes one place more than it looks at.
    EXPECT_EQ(none.local_loads, 1U + 2U + 3U + 4U + 4U);
    EXPECT_EQ(none.local_stores, 1U + 2U + 3U + 4U + 5U);
    for (const ListSortWork& work : {some, none})
        EXPECT_EQ(work.instructions, registers.instructions + 2 * work.local_loads); // address and load
    // From the front to the back: one look a row, which writes the element's own place; the first row has none.
    EXPECT_EQ(work_of({0.1F, 0.2F, 0.3F}, {}).local_stores, 3U);
    EXPECT_EQ(work_of({0.1F, 0.2F, 0.3F}, {}).local_loads, 2U + 3U);
}

TEST(ListSort, EntriesOnlyRunTheProgramOnEachNode) {
    ListsSite site = in_registers(24);
    site.sort = ListSort::entries;
    const std::uint32_t program = (nearest()->cost().operations + 3) / 4;
    EXPECT_EQ(work_of({0.5F, 0.4F, 0.3F}, site).instructions, around(3) + 3 * program);
    EXPECT_EQ(work_of({0.3F, 0.4F, 0.5F}, site).instructions, around(3) + 3 * program);
}

TEST(ListSort, ItsArrayTakesRegisters) {
    const auto registers = [](std::uint32_t longest, const ListsSite& site, std::uint32_t k, const char* entry) {
        const auto program = models::make_program("nearest-k", entry, k);
        pipeline::FragmentStream stream;
        stream.depths.own().resize(longest);
        pipeline::FragmentLists lists({8, 8, 1});
        for (std::uint32_t i = 0; i < longest; ++i) lists.keep(0, 0, {i, i});
        return pipeline::list_sort_pass("sort", site, *program, lists, 0, stream).registers;
    };
    EXPECT_EQ(registers(40, {}, 4, "rgbz"), 8U);
    ListsSite site = in_registers(24);
    EXPECT_EQ(registers(40, site, 4, "rgbz"), 8U + 24U);
    EXPECT_EQ(registers(10, site, 4, "rgbz"), 8U + 10U); // as many as the longest list needs
    EXPECT_EQ(registers(40, site, 4, "z"), 8U + 10U);    // four depths in each
    site.array_registers = 8;
    EXPECT_EQ(registers(40, site, 4, "rgbz"), 8U + 8U);
    site.sort = ListSort::entries;
    for (const std::uint32_t k : {4U, 16U, 64U}) EXPECT_EQ(registers(40, site, k, "rgbz"), 8U + k);
}
