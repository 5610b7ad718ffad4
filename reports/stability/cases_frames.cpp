// Frames with nothing in them, with one pixel or one triangle, and surfaces at the largest sizes; samples per pixel.
#include "pipeline/functional/frame_streams.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/replay.hpp"
#include "reports/stability/scenes.hpp"
#include "traces/camera.hpp"
#include "traces/generators/screen.hpp"
#include "traces/loads.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports::stability::frames {

const std::vector<std::string> designs{"existing", "scoreboard", "blender", "multipass", "peel-rop", "interlock"};

/// Every design over a scene: fragments of the stream, the reference picture.
void all_designs(Finding& finding, const traces::Scene& scene, std::uint32_t width, std::uint32_t height,
                 double fragments) {
    for (const std::string& workload : {traces::usual_workload(), traces::nearest_surface_load().workload}) {
        const Replay replay(scene, {.width = width, .height = height, .workload = workload, .threads = 1});
        finding.error(static_cast<double>(replay.streams.back().fragments) - fragments);
        for (const std::string& design : designs) {
            const pipeline::RunResult run = replay.run(design);
            finding.error(static_cast<double>(design == "existing" ? run.unexplained_pixels() : run.wrong_pixels));
            finding.require(run.cycles > 0, "time passes");
            if (fragments == 0) finding.error(static_cast<double>(run.fragments));
        }
    }
}

void add_small_frames(std::vector<Case>& cases) {
    cases.push_back(
        {"frames.nothing-drawn", Side::below, "a frame whose passes have no draws",
         "every design ends with the cleared surfaces", "pixels", 0.0, [](Finding& finding) {
             for (const std::string& workload : {traces::usual_workload(), traces::nearest_surface_load().workload}) {
                 Replay replay("gen:stack?n=3", {.width = 16, .height = 16, .workload = workload, .threads = 1});
                 for (pipeline::Pass& pass : replay.frame.passes) pass.draws.clear();
                 replay.streams = pipeline::rasterize_frame(replay.frame);
                 replay.reference = pipeline::run_reference(replay.frame, replay.streams);
                 for (const std::string& design : designs) {
                     const auto run = replay.run(design);
                     finding.error(static_cast<double>(run.wrong_pixels + run.fragments));
                 }
             }
         }});
    cases.push_back({"frames.nothing-visible", Side::below,
                     "triangles beside the viewport, before the near and behind the far plane",
                     "no fragment, every design ends", "pixels", 0.0, [](Finding& finding) {
                         all_designs(finding,
                                     screen_scene({{{-50, 1, 0.5F}, {-50, 9, 0.5F}, {-40, 5, 0.5F}},
                                                   {{1, 1, -0.5F}, {1, 9, -0.5F}, {9, 5, -0.5F}},
                                                   {{1, 1, 1.5F}, {1, 9, 1.5F}, {9, 5, 1.5F}}}),
                                     16, 16, 0);
                     }});
    cases.push_back({"frames.all-faces-culled", Side::below, "a closed mesh seen from inside, one-sided",
                     "no fragment, every primitive culled by facing", "fragments", 0.0, [](Finding& finding) {
                         traces::Scene scene = world_scene({{-1, -1, -5}, {0, 1, -5}, {1, -1, -5}}); // clockwise
                         scene.resources->materials[0].double_sided = false;
                         traces::finish_scene(scene);
                         pipeline::FrontEndOptions options;
                         const std::vector<std::uint32_t> draws{0};
                         const auto stream = pipeline::rasterize(*scene.resources, scene.draws, draws,
                                                                 perspective_view(16, 16, 60, 0.1, 100), options);
                         finding.error(static_cast<double>(stream.fragments));
                         finding.require(stream.primitives[0].fate == pipeline::PrimitiveFate::culled_facing,
                                         "culled by facing");
                         options.both_faces = true;
                         const auto both = pipeline::rasterize(*scene.resources, scene.draws, draws,
                                                               perspective_view(16, 16, 60, 0.1, 100), options);
                         finding.require(both.fragments > 0, "drawn where both faces are");
                         const Replay replay(scene, {.width = 16,
                                                     .height = 16,
                                                     .workload = traces::nearest_surface_load().workload,
                                                     .camera = "0,0,0,0,0,-1,60",
                                                     .threads = 1});
                         for (const std::string& design : designs)
                             finding.error(static_cast<double>(replay.run(design).fragments));
                     }});
    cases.push_back({"frames.no-pixel-centre", Side::below, "100 triangles between the pixel centres",
                     "100 triangles, no quad, every design ends", "pixels", 0.0, [](Finding& finding) {
                         std::vector<ScreenTriangle> triangles;
                         for (int i = 0; i < 100; ++i) {
                             const int row = i / 10;
                             const auto x = static_cast<float>(i % 10), y = static_cast<float>(row);
                             triangles.push_back(
                                 {{x + 0.6F, y + 0.6F, 0.5F}, {x + 0.6F, y + 0.9F, 0.5F}, {x + 0.9F, y + 0.6F, 0.5F}});
                         }
                         all_designs(finding, screen_scene(triangles), 16, 16, 0);
                     }});
    cases.push_back({"frames.one-pixel", Side::at, "a frame of one pixel under 9 layers",
                     "9 fragments, the reference picture", "pixels", 0.0, [](Finding& finding) {
                         std::vector<float> depths;
                         for (int i = 1; i < 10; ++i) depths.push_back(static_cast<float>(i * 7 % 10) / 10.0F);
                         all_designs(finding, layers_of(1, 1, depths), 1, 1, 9);
                     }});
    cases.push_back(
        {"frames.one-triangle", Side::at, "one triangle over the lower left half of 16x16 pixels",
         "120 or 136 fragments: the diagonal belongs to one side; every design", "pixels", 0.0, [](Finding& finding) {
             // The diagonal runs through pixel centres; it is a right-hand edge of this triangle: not covered.
             all_designs(finding, screen_scene({{{0, 0, 0.5F}, {0, 16, 0.5F}, {16, 16, 0.5F}}}), 16, 16, 120);
         }});
    cases.push_back(
        {"frames.odd-sizes", Side::above, "frames of 1x64, 64x1, 3x5, 7x7 and 17x33 pixels under 3 layers",
         "3 fragments a pixel, the reference picture", "pixels", 0.0, [](Finding& finding) {
             const std::array depths{0.7F, 0.3F, 0.5F};
             for (const auto& [width, height] : {std::pair(1U, 64U), {64U, 1U}, {3U, 5U}, {7U, 7U}, {17U, 33U}})
                 all_designs(finding, layers_of(width, height, depths), width, height, 3.0 * width * height);
         }});
    cases.push_back(
        {"frames.coincident", Side::at, "256 triangles in one place at one depth, k = 1, 4 and 64",
         "the first k; every design as the reference", "pixels", 0.0, [](Finding& finding) {
             const traces::Scene scene =
                 screen_scene(std::vector<ScreenTriangle>(256, {{0, 0, 0.5F}, {0, 16, 0.5F}, {16, 0, 0.5F}}));
             for (const int k : {1, 4, 64}) {
                 const Replay replay(scene, {.width = 8, .height = 8, .knobs = {fmt::format("k={}", k)}, .threads = 1});
                 for (const char* design : {"scoreboard", "blender", "multipass", "peel-rop"})
                     finding.error(static_cast<double>(replay.run(design).wrong_pixels));
             }
         }});
}

/// One triangle in the last pixel of a surface and one over its first: both are found.
void corners_of(Finding& finding, std::uint32_t width, std::uint32_t height) {
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    const traces::Scene scene = screen_scene(
        {{{0, 0, 0.25F}, {0, 2, 0.25F}, {2, 0, 0.25F}}, {{w, h, 0.5F}, {w, h - 2, 0.5F}, {w - 2, h, 0.5F}}});
    const Replay replay(
        scene, {.width = width, .height = height, .workload = traces::nearest_surface_load().workload, .threads = 1});
    const auto& image = replay.reference;
    finding.error(static_cast<double>(image.depth.size()) - static_cast<double>(width) * height);
    finding.require(image.depth.front() < 0.26F && image.depth.back() < 0.51F, "first and last pixel are covered");
    const auto covered = static_cast<double>(
        std::count_if(image.depth.begin(), image.depth.end(), [](float depth) { return depth < 1.0F; }));
    finding.error(covered - static_cast<double>(replay.streams[0].fragments));
    // The corner (1.5, 0.5) of the first triangle lies on its diagonal, which is a right-hand edge; of the second a
    // left one.
    finding.require(replay.streams[0].fragments == 4, "1 and 3 pixels");
    const auto run = replay.run("existing");
    finding.error(static_cast<double>(run.wrong_pixels));
}

void add_surfaces(std::vector<Case>& cases) {
    cases.push_back({"frames.surface-1x1", Side::below, "viewports of 0 pixels", "refused; 1x1 is taken", "", 0.0,
                     [](Finding& finding) {
                         const traces::Scene scene = layers_of(1, 1, std::array{0.5F});
                         traces::make_view(scene, "auto", 1, 1);
                         finding.refuses([&] { traces::make_view(scene, "auto", 0, 16); }, "1 to 16384");
                         finding.refuses([&] { traces::make_view(scene, "auto", 16, 0); }, "1 to 16384");
                     }});
    cases.push_back({"frames.surface-wide", Side::at, "a surface of 16384 x 16 pixels",
                     "its first and its last pixel are drawn, and nothing else", "pixels", 0.0,
                     [](Finding& finding) { corners_of(finding, 16384, 16); }});
    cases.push_back({"frames.surface-high", Side::at, "a surface of 16 x 16384 pixels",
                     "its first and its last pixel are drawn, and nothing else", "pixels", 0.0,
                     [](Finding& finding) { corners_of(finding, 16, 16384); }});
    cases.push_back({"frames.surface-full", Side::at, "a rectangle over 16384 x 16 and 16 x 16384 pixels",
                     "262,144 fragments, one a pixel", "fragments", 0.0, [](Finding& finding) {
                         for (const auto& [width, height] : {std::pair(16384U, 16U), {16U, 16384U}}) {
                             traces::Scene scene = layers_of(width, height, std::array{0.5F});
                             const auto stream = rasterized(scene, pixel_view(width, height));
                             finding.error(static_cast<double>(stream.fragments) - 262144.0);
                             finding.error(most_covered(stream) - 1.0);
                         }
                     }});
    cases.push_back({"frames.surface-too-large", Side::above, "surfaces of 16385 pixels along a side", "refused", "",
                     0.0, [](Finding& finding) {
                         const traces::Scene scene = layers_of(1, 1, std::array{0.5F});
                         finding.refuses([&] { traces::make_view(scene, "auto", 16385, 16); }, "1 to 16384");
                         finding.refuses([&] { traces::make_view(scene, "auto", 16, 16385); }, "1 to 16384");
                     }});
}

void add_samples(std::vector<Case>& cases) {
    const auto samples = [](Finding& finding, std::uint32_t count) {
        // A vertical edge through the middle of the picture's pixels covers half of their samples.
        const Replay replay(screen_scene({{{-20, -20, 0.5F}, {-20, 60, 0.5F}, {4.5F, -20, 0.5F}},
                                          {{4.5F, -20, 0.5F}, {-20, 60, 0.5F}, {4.5F, 60, 0.5F}}}),
                            {.width = 9, .height = 8, .threads = 1, .samples = count});
        finding.error(static_cast<double>(replay.streams[0].fragments) -
                      8.0 * (4 * count + (count == 1 ? 0 : count / 2)));
        for (const char* design : {"blender", "scoreboard", "multipass"})
            finding.error(static_cast<double>(replay.run(design).wrong_pixels));
    };
    cases.push_back({"frames.samples-1", Side::below, "an edge through pixel centres, one sample",
                     "the centre on a right-hand edge is not covered; the designs as the reference", "fragments", 0.0,
                     [samples](Finding& finding) { samples(finding, 1); }});
    cases.push_back({"frames.samples-4", Side::at,
                     "an edge through pixel centres, 4 samples: in the shader every sample is a fragment of its own",
                     "half of the samples of its pixels; the designs as the reference", "fragments", 0.0,
                     [samples](Finding& finding) { samples(finding, 4); }});
    cases.push_back({"frames.samples-8", Side::above, "an edge through pixel centres, 8 samples",
                     "half of the samples of its pixels; the designs as the reference", "fragments", 0.0,
                     [samples](Finding& finding) { samples(finding, 8); }});
    cases.push_back({"frames.uneven-clear", Side::whole,
                     "a k-buffer whose floats have different initial values, cleared by marks and by writing",
                     "the same pictures: no format of channels is assumed", "pixels", 0.0, [](Finding& finding) {
                         const Replay replay(
                             "gen:discs?n=20&overlap=3&width=24&height=24",
                             {.width = 24, .height = 24, .knobs = {"program=order-and-blend", "k=3"}, .threads = 1});
                         for (const char* fast : {"rop.fast_clear=true", "rop.fast_clear=false"})
                             finding.error(static_cast<double>(replay.run("blender", {fast}).wrong_pixels));
                         const auto many = replay.run("blender", {"rop.fast_clear=true", "rop.clear_sectors=1"});
                         finding.error(static_cast<double>(many.wrong_pixels));
                     }});
}

} // namespace reports::stability::frames

std::vector<reports::stability::Case> reports::stability::frame_cases() {
    std::vector<Case> cases;
    frames::add_small_frames(cases);
    frames::add_surfaces(cases);
    frames::add_samples(cases);
    return cases;
}
