// Depth peeling on the GPU that it was measured on. Source: specification 004, sections 4.8 and 7.5, checks K8 and K9.
#include "models/gpu_library.hpp"
#include "models/kbuffers/library.hpp"
#include "reports/peeling/report.hpp"
#include "tests/support/replay.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace peeling_test {

using reports::PeelingColumn;
using reports::PublishedPeeling;
using reports::RowStatus;

const PublishedPeeling& published() {
    static const PublishedPeeling tables = reports::load_published_peeling();
    return tables;
}

const reports::PeelingMeasurement& row_of(const std::string& dataset, std::uint32_t k) {
    for (const auto& row : published().rows)
        if (row.dataset == dataset && row.k == k) return row;
    throw std::out_of_range(dataset);
}

// Model numbers of one row by what they are.
std::map<std::string, double> model_of(const std::string& dataset, std::uint32_t k) {
    const auto& row = row_of(dataset, k);
    const reports::PeelingDataset& data = published().dataset(dataset);
    // The whole mesh where that is small enough, else a line through its stand-ins.
    std::vector<std::uint64_t> sizes = data.sizes;
    if (data.triangles <= 1'000'000) sizes = {data.triangles};
    std::vector<reports::StandInRun> runs;
    for (const std::uint64_t size : sizes) runs.push_back(reports::run_stand_in(published(), row, size));
    std::map<std::string, double> model;
    for (const auto& number : reports::peeling_numbers(published(), row, runs))
        model[number.row.row.substr(number.row.row.rfind(", ") + 2)] = number.row.model;
    return model;
}

struct Expected {
    const char* dataset;
    double least, most; ///< of SP/SPwH
};

void expect_k8_and_k9(const Expected& expected) {
    auto four = model_of(expected.dataset, 4), sixteen = model_of(expected.dataset, 16);
    EXPECT_GE(four["SP/MP"], 3.3);
    EXPECT_LE(four["SP/MP"], 4.3);
    EXPECT_GE(sixteen["SP/MP"], 13);
    EXPECT_LE(sixteen["SP/MP"], 17);
    EXPECT_NEAR(four["SP"] / sixteen["SP"], 1, 0.01);
    EXPECT_NEAR(four["MP"] / sixteen["MP"], 4.0, 0.03 * 4.0);
    for (auto* numbers : {&four, &sixteen}) {
        EXPECT_GE((*numbers)["batch"], 11);
        EXPECT_LE((*numbers)["batch"], 15);
        EXPECT_LT((*numbers)["SPwH"], (*numbers)["MP"]);
        EXPECT_GE((*numbers)["SP/SPwH"], expected.least);
        EXPECT_LE((*numbers)["SP/SPwH"], expected.most);
    }
}

TEST(Peeling, LongK8AndK9_Dragon) { expect_k8_and_k9({"Dragon", 40, 60}); }
TEST(Peeling, LongK8AndK9_Powerplant) { expect_k8_and_k9({"Powerplant", 80, 135}); }

TEST(Peeling, K8_OnePassWinsAboutKTimesWhereVerticesAreTheLimit) {
    const auto run = reports::run_stand_in(published(), row_of("Powerplant", 4), 24'000);
    const auto more = reports::run_stand_in(published(), row_of("Powerplant", 4), 48'000);
    // Of the triangles that the second run has more than the first: clears and copies drop out.
    const double ratio = (more.milliseconds[0] - run.milliseconds[0]) / (more.milliseconds[1] - run.milliseconds[1]);
    EXPECT_GE(ratio, 3.3);
    EXPECT_LE(ratio, 4.3);
    EXPECT_EQ(run.triangles, 24'000U);
}

// 20,000 triangles on 16x16 pixels: most batches make no fragment, yet each is followed by a quad over the screen, here
// one pixel a cycle.
TEST(Peeling, K9_BatchesWithoutFragmentsTakeTheTimeOfTheirQuads) {
    const support::Replay replay("gen:blob?triangles=20000&attributes=none", {.width = 16, .height = 16});
    const auto run = [&](const char* rate) {
        return replay.run("sorted-batched",
                          {std::string("sorted-batched.batches.flush_quad_px_per_clk=") + rate,
                           "geometry.command_processor.draw_cpu_us=0", "geometry.command_processor.draw_gpu_cycles=0"});
    };
    constexpr double all_quads = 20000 / 32 * 16 * 16; // cycles
    const auto with = run("1"), without = run("0");
    EXPECT_LT(support::counter(with.stages, "fragment_scheduler/counters/flushes"), 20000U / 32 / 2);
    EXPECT_LT(static_cast<double>(without.cycles), 0.8 * all_quads);
    EXPECT_GE(static_cast<double>(with.cycles), 0.9 * all_quads);
}

TEST(Peeling, K9_TheComputerLimitsBatchesWhenItsDrawCallsAreSlow) {
    const support::Replay replay("gen:blob?triangles=4000&attributes=none", {.width = 64, .height = 64});
    // Two calls of 10 us per batch are 13,000 cycles at 650 MHz; what the GPU does lies behind them.
    const auto run = replay.run("sorted-batched", {"geometry.command_processor.draw_cpu_us=10"});
    EXPECT_NEAR(static_cast<double>(run.cycles) / 125, 13000, 0.03 * 13000);
}

TEST(Peeling, ManySmallDrawsOfTheSameVerticesMakeTheSameStream) {
    const support::Replay whole("gen:grid-soup?boxes=500&boxes_per_draw=500"),
        parts("gen:grid-soup?boxes=500&boxes_per_draw=7");
    EXPECT_EQ(whole.kbuffer_stream().fragments, parts.kbuffer_stream().fragments);
    EXPECT_EQ(whole.kbuffer_stream().depths, parts.kbuffer_stream().depths);
    EXPECT_GT(whole.kbuffer_stream().fragments, 0U);
}

TEST(PeelingTable, LinesGoThroughTheirPointsAndTellHowFarTheyMayMiss) {
    const auto exact = reports::line_value({1, 2, 4}, {3, 5, 9}, 10);
    EXPECT_NEAR(exact.value, 21, 1e-12);
    EXPECT_NEAR(exact.error, 1e-3, 1e-12);
    EXPECT_EQ(reports::line_value({5}, {7}, 100).value, 7);
    EXPECT_EQ(reports::line_value({5}, {7}, 100).error, 0);
    // Costs that bend, up or down, stay within what the line says of itself.
    using Cost = double (*)(double);
    for (const Cost cost :
         {Cost{[](double x) { return 3 + std::pow(x, 0.8); }}, Cost{[](double x) { return 3 + 2 * x - std::sqrt(x); }},
          Cost{[](double x) { return 1 + x * std::log2(x); }}})
        for (const double at : {5.0, 15.0, 40.0, 1000.0}) {
            const auto line = reports::line_value({1, 2, 4}, {cost(1), cost(2), cost(4)}, at);
            EXPECT_LE(std::abs(line.value - cost(at)), line.error * line.value) << cost(1) << " at " << at;
            EXPECT_GT(line.error, 0);
        }
}

// The only mesh that can be run whole.
TEST(Peeling, LongTheWholeMeshIsAsFarFromTheLineAsTheLineSays) {
    const auto& data = published().dataset("Dragon");
    for (const std::uint32_t k : {4U, 16U}) {
        std::vector<reports::StandInRun> runs;
        for (const std::uint64_t size : data.sizes)
            runs.push_back(reports::run_stand_in(published(), row_of("Dragon", k), size));
        const auto whole = reports::run_stand_in(published(), row_of("Dragon", k), data.triangles);
        const auto read = reports::peeling_numbers(published(), row_of("Dragon", k), runs);
        const auto run = reports::peeling_numbers(published(), row_of("Dragon", k), {whole});
        for (std::size_t i = 0; i < run.size(); ++i) {
            EXPECT_LE(std::abs(read[i].row.model / run[i].row.model - 1), read[i].uncertainty) << run[i].row.row;
            EXPECT_LE(read[i].uncertainty, 0.05) << run[i].row.row;
        }
    }
}

TEST(PeelingTable, QuotientsAndBatchTimesFollowFromTheColumnsAndAreNotCounted) {
    const auto& row = row_of("Dragon", 4);
    // As fast as published, to the digit.
    const auto numbers = reports::peeling_numbers(published(), row, {{871'000, {1e3 / 41.4, 1e3 / 139, 1e3 / 3.1}, 0}});
    ASSERT_EQ(numbers.size(), 7U);
    EXPECT_NEAR(numbers[3].row.published(), 3.36, 0.005);                        // SP/MP
    EXPECT_NEAR(numbers[3].row.sigma, std::hypot(0.05 / 41.4, 0.5 / 139), 1e-9); // each may have been rounded
    EXPECT_NEAR(numbers[6].row.published(), 11.9, 0.05);                         // us per batch
    for (const auto& number : numbers) EXPECT_NEAR(number.row.log_error(), 0, 1e-12);
    EXPECT_EQ(numbers[0].row.status, RowStatus::calibrated);
    EXPECT_EQ(numbers[1].row.status, RowStatus::predicted);
    EXPECT_EQ(numbers[2].row.status, RowStatus::calibrated); // flush_quad_px_per_clk was chosen with it in view
    for (std::size_t i = 3; i < numbers.size(); ++i) EXPECT_EQ(numbers[i].row.status, RowStatus::derived);
}

namespace {

/// Every number of the table as the model would have it that is right about everything.
std::vector<reports::PeelingNumber> table_as_published() {
    std::vector<reports::PeelingNumber> numbers;
    for (const auto& row : published().rows) {
        const auto& data = published().dataset(row.dataset);
        for (auto& number : reports::peeling_numbers(
                 published(), row,
                 {{data.triangles, {1e3 / row.fps[0].value, 1e3 / row.fps[1].value, 1e3 / row.fps[2].value}, 0}}))
            numbers.push_back(std::move(number));
    }
    return numbers;
}

} // namespace

TEST(PeelingTable, PHY_P7_EveryPrintedNumberCountsAtMostOnceAndNoneThatWasInView) {
    auto numbers = table_as_published();
    const auto summary = reports::summarise_peeling(numbers);
    std::set<std::string> predicted;
    for (const auto& number : numbers)
        if (number.row.status == RowStatus::predicted) predicted.insert(number.row.row);
    EXPECT_EQ(predicted, (std::set<std::string>{"Dragon, 4 RGBZ, SP", "Dragon, 16 Z, MP", "Powerplant, 4 RGBZ, MP",
                                                "Powerplant, 16 Z, MP", "Lucy, 4 RGBZ, MP", "Lucy, 16 Z, MP"}));
    EXPECT_EQ(summary.predicted.rows, 6U);
    EXPECT_EQ(summary.sharp.rows, 4U); // Lucy's MP have one digit
    EXPECT_NEAR(summary.predicted.rms, 0, 1e-12);
    ASSERT_TRUE(summary.predicted.skill());
    EXPECT_NEAR(*summary.predicted.skill(), 1, 1e-12);
}

// The numbers are those that the null model gives by hand: MP 4 RGBZ of Dragon, SP of the other two.
TEST(PeelingTable, PHY_P7_TheNullModelHasOneNumberAMesh) {
    auto numbers = table_as_published();
    const auto summary = reports::summarise_peeling(numbers);
    std::map<std::string, double> null;
    for (const auto& number : numbers) null[number.row.row] = number.row.null_model;
    EXPECT_NEAR(null["Dragon, 4 RGBZ, SP"], 4 * 41.4, 1e-9);
    EXPECT_NEAR(null["Dragon, 16 Z, MP"], 41.4 / 4, 1e-9);
    EXPECT_NEAR(null["Powerplant, 16 Z, MP"], 20.1 / 16, 1e-9);
    EXPECT_NEAR(null["Lucy, 4 RGBZ, MP"], 1.7 / 4, 1e-9);
    EXPECT_NEAR(null["Dragon, 4 RGBZ, SPwH"], 1e6 / 12.6 / 27219, 1e-6);
    EXPECT_EQ(null["Dragon, 4 RGBZ, SP/MP"], 0);
    EXPECT_NEAR(*summary.predicted.null_rms, 0.081, 0.002);
}

TEST(PeelingTable, EveryNoteAndChoiceBelongsToANumber) {
    EXPECT_EQ(published().rows.size(), 6U);
    EXPECT_EQ(published().calibrated.size(), 2U);
    for (const auto& step : published().calibrated) EXPECT_NO_THROW(published().row(step.dataset, step.buffer));
    for (const auto* notes : {&published().repeats, &published().explanations})
        for (const auto& note : *notes) EXPECT_NO_THROW(published().row(note.dataset, note.buffer));
    for (const auto& note : published().repeats) // the same as printed
        EXPECT_EQ(published().row(note.dataset, note.buffer).fps[1].value,
                  published().row(note.dataset, "4 RGBZ").fps[1].value);
    std::set<std::string> names;
    for (const auto& number : table_as_published()) names.insert(number.row.key());
    EXPECT_EQ(names.size(), 42U);
    EXPECT_GE(published().choices.size(), 3U);
    for (const auto& one : published().choices)
        for (const std::string& row : one.rows) EXPECT_TRUE(names.contains(row)) << row;
}

TEST(PeelingTable, PHY_P7_ConstantsThatWereChosenWithNumbersInViewAreStillThose) {
    sim::Config config = models::load_gpu(published().gpu);
    pipeline::GpuParams gpu;
    config.read("", gpu);
    const auto design = models::make_design(reports::design_of(PeelingColumn::spwh), config);
    const nlohmann::ordered_json& effective = config.effective();
    for (const auto& one : published().choices) {
        if (one.parameter.empty()) continue;
        std::string pointer = "/" + one.parameter;
        std::replace(pointer.begin(), pointer.end(), '.', '/');
        EXPECT_EQ(effective.at(nlohmann::ordered_json::json_pointer(pointer)).get<double>(), one.value) << one.what;
    }
}

TEST(PeelingTable, StandInsKeepTheSizeOfTheirTriangles) {
    const auto& dragon = published().dataset("Dragon");
    EXPECT_EQ(dragon.camera_of(dragon.triangles).substr(dragon.camera_of(dragon.triangles).rfind(',') + 1), "45");
    const auto fragments = [&](std::uint64_t size) {
        const support::Replay replay(dragon.scene_of(size),
                                     {.width = 512, .height = 512, .camera = dragon.camera_of(size)});
        return static_cast<double>(replay.kbuffer_stream().fragments) / static_cast<double>(size);
    };
    EXPECT_NEAR(fragments(20'000) / fragments(60'000), 1, 0.05);
}

} // namespace peeling_test
