// A workload made outside of the library, through its public headers alone: the worked example of traces/README.md.
#include "models/programs/nearest_k.hpp"
#include "models/programs/picture_shader.hpp"
#include "reports/accuracy/accuracy.hpp"
#include "reports/kbuffer_layout.hpp"
#include "reports/left_out.hpp"
#include "tests/support/program_run.hpp"
#include "tests/support/ray_kit.hpp"
#include "traces/pass_graph.hpp"
#include "traces/workloads/methods.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numeric>

namespace workload_from_outside_test {

struct HazeParams {
    std::uint32_t k = 4;
    float haze = 0.5F;

    static constexpr auto fields() {
        using P = HazeParams;
        return std::tuple(sim::field<&P::k>("surfaces kept per pixel").unit("surfaces").range(1, 64),
                          sim::field<&P::haze>("light that each surface takes").range(0.0F, 1.0F));
    }
};
static_assert(sim::fully_described<HazeParams>);

double light_behind(std::size_t surfaces, float haze) {
    return std::pow(1.0 - static_cast<double>(haze), static_cast<double>(surfaces));
}

/// The light behind everything, of which each surface takes the same share.
models::MakePicture haze_picture(float haze) {
    return [haze](const models::PictureSetup& setup) {
        const reports::KBufferLayout layout(*setup.program);
        const auto colour = [layout, haze, floats = setup.program->floats_per_pixel()](
                                const models::PicturePlace&, const float* pixel, const glm::vec3& behind) {
            std::size_t surfaces = 0;
            for (std::uint32_t layer = 0; layer < layout.layers(); ++layer)
                surfaces += layout.is_empty({pixel, floats}, 0, layer) ? 0 : 1;
            return behind * static_cast<float>(light_behind(surfaces, haze));
        };
        return models::picture_shader(setup, 2 * layout.layers(), colour); // a compare and a product for each
    };
}

pipeline::Frame build(const traces::Scene& scene, const pipeline::View& view, const HazeParams& params) {
    pipeline::Frame frame = traces::frame_of(scene, view);
    frame.program = models::make_nearest_k(models::EntryKind::z, params.k);
    std::vector<std::uint32_t> all(frame.draws.size());
    std::iota(all.begin(), all.end(), 0U);
    traces::PassGraph graph(frame);
    graph.add_clear("clear", {traces::kbuffer_surface});
    graph.add_draw("haze", {}, {traces::kbuffer_surface}, std::move(all), true);
    traces::add_picture(graph, frame, haze_picture(params.haze));
    graph.leave_out("pass sky", "haze is lit from everywhere");
    return graph.lower();
}

/// Beside the picture: whether the first surface sees the sky, above and in front.
traces::TruthMethod truth(const traces::Scene& scene, const pipeline::Frame&, const HazeParams& params) {
    traces::TruthMethod method;
    method.channels = {{"sky", "seen", false}};
    method.pixel = [haze = params.haze, far = 4.0 * static_cast<double>(scene.radius)](
                       traces::Rays& rays, const traces::PixelSurfaces& seen, std::uint32_t x, std::uint32_t y,
                       traces::TruthPicture& picture) {
        const std::size_t pixel = picture.pixel(x, y);
        picture.set_colour(pixel, glm::dvec3(light_behind(seen.layers.size(), haze)));
        if (seen.layers.empty()) return;
        const traces::WorldRay up{rays.place(x, y, seen.layers.front().distance), {0.0, far, far}, 0.0, 1.0};
        std::uint8_t hidden = 0;
        rays.occluded({&up, 1}, false, {&hidden, 1});
        picture.channels[0].set(pixel, hidden != 0 ? 0.0 : 1.0);
    };
    return method;
}

traces::Workload haze() {
    traces::Workload workload =
        traces::make_workload<HazeParams>("haze", "light that every surface dims", build, truth);
    workload.quality = {{"k", {"1", "2", "4"}}};
    return workload;
}

reports::ComparisonRequest slabs(std::vector<std::string> settings = {}) {
    reports::ComparisonRequest request;
    request.scene = "gen:slabs"; // four surfaces, one behind the other
    request.width = request.height = 48;
    request.workload = haze();
    request.workload_settings = std::move(settings);
    request.designs = {"blender"};
    return request;
}

TEST(WorkloadFromOutside, RunsAndSaysWhatItLeftOut) {
    const reports::Comparison comparison = reports::compare(reports::prepare(slabs()));
    EXPECT_EQ(comparison.frame->workload, "haze");
    EXPECT_EQ(comparison.runs.front().wrong_pixels, 0U);
    const std::vector<float>& picture = comparison.pixels.front().composite;
    EXPECT_EQ(*std::min_element(picture.begin(), picture.end()), 0.0625F);
    const auto entries = reports::left_out_entries(comparison);
    EXPECT_TRUE(std::any_of(entries.begin(), entries.end(), [](const reports::LeftOutEntry& entry) {
        return entry.unit == "pass sky" && entry.reason == "haze is lit from everywhere";
    }));
}

TEST(WorkloadFromOutside, SettingsAreChecked) {
    for (const char* setting : {"k=0", "haze=2", "hazy=1"})
        EXPECT_THROW(reports::prepare(slabs({setting})), sim::InputError) << setting;
}

TEST(WorkloadFromOutside, AnotherSettingStandsForTheTruth) {
    reports::AccuracyRequest request;
    request.comparison = slabs({"haze=0.25"});
    request.against = reports::Rival{{}, {"k=8"}};
    const reports::Accuracy accuracy = reports::measure_accuracy(request); // no ray is traced
    ASSERT_EQ(accuracy.points.size(), 5U);                                 // as set, three of k, the rival
    EXPECT_EQ(accuracy.against, "k=8");
    EXPECT_EQ(accuracy.points[0].error.rmse, 0.0); // k = 4
    EXPECT_GT(accuracy.points[1].error.rmse, accuracy.points[2].error.rmse);
    EXPECT_GT(accuracy.points[2].error.rmse, 0.0);
    EXPECT_EQ(accuracy.points[4].knobs, std::vector<std::string>{"k=8"});
    EXPECT_EQ(accuracy.points[4].error.rmse, 0.0);
    EXPECT_GT(accuracy.points[4].sim_ms, 0.0);
}

TEST(WorkloadFromOutside, AnotherWorkloadStandsForTheTruth) {
    reports::AccuracyRequest request;
    request.comparison = slabs();
    request.comparison.workload_settings = {"k=4"};
    request.against = reports::Rival{traces::WorkloadChoice("transparency"), {"opacity=0"}};
    request.sweep = {{"haze", {"0", "1"}}};
    const reports::Accuracy accuracy = reports::measure_accuracy(request);
    ASSERT_EQ(accuracy.points.size(), 3U);
    EXPECT_EQ(accuracy.points[0].error.rmse, 0.0) << "both show nothing but white light";
    EXPECT_GT(accuracy.points[1].error.rmse, 0.1);
    EXPECT_EQ(accuracy.points[2].workload, "transparency");
    EXPECT_EQ(reports::accuracy_json(accuracy)["against"], "transparency opacity=0");
}

class WorkloadFromOutsideTruth : public support::RayTest {};

TEST_F(WorkloadFromOutsideTruth, EqualsItsFrameAndIsWrittenDown) {
    reports::TruthRequest request;
    request.scene = "gen:slabs";
    request.width = request.height = 48;
    request.workload = haze();
    request.check = true;
    request.use_cache = false;
    const reports::TruthRun run = reports::run_truth(request);
    EXPECT_TRUE(run.holds());
    ASSERT_EQ(run.errors.size(), 5U); // four layers and the picture
    EXPECT_EQ(run.truth.counts.light_rays, run.truth.counts.pixels_seen);
    const traces::TruthChannel& sky = run.truth.channels.at(0);
    EXPECT_EQ(std::count(sky.known.begin(), sky.known.end(), 1),
              static_cast<std::ptrdiff_t>(run.truth.counts.pixels_seen));
    EXPECT_GT(std::count(sky.values.begin(), sky.values.end(), 1.0F), 0);
    const ropsim_test::TemporaryFolder folder;
    reports::write_truth(run, folder.path(), false);
    EXPECT_NE(ropsim_test::file_text(folder.path() / "truth.json").find("\"haze\""), std::string::npos);
}

TEST_F(WorkloadFromOutsideTruth, ErrorFallsAsItsKnobTurns) {
    reports::AccuracyRequest request;
    request.comparison = slabs();
    request.use_cache = false;
    request.sweep = haze().quality;
    const std::vector<reports::AccuracyPoint> points = reports::measure_accuracy(request).points;
    ASSERT_EQ(points.size(), 3U);
    EXPECT_LT(points[1].error.rmse, points[0].error.rmse);
    EXPECT_LT(points[2].error.rmse, 2.0 / 255.0);
}

} // namespace workload_from_outside_test
