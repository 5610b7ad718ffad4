// Speed of modify programs, built in, interpreted, and in GLSL: fragments per second into pixels of random depth order.
#include "models/programs/language/user_program.hpp"
#include "models/programs/nearest_k.hpp"
#include "models/programs/order_and_blend.hpp"
#include "sim/random.hpp"
#include "traces/glsl.hpp"
#include "traces/user_programs.hpp"

#include <array>
#include <benchmark/benchmark.h>
#include <vector>

namespace {

using pipeline::ModifyProgram;

void run_program(benchmark::State& state, const ModifyProgram& program) {
    constexpr std::size_t fragments_per_pixel = 16, pixels = 256;
    sim::Random random(1, "fragments");
    std::vector<std::array<float, 4>> entries(fragments_per_pixel * pixels);
    for (auto& entry : entries)
        for (float& value : entry) value = static_cast<float>(random.uniform());
    std::vector<float> pixel(program.floats_per_pixel());
    std::uint64_t fragments = 0;
    for (auto _ : state) {
        for (std::size_t i = 0; i < entries.size(); ++i) {
            if (i % fragments_per_pixel == 0) program.clear(pixel.data());
            benchmark::DoNotOptimize(program.insert(pixel.data(), entries[i].data()));
        }
        fragments += entries.size();
    }
    state.counters["fragments/s"] = benchmark::Counter(static_cast<double>(fragments), benchmark::Counter::kIsRate);
    state.counters["operations"] = static_cast<double>(program.cost().operations);
}

std::uint32_t k_of(const benchmark::State& state) { return static_cast<std::uint32_t>(state.range(0)); }

void program_nearest_k(benchmark::State& state) {
    run_program(state, *models::make_nearest_k(models::EntryKind::rgbz, k_of(state)));
}
void program_nearest_k_interpreted(benchmark::State& state) {
    run_program(state, *models::load_user_program("nearest_k.kb", k_of(state)).program);
}
void program_order_and_blend(benchmark::State& state) {
    run_program(state, *models::make_order_and_blend(k_of(state), 0.5F));
}
void program_order_and_blend_interpreted(benchmark::State& state) {
    run_program(state, *models::load_user_program("order_and_blend.kb", k_of(state)).program);
}

void run_glsl_program(benchmark::State& state, const char* file) {
    if (!traces::can_compile_glsl()) return state.SkipWithError("built without glslang");
    run_program(state, *traces::chosen_program(file, {"", k_of(state), 0.5F}).program);
}
void program_nearest_k_glsl(benchmark::State& state) { run_glsl_program(state, "nearest_k.glsl"); }
void program_order_and_blend_glsl(benchmark::State& state) { run_glsl_program(state, "order_and_blend.glsl"); }

BENCHMARK(program_nearest_k)->ArgName("k")->Arg(4)->Arg(16);
BENCHMARK(program_nearest_k_interpreted)->ArgName("k")->Arg(4)->Arg(16);
BENCHMARK(program_nearest_k_glsl)->ArgName("k")->Arg(4)->Arg(16);
BENCHMARK(program_order_and_blend)->ArgName("k")->Arg(4)->Arg(16);
BENCHMARK(program_order_and_blend_interpreted)->ArgName("k")->Arg(4)->Arg(16);
BENCHMARK(program_order_and_blend_glsl)->ArgName("k")->Arg(4)->Arg(16);

} // namespace
