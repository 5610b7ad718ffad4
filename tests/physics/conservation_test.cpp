// N1 to N4: nothing is lost and nothing is counted twice, for every design that runs the program; and R2, that no unit
// does more than it declares.
#include "models/kbuffers/library.hpp"
#include "tests/physics/runs.hpp"
#include "tests/support/replay.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace physics {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string>& scenes() {
    static const std::vector<std::string> list{"gen:discs?n=60&overlap=4&width=32&height=32", "gen:quads?n=6"};
    return list;
}

/// Calls `check` for the runs of all designs on all scenes.
template <class Check>
void for_every_run(Check&& check) {
    for (const std::string& scene : scenes())
        for (const std::string& design : support::design_ids()) {
            SCOPED_TRACE(scene + " " + design);
            check(*numbers_of({.name = design,
                               .scene = scene,
                               .workload = "transparency",
                               .gpu = "neutral",
                               .design = design,
                               .width = 32,
                               .height = 32,
                               .workload_settings = {"entry=z"},
                               .settings = {}}),
                  design);
        }
}

double sum_of(const Json& numbers) {
    double sum = 0;
    for (const Json& number : numbers) sum += number.get<double>();
    return sum;
}

/// Of all links of DRAM clients.
double bytes_of_clients(const Json& links) {
    double sum = 0;
    for (const auto& link : links.items())
        if (link.key().starts_with("dram_")) sum += link.value().at("bytes").get<double>();
    return sum;
}

/// A number of every pass or draw, summed; 0 where one has none.
double sum_over(const Json& parts, const Json::json_pointer& path) {
    double sum = 0;
    for (const Json& part : parts)
        if (part.contains(path)) sum += part.at(path).get<double>();
    return sum;
}

TEST(PhysicsConservation, PHY_N1_FragmentsInAreFragmentsOut) {
    for_every_run([](const RunNumbers& run, const std::string& design) {
        const Json& passes = run.json.at("passes");
        for (const Json& pass : passes) {
            const Json& counters = pass.at("counters");
            if (!counters.contains("/raster/fragments"_json_pointer)) continue;
            const auto count = [&](const char* path) {
                const Json::json_pointer pointer(path);
                return counters.contains(pointer) ? counters.at(pointer).get<double>() : 0.0;
            };
            if (count("/raster/fragments") == 0) continue;
            EXPECT_EQ(count("/rop/fragments") + count("/fragment/peel_rejects") +
                          count("/early_depth/fragments_rejected") + count("/early_depth/fragments_beyond"),
                      count("/raster/fragments"))
                << pass.at("name") << " of " << design;
        }
    });
}

TEST(PhysicsConservation, PHY_N2_BytesAreCountedOnce) {
    for_every_run([](const RunNumbers& run, const std::string&) {
        const double dram = run.at("bytes.dram.bytes");
        EXPECT_GT(dram, 0);
        EXPECT_EQ(bytes_of_clients(run.json.at("bytes")), dram);
        double of_passes = 0, of_draws = 0;
        for (const Json& pass : run.json.at("passes"))
            of_passes += sum_of(pass.at("/counters/memory/bytes"_json_pointer));
        for (const Json& draw : run.json.at("draws"))
            for (const auto& item : draw.at("counters").items())
                if (item.key().starts_with("dram_")) of_draws += item.value().get<double>();
        EXPECT_EQ(of_passes, dram);
        EXPECT_EQ(of_draws, dram);
    });
}

TEST(PhysicsConservation, PHY_N3_ActivitiesSumToTheTime) {
    for_every_run([](const RunNumbers& run, const std::string&) {
        const double cycles = run.at("cycles");
        for (const auto& stage : run.json.at("stages").items()) {
            const double units = stage.value().contains("units")     ? stage.value().at("units").get<double>()
                                 : stage.key() == "memory_partition" ? run.at("gpu.memory.partitions")
                                                                     : 1;
            EXPECT_EQ(sum_of(stage.value().at("activity")), units * cycles) << stage.key();
        }
        for (const auto& stage : run.json.at("stalls").items())
            EXPECT_NEAR(sum_of(stage.value()), 1, 1e-9) << stage.key();
    });
}

TEST(PhysicsConservation, PHY_N4_PassesAndDrawsSumToTheRun) {
    for_every_run([](const RunNumbers& run, const std::string&) {
        EXPECT_EQ(sum_over(run.json.at("passes"), "/cycles"_json_pointer), run.at("cycles"));
        EXPECT_EQ(sum_over(run.json.at("draws"), "/counters/fragments"_json_pointer), run.at("fragments"));
        EXPECT_EQ(sum_over(run.json.at("draws"), "/counters/quads"_json_pointer), run.at("stages.rop.counters.quads"));
        EXPECT_EQ(sum_over(run.json.at("passes"), "/counters/rop/fragments"_json_pointer), run.at("fragments"));
    });
}

TEST(PhysicsBounds, PHY_R2_NoneIsExceeded) {
    for_every_run([](const RunNumbers& run, const std::string&) {
        EXPECT_GE(declared_bounds(run).size(), 16U);
        EXPECT_EQ(exceeded_bounds(run), "");
    });
}

TEST(PhysicsBounds, ABoundThatIsExceededIsNamed) {
    const auto run = numbers_of({.name = "r",
                                 .scene = "gen:quads?n=6",
                                 .workload = "transparency",
                                 .gpu = "neutral",
                                 .design = "existing",
                                 .width = 32,
                                 .height = 32,
                                 .workload_settings = {"entry=z"},
                                 .settings = {}});
    RunNumbers changed = *run;
    changed.others.at("gpu.raster.quads_per_clk") = 1e-6;
    EXPECT_NE(exceeded_bounds(changed).find("rasterizer, quads"), std::string::npos);
}

} // namespace
} // namespace physics
