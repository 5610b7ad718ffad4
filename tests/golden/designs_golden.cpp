// Numbers of small comparisons, kept in the tree: whoever changes the model sees here what that changes.
//
// When the change is meant: ROPSIM_UPDATE_GOLDEN=1 build/release/bin/golden_tests, then look at the difference.
#include "models/kbuffers/library.hpp"
#include "reports/comparison.hpp"
#include "sim/described.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program_run.hpp"

#include <cstdlib>
#include <gtest/gtest.h>

namespace {

std::vector<std::string> row_of(const std::string& scene, const pipeline::RunResult& run) {
    std::vector<std::string> cells{scene, run.design};
    for (const std::uint64_t number :
         {run.cycles, run.fragments, run.hazards.of(pipeline::HazardClass::h1_in_flight),
          run.hazards.of(pipeline::HazardClass::h2_write_path), run.hazards.of(pipeline::HazardClass::h3_stale_line),
          run.hazards.of(pipeline::HazardClass::h4_torn_read), run.wrong_pixels, run.lost_fragments})
        cells.push_back(std::to_string(number));
    return cells;
}

struct Case {
    std::string scene;
    std::string workload = "transparency";
    std::vector<std::string> settings = {};
    std::uint32_t samples = 1;

    std::string name() const {
        return scene + (workload == "transparency" ? "" : " " + workload) +
               (samples == 1 ? "" : " " + std::to_string(samples) + " samples");
    }
};

std::string numbers_of(const Case& one) {
    reports::ComparisonRequest request;
    request.scene = one.scene;
    request.workload = one.workload;
    request.workload_settings = one.settings;
    request.samples = one.samples;
    request.width = request.height = 64;
    for (const models::DesignInfo& design : models::designs()) request.designs.emplace_back(design.id);
    request.only_able_designs = true;
    std::string text;
    for (const pipeline::RunResult& run : reports::compare(reports::prepare(request)).runs)
        text += sim::csv_line(row_of(one.name(), run));
    return text;
}

TEST(DesignsGolden, NumbersAreThoseKeptInTheTree) {
    std::string now = sim::csv_line(
        {"scene", "design", "cycles", "fragments", "h1", "h2", "h3", "h4", "wrong_pixels", "lost_fragments"});
    for (const Case& one :
         {Case{"gen:stack?n=64"}, Case{"gen:discs?n=200"}, Case{"gen:random-quads?n=2000"},
          Case{.scene = "gen:discs?n=200", .samples = 4},
          Case{.scene = "gen:blob?triangles=3000+ground", .workload = "soft-shadows", .settings = {"map_size=64"}}})
        now += numbers_of(one);
    const auto file = ropsim_test::source_dir() / "tests/golden/designs.csv";
    if (std::getenv("ROPSIM_UPDATE_GOLDEN") != nullptr) ropsim_test::write_text(file, now);
    EXPECT_EQ(now, ropsim_test::file_text(file));
}

} // namespace
