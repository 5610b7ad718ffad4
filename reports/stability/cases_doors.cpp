// What is not a number, and what is infinite, offered at every door.
#include "models/programs/depth_partition.hpp"
#include "models/programs/isosurface.hpp"
#include "models/programs/language/user_program.hpp"
#include "models/programs/mlab.hpp"
#include "models/programs/order_and_blend.hpp"
#include "models/programs/preintegration.hpp"
#include "pipeline/functional/texture_sampler.hpp"
#include "pipeline/functional/vertex_transform.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/replay.hpp"
#include "reports/stability/scenes.hpp"
#include "sim/config.hpp"
#include "traces/area_light.hpp"
#include "traces/camera.hpp"
#include "traces/generators/mesh.hpp"
#include "traces/shadows/shadow_map.hpp"
#include "traces/tetrahedra/tetrahedral_mesh.hpp"
#include "traces/workloads.hpp"

#include <cstring>
#include <fmt/format.h>

namespace reports::stability::doors {

constexpr std::array bad_values{not_a_number, infinity, -infinity};

traces::Scene triangle() {
    traces::Scene scene = screen_scene({{{1, 1, 0.5F}, {1, 60, 0.5F}, {60, 1, 0.5F}}});
    return scene;
}

/// Replaces the first float of an attribute's buffer.
void spoil(traces::Scene& scene, pipeline::Semantic semantic, float value) {
    const pipeline::VertexAttribute* attribute = scene.resources->geometries[0].find(semantic);
    std::memcpy(scene.resources->buffers[attribute->buffer].bytes.data() + attribute->offset, &value, sizeof(value));
}

/// A triangle with floats as colours, normals and texture coordinates, lit and textured.
traces::Scene shaded_triangle() {
    traces::Mesh mesh;
    mesh.name = "triangle";
    mesh.positions = {{1, 1, 0.5F}, {1, 60, 0.5F}, {60, 1, 0.5F}};
    mesh.normals.assign(3, glm::vec3(0, 0, 1));
    traces::Scene scene = traces::scene_of_material("textured", glm::vec4(1.0F));
    traces::MeshFormat format;
    format.attributes = traces::read_attribute_formats("normal:3f32+colour:4f32+texcoord:2f32", "stability");
    traces::add_draws(scene, mesh, {traces::whole(mesh)}, format, "stability");
    pipeline::Texture texture;
    texture.levels.push_back({2, 2, std::vector<std::uint8_t>(16, 200), 0});
    texture.make_mips();
    scene.resources->textures.push_back(texture);
    scene.resources->materials[0].base_texture = 0;
    scene.name = "triangle";
    return scene;
}

void spoiled_shading(Finding& finding, pipeline::Semantic semantic) {
    for (const float bad : {not_a_number, infinity, -infinity, largest_float, -largest_float}) {
        traces::Scene scene = shaded_triangle();
        spoil(scene, semantic, bad);
        const auto stream = rasterized(scene, pixel_view(64, 64));
        finding.require(stream.fragments > 1000, "it is drawn");
        finding.require(all_finite(stream), fmt::format("finite with {}", bad));
    }
}

Case door(std::string name, std::string subject, std::string expectation, std::function<void(Finding&)> check) {
    return {
        "doors." + std::move(name), Side::above, std::move(subject), std::move(expectation), "", 0.0, std::move(check)};
}

void add_scene_doors(std::vector<Case>& cases) {
    cases.push_back(door("positions", "NaN and infinity as a position",
                         "refused when the scene is finished; degenerate before the rasterizer", [](Finding& finding) {
                             for (const float bad : bad_values) {
                                 traces::Scene scene = triangle();
                                 spoil(scene, pipeline::Semantic::position, bad);
                                 const auto stream = rasterized(scene, pixel_view(64, 64));
                                 finding.require(stream.fragments == 0 &&
                                                     stream.primitives[0].fate ==
                                                         pipeline::PrimitiveFate::culled_degenerate,
                                                 "degenerate");
                                 finding.refuses([&] { traces::finish_scene(scene); }, "finite");
                             }
                         }));
    cases.push_back(door("matrices", "NaN and infinity in a model matrix",
                         "refused when the scene is finished, and before it is drawn", [](Finding& finding) {
                             for (const float bad : bad_values) {
                                 traces::Scene scene = triangle();
                                 scene.draws[0].instances[0][0][0] = bad;
                                 finding.refuses([&] { rasterized(scene, pixel_view(64, 64)); },
                                                 "matrices of finite numbers");
                                 finding.refuses([&] { traces::finish_scene(scene); }, "finite");
                             }
                         }));
    cases.push_back(
        door("clip-coordinates", "NaN and infinity as each clip coordinate",
             "not finite: one bit of the outcode, no other", [](Finding& finding) {
                 const pipeline::Viewport viewport(64, 64);
                 for (const float bad : bad_values)
                     for (int i = 0; i < 4; ++i) {
                         glm::vec4 clip(0.5F);
                         clip[i] = bad;
                         finding.require(viewport.outcode(clip) == pipeline::outside::not_finite, "not finite");
                     }
                 finding.require(viewport.outcode(glm::vec4(largest_float)) != pipeline::outside::not_finite,
                                 "the largest float is finite");
             }));
    cases.push_back(door("colours", "NaN, infinity and 3e38 as a vertex colour", "finite colours in every fragment",
                         [](Finding& finding) { spoiled_shading(finding, pipeline::Semantic::colour); }));
    cases.push_back(door("normals", "NaN, infinity and 3e38 in a normal", "finite colours in every fragment",
                         [](Finding& finding) { spoiled_shading(finding, pipeline::Semantic::normal); }));
    cases.push_back(door("normals-of-no-length", "normals of length 0 and 1e-30",
                         "finite colours, ambient light at least", [](Finding& finding) {
                             for (const float length : {0.0F, 1e-30F}) {
                                 traces::Scene scene = shaded_triangle();
                                 const pipeline::VertexAttribute* normal =
                                     scene.resources->geometries[0].find(pipeline::Semantic::normal);
                                 for (std::size_t i = 0; i < 3; ++i) {
                                     const glm::vec3 one(0.0F, 0.0F, length);
                                     std::memcpy(scene.resources->buffers[normal->buffer].bytes.data() +
                                                     normal->offset + i * normal->stride,
                                                 &one, 12);
                                 }
                                 const auto stream = rasterized(scene, pixel_view(64, 64));
                                 finding.require(all_finite(stream), "finite");
                                 finding.require(stream.colours[stream.colours.size() / 2][0].r > 0.01F, "not black");
                             }
                         }));
    cases.push_back(door("texture-coordinates", "NaN, infinity and 3e38 as a texture coordinate",
                         "finite colours in every fragment",
                         [](Finding& finding) { spoiled_shading(finding, pipeline::Semantic::texcoord0); }));
    cases.push_back(door("materials", "NaN and infinity in every number of a material", "refused: finite numbers",
                         [](Finding& finding) {
                             const std::vector<std::function<void(pipeline::Material&, float)>> numbers{
                                 [](pipeline::Material& m, float x) { m.base_colour.g = x; },
                                 [](pipeline::Material& m, float x) { m.alpha_cutoff = x; },
                                 [](pipeline::Material& m, float x) { m.transmission = x; },
                                 [](pipeline::Material& m, float x) { m.uv_transform[1][0] = x; }};
                             for (const float bad : bad_values)
                                 for (const auto& number : numbers) {
                                     traces::Scene scene = triangle();
                                     number(scene.resources->materials[0], bad);
                                     finding.refuses([&] { scene.resources->validate("stability"); }, "finite numbers");
                                 }
                         }));
    cases.push_back(door("scalars", "meshes of tetrahedra whose scalars are the largest floats",
                         "divided by a power of two: none above 65504", [](Finding& finding) {
                             traces::TetrahedralMesh mesh{"one",
                                                          {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                                          {largest_float, -largest_float, 0, 1},
                                                          {{0, 1, 2, 3}},
                                                          {}};
                             const traces::Scene scene = traces::scene_of(std::move(mesh));
                             float scalar = 0.0F;
                             const auto* colour = scene.resources->geometries[0].find(pipeline::Semantic::colour);
                             std::memcpy(&scalar, scene.resources->buffers[colour->buffer].bytes.data(), 4);
                             finding.require(scalar > 32752.0F && scalar <= 65504.0F, "within (65504 / 2, 65504]");
                             finding.require(!scene.notes.empty(), "a note says so");
                         }));
    cases.push_back(door(
        "shadow-depths", "NaN, infinity, -1 and 2 as depths of a light's k-buffer",
        "no surface: the sentinel of the format", [](Finding& finding) {
            traces::AreaLight light;
            light.near = light.near_width = 1.0;
            light.far = 100.0;
            for (const float bad : {not_a_number, infinity, -infinity, -1.0F, next_down(0.0F), next_up(1.0F), 2.0F}) {
                const std::vector<float> kbuffer(4, bad);
                const traces::ShadowMap map(light, kbuffer, 4, {.resolution = 1, .captured = 4, .layers = 3});
                for (std::uint32_t layer = 0; layer < 4; ++layer)
                    finding.require(map.depth(layer, 0, 0) == 65504.0F && map.empty(layer, 0, 0),
                                    fmt::format("{} is no surface", bad));
                finding.require(std::isfinite(map.bias(0, 0, 0)), "a finite bias");
            }
        }));
}

std::shared_ptr<const pipeline::ModifyProgram> user_program(const std::string& body) {
    return models::user_program("stability.kb",
                                "program \"stability\"; k 2; entry r, g, b, z; empty z = largest; order any; "
                                "picture layers; fragment { " +
                                    body + " }",
                                0)
        .program;
}

void add_program_doors(std::vector<Case>& cases) {
    cases.push_back(
        door("composited-colours", "NaN and infinity as colours that A7 and nodes composite",
             "finite pixels, whatever follows", [](Finding& finding) {
                 for (const float bad : bad_values)
                     for (const auto& program : {models::make_order_and_blend(4, 0.5F), models::make_mlab(4, 0.5F)}) {
                         std::vector<float> pixel(program->floats_per_pixel()), entry(program->floats_per_entry());
                         program->clear(pixel.data());
                         for (int i = 0; i < 20; ++i) {
                             const std::array<float, 4> rgba{i % 3 == 0 ? bad : largest_float, bad, 1.0F, 1.0F};
                             program->make_entry({rgba.data(), static_cast<float>(i) / 20.0F, 0}, entry.data());
                             program->insert(pixel.data(), entry.data());
                         }
                         if (program->drains()) program->drain(pixel.data());
                         for (const float value : pixel) finding.require(std::isfinite(value), "finite");
                     }
             }));
    cases.push_back(door("field-samples", "NaN and infinity as scalars of samples",
                         "0 and the largest floats: finite entries and states", [](Finding& finding) {
                             const auto program = models::make_isosurface({});
                             for (const float bad : bad_values) {
                                 std::vector<float> pixel(program->floats_per_pixel());
                                 program->clear(pixel.data());
                                 for (const float scalar : {0.0F, bad, 1.0F, -bad}) {
                                     const std::array<float, 4> rgba{scalar, 0, 0, 1};
                                     std::array<float, 2> entry{};
                                     program->make_entry({rgba.data(), 0.5F, 0}, entry.data());
                                     for (const float value : entry) finding.require(std::isfinite(value), "finite");
                                     program->insert(pixel.data(), entry.data());
                                 }
                                 program->drain(pixel.data());
                                 for (const float value : pixel) finding.require(std::isfinite(value), "finite");
                             }
                         }));
    cases.push_back(
        door("iso-values", "NaN and infinity as iso-values, and none at all", "refused", [](Finding& finding) {
            for (const float bad : bad_values) {
                models::IsosurfaceSetup setup;
                setup.iso_values = {0.5F, bad};
                finding.refuses([&] { models::make_isosurface(setup); }, "finite iso-values");
            }
            models::IsosurfaceSetup none;
            none.iso_values = {};
            finding.refuses([&] { models::make_isosurface(none); }, "at least one");
        }));
    cases.push_back(door("transfer-functions",
                         "NaN and infinity as scalar, colour and extinction of a transfer function; scalars that span "
                         "more than the floats",
                         "refused, with the point", [](Finding& finding) {
                             const auto table = [](const models::TransferFunction& transfer) {
                                 return [transfer] { const models::PreintegratedTable made(transfer, 1.0F, 4, 4); };
                             };
                             for (const float bad : bad_values) {
                                 finding.refuses(table({{bad, glm::vec3(1), 1}}), "point 0");
                                 finding.refuses(table({{0, glm::vec3(bad), 1}}), "a finite colour");
                                 finding.refuses(table({{0, glm::vec3(1), bad}}), "an extinction of at least 0");
                             }
                             finding.refuses(
                                 table({{-largest_float, glm::vec3(1), 1}, {largest_float, glm::vec3(1), 1}}),
                                 "whose difference is a finite float");
                             finding.refuses(
                                 [] {
                                     const models::PreintegratedTable made({{0, glm::vec3(1), 1}}, infinity, 4, 4);
                                 },
                                 "a longest gap above 0");
                         }));
    cases.push_back(door("depth-ranges", "NaN, infinity and equal values as bounds of a depth partition",
                         "refused, with the bound", [](Finding& finding) {
                             for (const float bad : {not_a_number, infinity, -infinity, 0.25F, 0.1F})
                                 finding.refuses([&] { models::make_depth_partition({0.0F, 0.25F, bad}); }, "bound 2");
                         }));
    cases.push_back(door(
        "user-programs", "a program of the user's that divides by zero, overflows, and takes infinity from infinity",
        "0 from the division; the largest float, never infinite", [](Finding& finding) {
            const auto program = user_program("f.r = f.z / (f.z - f.z); f.g = largest * 1000.0; f.b = f.g * 10.0 - f.g "
                                              "* 10.0; if f.z < e[0].z { e[0] = f; }");
            std::vector<float> pixel(program->floats_per_pixel());
            program->clear(pixel.data());
            const std::array<float, 4> entry{1.0F, 1.0F, 1.0F, 0.5F};
            program->insert(pixel.data(), entry.data());
            finding.require(pixel[0] == 0.0F, "0 from the division");
            finding.require(pixel[1] == largest_float, "the largest float");
            for (const float value : pixel) finding.require(std::isfinite(value), "finite");
        }));
    cases.push_back(door("bent-rays", "a program of the user's that asks for another pixel, as refraction would",
                         "refused: a fragment knows its own pixel only", [](Finding& finding) {
                             user_program("if f.z < e[0].z { e[0] = f; }");
                             finding.refuses([] { user_program("f.r = pixel[1].r;"); }, "stability.kb:");
                         }));
}

void add_option_doors(std::vector<Case>& cases) {
    const auto settings = [](Finding& finding, const traces::WorkloadChoice& workload, const std::string& key) {
        for (const char* bad : {"nan", "inf", "-inf", "1e999", "1e39", "NaN", "Infinity"}) {
            finding.refuses(
                [&] {
                    traces::WorkloadOptions options;
                    options.set(key + "=" + bad);
                    traces::Scene scene = triangle();
                    traces::build_frame(scene, traces::make_view(scene, "auto", 16, 16), workload, options);
                },
                key + ": expected number");
        }
    };
    cases.push_back(door("workload-settings", "nan, inf, 1e999, and 1e39, which no float holds, as opacity",
                         "refused, with the key", [settings](Finding& finding) { settings(finding, {}, "opacity"); }));
    cases.push_back(
        door("gpu-settings", "nan, inf and 1e999 as numbers of a GPU", "refused, with the path", [](Finding& finding) {
            const Replay replay("gen:stack?n=2", {.width = 16, .height = 16, .threads = 1});
            for (const char* bad : {"nan", "inf", "-inf", "1e999"})
                for (const char* path : {"memory.bandwidth", "clock.core_mhz"})
                    finding.refuses([&] { replay.run("blender", {fmt::format("{}={}", path, bad)}); }, path);
        }));
    cases.push_back(door("generators", "nan, inf, 1e999 and 1e300 as numbers of a generator", "refused, with the key",
                         [](Finding& finding) {
                             for (const char* bad : {"nan", "inf", "1e999", "1e300"})
                                 finding.refuses([&] { traces::load_scene(fmt::format("gen:slabs?gap={}", bad)); },
                                                 "gap: expected number");
                         }));
    cases.push_back(
        door("cameras", "nan, inf and 1e999 as eye, target and angle of a camera", "refused", [](Finding& finding) {
            const traces::Scene scene = traces::load_scene("gen:slabs");
            for (const char* bad : {"nan", "inf", "-inf", "1e999"}) {
                finding.refuses([&] { traces::make_view(scene, fmt::format("{},0,5,0,0,0,45", bad), 16, 16); },
                                "expected auto");
                finding.refuses([&] { traces::make_view(scene, fmt::format("0,0,5,0,0,0,{}", bad), 16, 16); },
                                "expected auto");
            }
            for (const char* bad : {"0", "180", "-45", "1e30"})
                finding.refuses([&] { traces::make_view(scene, fmt::format("0,0,5,0,0,0,{}", bad), 16, 16); }, "fovy");
        }));
    cases.push_back(door("lights", "nan, inf and 1e999 as places of a light", "refused", [](Finding& finding) {
        const traces::Scene scene = traces::load_scene("gen:slabs");
        for (const char* bad : {"nan", "inf", "1e999"})
            finding.refuses([&] { traces::make_area_light(scene, fmt::format("0,9,{},0,0,0", bad), 0.1, "stability"); },
                            "expected auto");
    }));
}

} // namespace reports::stability::doors

std::vector<reports::stability::Case> reports::stability::door_cases() {
    std::vector<Case> cases;
    doors::add_scene_doors(cases);
    doors::add_program_doors(cases);
    doors::add_option_doors(cases);
    return cases;
}
