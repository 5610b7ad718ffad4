// A frame that is for its depth alone, as of a shadow map: it has no picture, and everything else of a report.
#include "models/kbuffers/library.hpp"
#include "pipeline/functional/frame_streams.hpp"
#include "reports/comparison.hpp"
#include "reports/report_files.hpp"
#include "tests/support/program_run.hpp"
#include "traces/camera.hpp"
#include "traces/pass_graph.hpp"
#include "traces/scene.hpp"
#include "traces/workloads/methods.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numeric>

namespace depth_only_test {

reports::ComparisonInput depth_only_input() {
    const traces::Scene scene = traces::load_scene("gen:discs?n=20&width=64&height=48");
    const pipeline::Frame frame = traces::frame_of(scene, traces::make_view(scene, "auto", 64, 48));
    std::vector<std::uint32_t> all(frame.draws.size());
    std::iota(all.begin(), all.end(), 0U);
    traces::PassGraph graph(frame);
    graph.add_clear("clear", {traces::depth_surface});
    graph.add_draw("depth", {traces::depth_surface}, {traces::depth_surface}, std::move(all), true);
    graph.output(traces::depth_surface);

    reports::ComparisonInput input;
    input.frame = std::make_shared<const pipeline::Frame>(graph.lower());
    input.streams = pipeline::rasterize_frame(*input.frame, {});
    input.reference = pipeline::run_reference(*input.frame, input.streams, 1, 1);
    sim::Config config;
    for (const char* design : {"existing", "multipass"})
        input.designs.push_back({reports::parse_variant(design), design, models::make_design(design, config), {}});
    return input;
}

TEST(DepthOnly, DesignsEqualTheReferenceInDepth) {
    const reports::ComparisonInput input = depth_only_input();
    ASSERT_FALSE(input.frame->needs.colour_surface);
    const auto farthest = [](float depth) { return depth == 1.0F; };
    const auto& depth = input.reference.depth;
    EXPECT_GT(depth.size(), static_cast<std::size_t>(std::count_if(depth.begin(), depth.end(), farthest)));
    const reports::Comparison comparison = reports::compare(depth_only_input());
    ASSERT_EQ(comparison.runs.size(), 2U);
    for (const pipeline::RunResult& run : comparison.runs) {
        EXPECT_EQ(run.wrong_pixels, 0U);
        EXPECT_GT(run.cycles, 0U);
    }
    EXPECT_TRUE(comparison.reference.composite.empty());
}

TEST(DepthOnly, HasAReport) {
    const ropsim_test::TemporaryFolder folder;
    reports::write_report(reports::compare(depth_only_input()), folder.path(), {.images = false});
    const auto result = nlohmann::json::parse(ropsim_test::file_text(folder.path() / "result.json"));
    EXPECT_EQ(result.at("designs").size(), 2U);
    EXPECT_EQ(result.at("designs")[0].at("wrong_pixels"), 0);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "report.html"));
}

} // namespace depth_only_test
