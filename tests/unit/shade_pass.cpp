// Shaders that passes bring: what they are given, where their outputs go, what they discard.
#include "pipeline/functional/shade_pass.hpp"
#include "pipeline/functional/frame_streams.hpp"
#include "pipeline/reference.hpp"
#include "sim/check.hpp"
#include "tests/support/functional_scene.hpp"
#include "tests/support/test_shaders.hpp"
#include "traces/pass_graph.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <memory>

namespace shade_pass_test {

using pipeline::Frame;
using pipeline::SurfaceFormat;
using tests::FunctionalScene;
using traces::PassGraph;
using traces::ShadedPass;

constexpr std::uint32_t width = 10, height = 6;

/// A rectangle over the left half with a normal that looks to the right and towards the eye, of half green.
FunctionalScene half_screen() {
    FunctionalScene scene(width, height);
    tests::MeshData mesh = tests::rectangle(0, 0, 5, 6, 0.25F);
    mesh.normals.assign(mesh.positions.size(), glm::vec3(3, 0, 4));
    pipeline::Material green;
    green.base_colour = {0, 0.5F, 0, 1};
    green.double_sided = true;
    scene.add(mesh, scene.add_material(green));
    return scene;
}

Frame empty_frame(FunctionalScene& scene) {
    scene.resources.place();
    scene.resources.validate("scene");
    Frame frame;
    frame.resources = std::make_shared<pipeline::Resources>(scene.resources);
    frame.draws = scene.draws;
    frame.view = scene.view;
    return frame;
}

ShadedPass gbuffer_pass() {
    ShadedPass pass;
    pass.name = "G-buffer";
    pass.shader = std::make_shared<tests::GBufferShader>();
    pass.targets = {"albedo", "normals"};
    pass.draws = {0};
    pass.depth = traces::depth_surface;
    pass.states[0].depth = {true, true};
    return pass;
}

ShadedPass lighting_pass() {
    ShadedPass pass;
    pass.name = "lighting";
    pass.shader = std::make_shared<tests::LightingShader>();
    pass.reads = {"albedo", "normals"};
    pass.targets = {"picture"};
    pass.screen = true;
    return pass;
}

/// Normals are cleared to (0.5, 0.5, 0.5), which stands for none.
PassGraph deferred(FunctionalScene& scene) {
    PassGraph graph(empty_frame(scene));
    graph.add_surface("albedo", SurfaceFormat::rgba8);
    graph.add_surface("normals", SurfaceFormat::rgba32f, glm::vec4(0.5F));
    graph.add_surface("picture", SurfaceFormat::rgba32f);
    graph.add_clear("clear", {"albedo", "normals", traces::depth_surface});
    graph.add_shaded(gbuffer_pass());
    graph.add_shaded(lighting_pass());
    graph.output("picture");
    return graph;
}

TEST(ShadePass, AShaderIsGivenWhatItsShapeAsksFor) {
    FunctionalScene scene = half_screen();
    const Frame frame = deferred(scene).lower();
    const pipeline::FragmentStream stream = pipeline::rasterize_frame(frame)[0];
    const pipeline::ShaderInput input = pipeline::shader_input(stream, 0);
    EXPECT_EQ(input.pixels, 15U);
    EXPECT_EQ(input.draw, 0U);
    EXPECT_EQ(input.depth[3], 0.25F);
    EXPECT_EQ(input.colour[0], glm::vec4(0, 0.5F, 0, 1)); // without the light
    EXPECT_NEAR(input.normal[2].x, 0.6F, 1e-6F);
    EXPECT_NEAR(input.normal[2].z, 0.8F, 1e-6F);
    EXPECT_TRUE(frame.needs.normals);
    EXPECT_TRUE(frame.needs.fragment_normals);
}

TEST(ShadePass, OutputsGoToTheirTargetsAndAreReadByTheNextPass) {
    FunctionalScene scene = half_screen();
    const Frame frame = deferred(scene).lower();
    const auto image = pipeline::run_reference(frame, pipeline::rasterize_frame(frame));
    const float albedo = 128.0F / 255.0F; // as 8 bits keep a half
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const float* pixel = image.colour.data() + (std::size_t{y} * width + x) * 4;
            EXPECT_EQ(pixel[0], 0.0F);
            EXPECT_NEAR(pixel[1], x < 5 ? albedo * 0.8F : 0.0F, 1e-6F) << x << ' ' << y;
            EXPECT_EQ(pixel[3], 1.0F); // every pixel of the screen
        }
}

TEST(ShadePass, OnlyWhatNobodyAsksForBeforeIsShadedLate) {
    FunctionalScene scene = half_screen();
    const Frame frame = deferred(scene).lower();
    const auto streams = pipeline::rasterize_frame(frame);
    const auto of_kind = [&frame](pipeline::PassKind kind) {
        return *std::find_if(frame.passes.begin(), frame.passes.end(),
                             [kind](const pipeline::Pass& pass) { return pass.kind == kind; });
    };
    const pipeline::Pass lighting = of_kind(pipeline::PassKind::screen);
    EXPECT_TRUE(pipeline::shades_late(lighting, streams[1]));
    EXPECT_FALSE(pipeline::shades_late(of_kind(pipeline::PassKind::draw), streams[0]));
    pipeline::Pass discarding = lighting, onto_itself = lighting;
    discarding.shader = std::make_shared<tests::SieveShader>();
    onto_itself.targets = {lighting.reads[0]};
    EXPECT_FALSE(pipeline::shades_late(discarding, streams[1]));
    EXPECT_FALSE(pipeline::shades_late(onto_itself, streams[1]));
}

TEST(ShadePass, SameForAnyNumberOfThreads) {
    FunctionalScene scene = half_screen();
    const Frame frame = deferred(scene).lower();
    pipeline::FrontEndOptions options;
    options.threads = 1;
    const auto streams = pipeline::rasterize_frame(frame, options);
    options.threads = 3;
    const auto again = pipeline::rasterize_frame(frame, options);
    ASSERT_EQ(streams.size(), 2U);
    EXPECT_TRUE(tests::equal(streams[0], again[0]));
    EXPECT_EQ(streams[0].more_outputs, again[0].more_outputs);
    EXPECT_EQ(pipeline::run_reference(frame, streams, 1, 1).colour,
              pipeline::run_reference(frame, streams, 1, 3).colour);
}

TEST(ShadePass, AnOutputNobodyReadsIsNotWritten) {
    FunctionalScene scene = half_screen();
    PassGraph graph(empty_frame(scene));
    graph.add_surface("albedo", SurfaceFormat::rgba8);
    graph.add_surface("normals", SurfaceFormat::rgba16f);
    graph.add_shaded(gbuffer_pass());
    graph.output("normals");
    const Frame frame = graph.lower();
    ASSERT_EQ(frame.surfaces.size(), 2U); // depth and normals
    EXPECT_EQ(frame.passes[0].targets.size(), 2U);
    EXPECT_EQ(frame.passes[0].targets[0], pipeline::no_surface);
    EXPECT_EQ(frame.left_out[0].unit, "albedo of pass G-buffer");
    const auto image = pipeline::run_reference(frame, pipeline::rasterize_frame(frame));
    EXPECT_NEAR(image.colour[2], 0.9F, 1e-3F); // (0.8 + 1) / 2 as 16 bits keep it
}

TEST(ShadePass, DiscardedFragmentsWriteNothing) {
    FunctionalScene scene = half_screen();
    PassGraph graph(empty_frame(scene));
    const auto shader = std::make_shared<tests::SieveShader>();
    ShadedPass pass = gbuffer_pass();
    pass.shader = shader;
    pass.targets = {traces::colour_surface};
    graph.add_clear("clear", {traces::colour_surface});
    graph.add_shaded(pass);
    graph.output(traces::colour_surface);
    Frame frame = graph.lower();
    const auto streams = pipeline::rasterize_frame(frame);
    EXPECT_EQ(streams[0].fragments, 30U);
    EXPECT_EQ(streams[0].fragments_discarded, 12U); // columns 1 and 3
    EXPECT_EQ(shader->calls, streams[0].quads.size());
    EXPECT_FALSE(frame.needs.colours);
    EXPECT_FALSE(frame.needs.normals);
    const auto image = pipeline::run_reference(frame, streams);
    for (std::uint32_t x = 0; x < 5; ++x) EXPECT_NEAR(image.depth[x], x % 2 == 0 ? 0.25F : 1.0F, 1e-6F) << x;
}

TEST(ShadePass, AGroupOfSamplesIsShadedOnce) {
    FunctionalScene scene = half_screen();
    scene.view.samples = 4;
    PassGraph graph(empty_frame(scene));
    const auto shader = std::make_shared<tests::SieveShader>();
    ShadedPass pass = gbuffer_pass();
    pass.shader = shader;
    pass.targets = {traces::colour_surface};
    graph.add_shaded(pass);
    graph.output(traces::colour_surface);
    const Frame frame = graph.lower();
    const auto streams = pipeline::rasterize_frame(frame);
    EXPECT_EQ(shader->calls, streams[0].groups);
    EXPECT_LT(streams[0].groups, streams[0].quads.size());
    EXPECT_EQ(streams[0].fragments_discarded, 48U);
}

TEST(PassGraph, PassesOverTheScreenOverwriteWhatWasThere) {
    FunctionalScene scene = half_screen();
    PassGraph graph(empty_frame(scene));
    graph.add_surface("albedo", SurfaceFormat::rgba8);
    graph.add_surface("normals", SurfaceFormat::rgba8);
    graph.add_surface("picture", SurfaceFormat::rgba8);
    graph.add_clear("clear all", {"albedo", "normals", "picture"});
    graph.add_shaded(gbuffer_pass());
    graph.add_shaded(lighting_pass());
    graph.output("picture");
    const Frame frame = graph.lower();
    EXPECT_EQ(frame.passes[0].clears.size(), 2U);
    EXPECT_EQ(frame.surfaces[frame.output].name, "picture");
    EXPECT_TRUE(frame.screen_draw.has_value());
}

std::string error_of(FunctionalScene& scene, ShadedPass pass) {
    PassGraph graph(empty_frame(scene));
    graph.add_surface("albedo", SurfaceFormat::rgba8);
    graph.add_surface("picture", SurfaceFormat::rgba8);
    try {
        graph.add_shaded(std::move(pass));
        graph.output("picture");
        graph.lower();
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

TEST(PassGraph, APassMayNotReadWhatItWritesNorWhatNobodyWrites) {
    FunctionalScene scene = half_screen();
    ShadedPass pass = lighting_pass();
    pass.reads = {"picture", "albedo"};
    EXPECT_EQ(error_of(scene, pass), "pass lighting: it reads the surface picture, which it writes");
    EXPECT_EQ(error_of(scene, lighting_pass()), "pass lighting: it reads the surface albedo, which no pass writes");
}

} // namespace shade_pass_test
