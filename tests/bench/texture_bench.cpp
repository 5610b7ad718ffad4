// Speed of the sampler of recorded textures: trilinear samples of a compressed texture, as most of those recorded are,
// and bilinear ones of a cube; with the lines recorded, as the timed pipes ask for them.
#include "tests/support/texture_kit.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace pipeline;

SurfaceInfo blocks() {
    SurfaceInfo info{.name = "wall", .format = SurfaceFormat::srgb_bc3, .width = 256, .height = 256, .levels = 9};
    std::vector<std::vector<std::byte>> levels;
    for (std::uint32_t level = 0; level < info.levels; ++level) {
        const std::size_t along = (info.width_of(level) + 3) / 4;
        levels.emplace_back(along * along * 16);
        for (std::size_t i = 0; i < levels.back().size(); ++i) levels.back()[i] = static_cast<std::byte>(i * 37);
    }
    info.contents = make_contents(info, {levels.begin(), levels.end()});
    return info;
}

void run(benchmark::State& state, tests::TextureKit& kit, TextureLookup lookup) {
    std::uint64_t samples = 0;
    const auto step = [&](std::size_t coordinate, float by) {
        for (float& value : lookup.place[coordinate]) value += by;
    };
    for (auto _ : state) {
        for (int i = 0; i < 1000; ++i) {
            step(0, 0.0123F);
            step(1, 0.0071F);
            kit.work.clear();
            benchmark::DoNotOptimize(kit.sample(lookup)[0].r);
        }
        samples += 4000;
    }
    state.counters["samples/s"] = benchmark::Counter(static_cast<double>(samples), benchmark::Counter::kIsRate);
}

void texture_trilinear(benchmark::State& state) {
    tests::TextureKit kit(blocks());
    kit.sampler.min_filter = Filter::linear_mip_linear;
    kit.sampler.mag_filter = Filter::linear;
    TextureLookup lookup;
    lookup.place = {{{0, 0.0107F, 0, 0.0107F}, {0, 0, 0.009F, 0.009F}, {}, {}}}; // level 1.45
    run(state, kit, lookup);
}
BENCHMARK(texture_trilinear);

void texture_cube(benchmark::State& state) {
    SurfaceInfo info{.name = "sky", .width = 64, .height = 64, .planes = 6};
    info.contents = make_contents(info, {std::vector<std::byte>(std::size_t{64} * 64 * 6 * 4, std::byte{100})});
    tests::TextureKit kit(info, TextureKind::cube);
    kit.sampler.mag_filter = Filter::linear;
    TextureLookup lookup;
    lookup.place = {{{-9, -8.99F, -9, -8.99F}, {-3, -3, -2.99F, -2.99F}, tests::all_lanes(2), {}}};
    run(state, kit, lookup);
}
BENCHMARK(texture_cube);

} // namespace
