// Loops on several threads. The thread sanitizer runs these tests, too: what pieces write, the caller reads and frees.
#include "pipeline/functional/parallel.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace {

TEST(ParallelFor, RunsEveryPieceOnce) {
    for (const unsigned threads : {0U, 1U, 2U, 7U})
        for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{1000}}) {
            std::vector<int> runs(count);
            pipeline::parallel_for(threads, count, [&](std::size_t i) { ++runs[i]; });
            EXPECT_EQ(runs, std::vector<int>(count, 1)) << threads;
        }
}

TEST(ParallelFor, CallerOwnsWhatThePiecesMade) {
    for (int round = 0; round < 20; ++round) {
        const auto input = std::make_unique<std::vector<std::size_t>>(100);
        std::iota(input->begin(), input->end(), std::size_t{0});
        std::vector<std::unique_ptr<std::vector<std::size_t>>> made(100);
        pipeline::parallel_for(
            0, 100, [&](std::size_t i) { made[i] = std::make_unique<std::vector<std::size_t>>(i, (*input)[i]); });
        for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(*made[i], std::vector<std::size_t>(i, i));
    }
}

TEST(ParallelFor, ExceptionEndsTheLoopAndIsThrownOn) {
    for (const unsigned threads : {0U, 1U}) {
        std::vector<std::vector<int>> made(1000);
        const auto piece = [&](std::size_t i) {
            made[i].assign(10, 1);
            if (i == 500) throw std::runtime_error("piece 500");
        };
        EXPECT_THROW(pipeline::parallel_for(threads, 1000, piece), std::runtime_error);
        EXPECT_EQ(made[500], std::vector<int>(10, 1));
    }
}

TEST(ParallelFor, OneThreadIsTheCallersInOrder) {
    const std::thread::id caller = std::this_thread::get_id();
    std::vector<std::size_t> order;
    pipeline::parallel_for(1, 100, [&](std::size_t i) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        order.push_back(i);
    });
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
    EXPECT_EQ(order.size(), 100U);
}

} // namespace
