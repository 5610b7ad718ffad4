// Speed of the functional front end and of the reference.
#include "pipeline/functional/front_end.hpp"
#include "pipeline/reference.hpp"
#include "sim/random.hpp"
#include "tests/support/functional_scene.hpp"

#include <benchmark/benchmark.h>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace {

using tests::FunctionalScene;
using tests::MeshData;

/// A wavy indexed grid of 2 * n * n triangles that fills the picture in perspective, with normals.
MeshData wavy_grid(std::uint32_t n) {
    MeshData mesh;
    for (std::uint32_t row = 0; row <= n; ++row)
        for (std::uint32_t column = 0; column <= n; ++column) {
            const double x = 2.0 * column / n - 1.0, y = 2.0 * row / n - 1.0;
            mesh.positions.emplace_back(x, y, 0.1 * std::sin(9.0 * x) * std::cos(7.0 * y));
            mesh.normals.emplace_back(-0.9 * std::cos(9.0 * x), 0.7 * std::sin(7.0 * y), 1.0);
            mesh.texcoords.emplace_back(4.0 * x, 4.0 * y);
        }
    for (std::uint32_t row = 0; row < n; ++row)
        for (std::uint32_t column = 0; column < n; ++column) {
            const std::uint32_t a = row * (n + 1) + column, c = a + n + 1;
            for (const std::uint32_t index : {a, a + 1, c, c, a + 1, c + 1}) mesh.indices.push_back(index);
        }
    return mesh;
}

FunctionalScene grid_scene(std::uint32_t n, std::uint32_t width, std::uint32_t height, bool textured) {
    FunctionalScene scene(width, height);
    scene.view.projection =
        glm::perspective(glm::radians(60.0F), static_cast<float>(width) / static_cast<float>(height), 0.1F, 10.0F);
    scene.view.view = glm::lookAt(glm::vec3(0.1F, 0.2F, 1.6F), glm::vec3(0), glm::vec3(0, 1, 0));
    pipeline::Material material;
    material.double_sided = true;
    if (textured) {
        sim::Random random(1, "texels");
        std::vector<std::uint32_t> texels(256 * 256);
        for (std::uint32_t& texel : texels) texel = static_cast<std::uint32_t>(random.below(1ULL << 32U));
        pipeline::Texture texture = tests::texture_of(256, 256, texels);
        texture.make_mips();
        material.base_texture = static_cast<std::int32_t>(scene.add_texture(texture));
    }
    scene.add(wavy_grid(n), scene.add_material(material));
    scene.resources.place();
    scene.resources.validate("benchmark");
    return scene;
}

void rasterize_scene(benchmark::State& state, const FunctionalScene& scene, bool colours) {
    pipeline::FrontEndOptions options;
    options.threads = 1;
    options.colours = colours;
    std::uint64_t triangles = 0, fragments = 0, quads = 0, bytes = 0;
    for (auto _ : state) {
        const auto stream = pipeline::rasterize(scene.resources, scene.draws, scene.all_draws(), scene.view, options);
        triangles += stream.primitives.size();
        fragments += stream.fragments;
        quads += stream.quads.size();
        bytes = stream.bytes() / stream.quads.size();
    }
    using Counter = benchmark::Counter;
    state.counters["triangles/s"] = Counter(static_cast<double>(triangles), Counter::kIsRate);
    state.counters["fragments/s"] = Counter(static_cast<double>(fragments), Counter::kIsRate);
    state.counters["quads/s"] = Counter(static_cast<double>(quads), Counter::kIsRate);
    state.counters["bytes/quad"] = Counter(static_cast<double>(bytes));
}

void front_end_million_small_triangles(benchmark::State& state) {
    const FunctionalScene scene = grid_scene(707, 1024, 1024, false);
    rasterize_scene(state, scene, state.range(0) != 0);
}
BENCHMARK(front_end_million_small_triangles)->ArgName("colours")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void front_end_large_triangles(benchmark::State& state) {
    const FunctionalScene scene = grid_scene(8, 1920, 1080, state.range(0) != 0);
    rasterize_scene(state, scene, true);
}
BENCHMARK(front_end_large_triangles)->ArgName("textured")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void reference_depth(benchmark::State& state) {
    const FunctionalScene scene = grid_scene(707, 1024, 1024, false);
    pipeline::Frame frame;
    frame.view = scene.view;
    frame.draws = scene.draws;
    pipeline::Pass pass;
    pass.states[0].depth = {true, true};
    pass.targets = {tests::colour_surface};
    frame.passes = {pass};
    tests::bind_surfaces(frame);
    const std::vector<pipeline::FragmentStream> streams{
        pipeline::rasterize(scene.resources, scene.draws, scene.all_draws(), scene.view)};
    std::uint64_t fragments = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(pipeline::run_reference(frame, streams, 1, 1));
        fragments += streams[0].fragments;
    }
    state.counters["fragments/s"] = benchmark::Counter(static_cast<double>(fragments), benchmark::Counter::kIsRate);
}
BENCHMARK(reference_depth)->Unit(benchmark::kMillisecond);

} // namespace
