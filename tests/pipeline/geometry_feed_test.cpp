// Acceptance of the geometry feed: specification 004, section 10.1, on the GPUs that were measured.
#include "models/gpu_library.hpp"
#include "models/kbuffers/library.hpp"
#include "pipeline/machine.hpp"
#include "reports/geometry/laboratory.hpp"
#include "reports/geometry/validation.hpp"
#include "tests/support/replay.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace geometry_feed_test {

using pipeline::VertexPathResult;
using reports::Fidelity;
using reports::GeometryExperiment;

reports::PreparedFrame frame_of(const std::string& scene, const std::vector<std::string>& prepare = {},
                                bool reads_all = true) {
    GeometryExperiment experiment;
    experiment.scene = scene;
    experiment.prepare = prepare;
    experiment.reads_all = reads_all;
    return reports::prepare_frame(experiment, reports::gpu_params("neutral"));
}

VertexPathResult run(const std::string& gpu, const std::string& scene, Fidelity fidelity = Fidelity::detailed,
                     const std::vector<std::string>& prepare = {}, const std::map<std::string, double>& values = {}) {
    return reports::run_geometry(reports::gpu_params(gpu, values), *frame_of(scene, prepare).frame, fidelity);
}

std::string grass(std::uint32_t blades, const std::string& attributes, std::uint32_t blades_per_draw = 0) {
    return fmt::format("gen:grass?blades={}&attributes={}&index=u32&blades_per_draw={}", blades, attributes,
                       blades_per_draw);
}

double vertices_per_second(const VertexPathResult& result, std::uint32_t blades) {
    return 7.0 * blades * result.frames_per_second();
}

/// Rows of a published table on a GPU, by name.
std::map<std::string, reports::ValidationRow> table_of(const std::string& table, const std::string& gpu) {
    std::map<std::string, reports::ValidationRow> found;
    for (const reports::PublishedRow& row : reports::load_published_geometry()) {
        if (row.table != table || !row.fps.contains(gpu)) continue;
        const pipeline::GpuParams params = reports::gpu_params(gpu);
        const auto frame = reports::prepare_frame(row.experiment, params).frame;
        reports::ValidationRow measured;
        measured.low = measured.high = row.fps.at(gpu).value;
        measured.model = reports::run_geometry(params, *frame, Fidelity::detailed).frames_per_second();
        found[row.row] = measured;
    }
    return found;
}

TEST(GeometryFeed, G2VerticesPerSecondAreConstantBelowTheCliff) {
    double least = 1e30, most = 0;
    for (const std::uint32_t blades : {14'286U, 35'714U, 71'429U, 135'714U}) { // 0.1M to 0.95M vertices
        const double rate = vertices_per_second(run("g70", grass(blades, "none")), blades);
        least = std::min(least, rate);
        most = std::max(most, rate);
    }
    EXPECT_LE(most / least, 1.03);
}

TEST(GeometryFeedLong, G3DrawsAboveAMillionVerticesAreSlowWhenIndexed) {
    const auto rate = [](std::uint32_t blades, std::uint32_t per_draw, const std::vector<std::string>& prepare) {
        // Without indices vertices are twice as many; with normals they would not fit into memory.
        const std::string attributes = prepare.empty() ? "normal:3f32" : "none";
        return vertices_per_second(run("g70", grass(blades, attributes, per_draw), Fidelity::detailed, prepare),
                                   blades);
    };
    const double below = rate(100'000, 0, {});
    EXPECT_NEAR(below / rate(300'000, 0, {}), 4.44, 0.444);
    EXPECT_NEAR(rate(300'000, 100'000, {}) / below, 1.0, 0.05); // the same vertices in three draws
    EXPECT_NEAR(rate(100'000, 0, {"unindex"}) / rate(300'000, 0, {"unindex"}), 1.0, 0.03);
}

TEST(GeometryFeed, G3LongTheThreeExplanationsOfTheCliffDifferWhereTheyShould) {
    // 1.05M + vertices; 12 bytes each exceed 12 MB, too. In 24 draws neither limit is met.
    const std::string large = grass(152'000, "none"), cut = grass(152'000, "none", 6'400);
    const auto slower = [](const std::string& cliff, const std::string& scene) {
        sim::Config config = models::load_gpu("g70");
        config.set("host.range_cliff=" + cliff);
        pipeline::GpuParams with;
        config.read("", with);
        const auto frame = frame_of(scene).frame;
        return reports::run_geometry(with, *frame, Fidelity::estimate).milliseconds /
               reports::run_geometry(reports::gpu_params("g70", {{"host.overflow_slowdown", 1}}), *frame,
                                     Fidelity::estimate)
                   .milliseconds;
    };
    for (const char* cliff : {"index_range", "cache_capacity"}) {
        EXPECT_GT(slower(cliff, large), 3.0) << cliff;
        EXPECT_NEAR(slower(cliff, cut), 1.0, 0.01) << cliff;
    }
    EXPECT_GT(slower("host_memory", large), 1.2); // the bus, not a cache, sets the rate
    EXPECT_NEAR(slower("none", large), 1.0, 1e-9);
    // Without indices M1 and M2 do not apply, M3 does.
    EXPECT_NEAR(run("g70", grass(152'000, "none"), Fidelity::estimate, {"unindex"}).draws[0].terms.slowdown,
                run("g70", grass(140'000, "none"), Fidelity::estimate, {"unindex"}).draws[0].terms.slowdown, 0.01);
}

namespace {

std::uint32_t best_batches(const std::string& gpu, Fidelity fidelity, std::vector<double>& fps) {
    const std::vector<std::uint32_t> batches{1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000};
    std::size_t best = 0;
    for (const std::uint32_t n : batches) {
        fps.push_back(run(gpu, grass(100'000, "none", 100'000 / n), fidelity).frames_per_second());
        if (fps.back() > fps[best]) best = fps.size() - 1;
    }
    return batches[best];
}

void expect_batch_curves(Fidelity fidelity) {
    std::vector<double> r420, g70;
    EXPECT_EQ(best_batches("r420", fidelity, r420), 1U);
    for (std::size_t i = 1; i < r420.size(); ++i) EXPECT_LE(r420[i], r420[i - 1]) << i; // monotone
    const std::uint32_t best = best_batches("g70", fidelity, g70);
    EXPECT_GE(best, 500U);
    EXPECT_LE(best, 1000U);
    for (std::size_t i = 12; i < g70.size(); ++i) { // beyond 5,000
        EXPECT_LT(g70[i], g70[i - 1]) << i;
        EXPECT_LT(r420[i], r420[i - 1]) << i;
    }
}

} // namespace

TEST(GeometryFeed, G4LongBatchSweepEstimated) { expect_batch_curves(Fidelity::estimate); }
TEST(GeometryFeedLong, G4BatchSweepDetailed) { expect_batch_curves(Fidelity::detailed); }

TEST(GeometryFeedLong, G5TwoRowsOfT32PredictTheOtherTwo) {
    for (const char* gpu : {"g70", "r420"}) {
        auto rows = table_of("T3.2", gpu);
        for (const auto& [name, row] : rows)
            EXPECT_LE(std::abs(row.log_error()), 0.03) << gpu << " " << name << " " << row.model;
        const auto saving = [&rows](const std::string& layout) {
            return 1000 / rows.at(layout + ", 32 bit").model - 1000 / rows.at(layout + ", 16 bit").model;
        };
        if (gpu == std::string("g70")) {
            EXPECT_NEAR(saving("OpenCCL") / saving("default"), 1.0, 0.05);
        }
    }
}

TEST(GeometryFeed, G6LongShortPositionsOnBothCards) {
    const std::vector<std::string> floats{"batch?triangles=1000000&vertices=0&index=u32"};
    const std::vector<std::string> shorts{floats[0], "quantise"};
    const std::string happy = "gen:blob?triangles=1087716&order=voxels&attributes=none";
    const reports::PreparedFrame with_floats = frame_of(happy, floats), with_shorts = frame_of(happy, shorts);
    const auto ratio = [&](const std::string& gpu, const std::map<std::string, double>& off) {
        const auto milliseconds = [&](const reports::PreparedFrame& prepared) {
            return reports::run_geometry(reports::gpu_params(gpu, off), *prepared.frame, Fidelity::estimate)
                .milliseconds;
        };
        return milliseconds(with_floats) / milliseconds(with_shorts);
    };
    EXPECT_GE(ratio("g70", {}), 1.01);
    EXPECT_LE(ratio("g70", {}), 1.08);
    EXPECT_LE(ratio("r420", {}), 1 / 7.0);
    EXPECT_GE(ratio("r420", {{"host.convert.position.s16_ns", 0}}), 1.0);
}

TEST(GeometryFeedLong, G6ShortPositionsOfTenMillionTriangles) {
    const std::vector<std::string> floats{"batch?triangles=1000000&vertices=0&index=u32"};
    const std::string thai = "gen:blob?triangles=10000000&order=voxels&attributes=none";
    const double ratio = run("g70", thai, Fidelity::estimate, floats).milliseconds /
                         run("g70", thai, Fidelity::estimate, {floats[0], "quantise"}).milliseconds;
    EXPECT_GE(ratio, 1.01);
    EXPECT_LE(ratio, 1.08);
}

TEST(GeometryFeedLong, G7AttributesOfT34InTheirOrder) {
    const auto rows = table_of("T3.4", "g70");
    const auto model = [&rows](const char* row) { return rows.at(row).model; };
    const std::vector<const char*> order{"none",      "3ub colour", "4ub colour", "3s normal",
                                         "3f colour", "4f colour",  "3f normal",  "3b normal"};
    for (std::size_t i = 1; i < order.size(); ++i)
        EXPECT_GT(model(order[i - 1]), model(order[i])) << order[i - 1] << " and " << order[i];
    EXPECT_NEAR(model("3s normal") / model("3s texcoord"), 1.0, 0.02);
    EXPECT_NEAR(model("3f normal") / model("3f texcoord"), 1.0, 0.02);
    for (const auto& [name, row] : rows) EXPECT_LE(std::abs(row.log_error()), 0.10) << name;

    const auto flat = table_of("T3.4", "r420");
    for (const char* native : {"3f normal", "4ub colour", "4f colour", "3ub colour", "3f colour"})
        EXPECT_NEAR(flat.at(native).model / flat.at("none").model, 1.0, 0.07) << native;
}

TEST(GeometryFeed, G9TimeDoesNotDependOnTheViewport) {
    const auto cycles = [](std::uint32_t side) {
        // Seen from afar, so that pixels are few beside triangles, as in the benchmark.
        const support::Replay replay("gen:grass?blades=60000", {side, side, "geometry", "0,8,14,0,0,0,45", {}});
        sim::Config config = models::load_gpu("g70");
        const auto design = models::make_design("existing", config);
        pipeline::Machine machine(reports::gpu_params("g70"), replay.frame, replay.streams, *design);
        return static_cast<double>(machine.run(replay.reference).cycles);
    };
    EXPECT_NEAR(cycles(1024) / cycles(256), 1.0, 0.02);
}

TEST(GeometryFeedLong, EstimateIsNearDetailed) {
    for (const char* scene : {"gen:grass?blades=30000", "gen:blob?triangles=200000&order=voxels",
                              "gen:blob?triangles=200000&order=random", "gen:grid-soup?boxes=3000"}) {
        const auto frame = frame_of(scene).frame;
        for (const char* gpu : {"neutral", "g70", "nv43", "r420", "rv350"}) {
            const pipeline::GpuParams params = reports::gpu_params(gpu);
            const double detailed = reports::run_geometry(params, *frame, Fidelity::detailed).milliseconds;
            const double estimate = reports::run_geometry(params, *frame, Fidelity::estimate).milliseconds;
            // Where rows of memory are opened at random, banks collide more than on average.
            const bool random = std::string_view(scene).ends_with("random");
            EXPECT_LE(estimate / detailed, 1.15) << gpu << " " << scene;
            EXPECT_GE(estimate / detailed, random ? 0.4 : 0.85) << gpu << " " << scene;
        }
    }
}

} // namespace geometry_feed_test
