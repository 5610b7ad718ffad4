// The GPU files: every number has an origin, every key is known, nothing is left out.
#include "models/gpu_library.hpp"
#include "pipeline/gpu_params.hpp"
#include "pipeline/memory/memory_system.hpp"
#include "tests/support/paths.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace {

pipeline::GpuParams params_of(sim::Config& config) {
    pipeline::GpuParams params;
    config.read("", params);
    return params;
}

TEST(GpuLibrary, EveryFileIsComplete) {
    const std::vector<std::string> origins{"public", "measured", "calibrated", "assumed", "off"};
    for (const std::string& name : models::gpu_names()) {
        SCOPED_TRACE(name);
        sim::Config config = models::load_gpu(name);
        params_of(config);
        EXPECT_NO_THROW(config.expect_all_used());
        const auto stated = config.origins();
        for (const sim::FieldInfo& field : sim::describe<pipeline::GpuParams>()) {
            ASSERT_TRUE(stated.contains(field.path)) << field.path;
            const sim::Origin& origin = stated.at(field.path);
            EXPECT_NE(std::find(origins.begin(), origins.end(), origin.origin), origins.end()) << field.path;
            EXPECT_FALSE(origin.source.empty()) << field.path;
        }
    }
}

TEST(GpuLibrary, NeutralAndG71AreOnHand) {
    const std::vector<std::string> names = models::gpu_names();
    for (const char* name : {"neutral", "g71"}) EXPECT_NE(std::find(names.begin(), names.end(), name), names.end());
}

TEST(GpuLibrary, NeutralHasTheValuesOfTheSpecification) {
    sim::Config config = models::load_gpu("neutral");
    const pipeline::GpuParams gpu = params_of(config);
    EXPECT_EQ(gpu.clock.core_mhz, 650);
    EXPECT_EQ(gpu.geometry.vertex_shader.units, 8U);
    EXPECT_EQ(gpu.geometry.vertex_shader.cycles_per_vertex, 4U);
    EXPECT_EQ(gpu.geometry.triangle_setup.cycles_per_triangle, 2U);
    EXPECT_EQ(gpu.geometry.command_processor.draw_cpu_us, 2.0);
    EXPECT_EQ(gpu.geometry.command_processor.draw_gpu_cycles, 200U);
    EXPECT_EQ(gpu.memory.partitions, 4U);
    EXPECT_EQ(gpu.memory.bandwidth, 51.2);
}

TEST(GpuLibrary, UnloadedReadOfATextureLineTakes300Cycles) {
    for (const char* name : {"neutral", "g71"}) {
        sim::Config config = models::load_gpu(name);
        const pipeline::GpuParams gpu = params_of(config);
        sim::Simulation simulation;
        const pipeline::MemorySystem memory(simulation, simulation.add_clock("core", gpu.clock.core_mhz), gpu.memory);
        EXPECT_EQ(memory.unloaded_latency(64), 300U) << name;
    }
}

TEST(GpuLibrary, PathIsTakenAsItIs) {
    const auto path = ropsim_test::source_dir() / "models/gpus/g71.toml";
    EXPECT_TRUE(models::load_gpu(path.string()).has("memory.bandwidth"));
    EXPECT_THROW(models::load_gpu("no/such/file.toml"), sim::InputError);
}

TEST(GpuLibrary, UnknownNameListsTheKnownOnes) {
    try {
        models::load_gpu("g17");
        FAIL();
    } catch (const sim::InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("unknown GPU 'g17'"), std::string::npos) << text;
        EXPECT_NE(text.find("g71"), std::string::npos) << text;
        EXPECT_NE(text.find("neutral"), std::string::npos) << text;
    }
}

} // namespace
