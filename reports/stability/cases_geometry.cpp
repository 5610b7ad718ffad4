// The geometry feed at its limits (specification 004, sections 6.3 and 3.1): 16-bit indices, quantised positions,
// meshes that are no manifolds, orders that no cache likes, attributes that nobody reads.
#include "reports/stability/catalogue.hpp"
#include "reports/stability/floats.hpp"
#include "reports/stability/quad.hpp"
#include "reports/stability/replay.hpp"
#include "reports/stability/scenes.hpp"
#include "traces/generators/mesh.hpp"
#include "traces/loads.hpp"
#include "traces/preparation.hpp"
#include "traces/preparation/quantise.hpp"
#include "traces/preparation/steps.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports::stability::geometry {

using traces::QuantiseBox;
using traces::QuantiseGrid;

/// A fan of triangles around vertex 0 over `vertices` vertices, with normals and colours.
traces::Mesh fan(std::uint32_t vertices) {
    traces::Mesh mesh;
    mesh.name = "fan";
    for (std::uint32_t i = 0; i < vertices; ++i) {
        const double angle = 6.2 * i / vertices;
        mesh.positions.emplace_back(i == 0 ? glm::dvec3(0.0)
                                           : glm::dvec3(std::cos(angle), std::sin(angle), 0.001 * (i % 7)));
        mesh.colours.push_back(traces::colour_of(i));
        mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
    }
    for (std::uint32_t i = 2; i < vertices; ++i) mesh.indices.insert(mesh.indices.end(), {0, i - 1, i});
    return mesh;
}

traces::Scene scene_of(const traces::Mesh& mesh, traces::IndexWidth width = traces::IndexWidth::automatic) {
    traces::Scene scene = traces::scene_of_material("white", glm::vec4(1.0F));
    traces::add_draws(scene, mesh, {traces::whole(mesh)}, {.index = width}, "stability");
    scene.name = mesh.name;
    traces::finish_scene(scene);
    return scene;
}

void batches(Finding& finding, std::uint32_t vertices, std::size_t draws, bool narrow) {
    const std::vector<std::string> steps{"batch?vertices=65536"};
    const traces::Scene scene = scene_of(fan(vertices), traces::IndexWidth::u32);
    const traces::PreparedScene prepared = traces::prepare_scene(scene, steps);
    finding.error(static_cast<double>(prepared.scene.draws.size()) - static_cast<double>(draws));
    finding.error(static_cast<double>(prepared.scene.triangles_drawn) - static_cast<double>(scene.triangles_drawn));
    for (const pipeline::Geometry& part : prepared.scene.resources->geometries) {
        finding.require(part.vertex_count <= 65536, "at most 65,536 vertices");
        finding.require((part.index_type == pipeline::IndexType::u16) == narrow, "indices of 16 bits");
    }
}

void add_indices(std::vector<Case>& cases) {
    cases.push_back({"geometry.indices-below", Side::below, "a draw of 65,535 vertices in batches",
                     "one draw with 16-bit indices, all triangles", "draws", 0.0,
                     [](Finding& finding) { batches(finding, 65535, 1, true); }});
    cases.push_back({"geometry.indices-at", Side::at, "a draw of 65,536 vertices: the last index is 65,535",
                     "one draw with 16-bit indices, all triangles", "draws", 0.0,
                     [](Finding& finding) { batches(finding, 65536, 1, true); }});
    cases.push_back({"geometry.indices-above", Side::above, "a draw of 65,537 vertices",
                     "two draws with 16-bit indices, all triangles", "draws", 0.0,
                     [](Finding& finding) { batches(finding, 65537, 2, true); }});
    cases.push_back({"geometry.indices-refused", Side::above, "16-bit indices asked for 65,537 vertices", "refused", "",
                     0.0, [](Finding& finding) {
                         scene_of(fan(65536), traces::IndexWidth::u16);
                         finding.refuses([] { scene_of(fan(65537), traces::IndexWidth::u16); },
                                         "at most 65536 vertices");
                     }});
    cases.push_back({"geometry.index-out-of-range", Side::above, "an index equal to the number of vertices",
                     "refused, with its place", "", 0.0, [](Finding& finding) {
                         traces::Mesh mesh = fan(5);
                         scene_of(mesh);
                         mesh.indices.back() = 5;
                         finding.refuses([&] { scene_of(mesh); }, "below the vertex count 5");
                     }});
}

void add_meshes(std::vector<Case>& cases) {
    /// Sorted triples of positions of all triangles.
    const auto reordered = [](Finding& finding, const traces::Mesh& mesh) {
        for (const char* algorithm : {"fifo", "cache", "strip", "pca", "oblivious"}) {
            const std::vector<std::string> steps{fmt::format("reorder?algorithm={}&patch=16", algorithm)};
            const traces::Scene scene = scene_of(mesh);
            finding.error(static_cast<double>(traces::prepare_scene(scene, steps).scene.triangles_drawn) -
                          static_cast<double>(mesh.indices.size()) / 3);
        }
    };
    cases.push_back({"geometry.manifold", Side::below, "reordering a closed fan, by every algorithm",
                     "no triangle is lost", "triangles", 0.0,
                     [reordered](Finding& finding) { reordered(finding, fan(300)); }});
    cases.push_back({"geometry.edge-of-three", Side::at, "reordering triangles of which three share each edge",
                     "no triangle is lost", "triangles", 0.0, [reordered](Finding& finding) {
                         traces::Mesh mesh = fan(60);
                         for (std::uint32_t i = 2; i < 60; ++i)
                             mesh.indices.insert(mesh.indices.end(), {i - 1, 0, (i + 7) % 58 + 1});
                         reordered(finding, mesh);
                     }});
    cases.push_back({"geometry.soup", Side::above,
                     "reordering triangles of any three of 40 vertices, some drawn twice, in disconnected parts",
                     "no triangle is lost", "triangles", 0.0, [reordered](Finding& finding) {
                         traces::Mesh mesh = fan(80);
                         mesh.indices.clear();
                         sim::Random random(5, "soup");
                         for (int i = 0; i < 500; ++i) {
                             const auto part = static_cast<std::uint32_t>(40 * (i % 2));
                             const auto a = static_cast<std::uint32_t>(random.below(40)),
                                        b = static_cast<std::uint32_t>((a + 1 + random.below(38)) % 40);
                             std::uint32_t c = 0;
                             while (c == a || c == b) ++c;
                             for (int again = 0; again < 1 + i % 2; ++again)
                                 mesh.indices.insert(mesh.indices.end(), {part + a, part + b, part + c});
                         }
                         reordered(finding, mesh);
                     }});
    cases.push_back({"geometry.poor-order", Side::above, "batches of a mesh whose triangles were shuffled",
                     "all triangles; vertices are repeated in many batches, more than in good order", "triangles", 0.0,
                     [](Finding& finding) {
                         const auto vertices = [&](std::vector<std::string> steps) {
                             const traces::Scene scene = traces::load_scene("gen:blob?triangles=4000");
                             const auto prepared = traces::prepare_scene(scene, steps);
                             finding.error(static_cast<double>(prepared.scene.triangles_drawn) -
                                           static_cast<double>(scene.triangles_drawn));
                             return prepared.scene.vertices;
                         };
                         finding.require(vertices({"shuffle", "batch?vertices=128"}) >
                                             2 * vertices({"reorder", "batch?vertices=128"}),
                                         "twice as many vertices");
                     }});
    const auto fetched = [](bool every_attribute) {
        const traces::Load load = traces::geometry_feed_load(every_attribute);
        return Replay(scene_of(fan(50)),
                      {.width = 16, .height = 16, .workload = load.workload, .knobs = load.settings, .threads = 1})
            .frame;
    };
    cases.push_back({"geometry.unread-attributes", Side::below, "normals and colours that no shader reads",
                     "not fetched: left out, by name", "", 0.0, [fetched](Finding& finding) {
                         const pipeline::Frame frame = fetched(false);
                         const bool named =
                             std::any_of(frame.left_out.begin(), frame.left_out.end(),
                                         [](const pipeline::LeftOut& one) { return one.unit == "normals"; });
                         finding.require(named && !frame.needs.normals, "normals are left out");
                         finding.require((frame.needs.attributes & pipeline::mask_of(pipeline::Semantic::normal)) == 0,
                                         "and not read");
                     }});
    cases.push_back({"geometry.touched-attributes", Side::above,
                     "normals and colours that the vertex shader touches and nothing uses", "fetched", "", 0.0,
                     [fetched](Finding& finding) {
                         const std::uint32_t read = fetched(true).needs.attributes;
                         finding.require((read & pipeline::mask_of(pipeline::Semantic::normal)) != 0 &&
                                             (read & pipeline::mask_of(pipeline::Semantic::colour)) != 0,
                                         "both are read");
                     }});
}

/// Round trips of positions on the grid of a box [lo, hi]: the error in units of extent / 131068, in 113 bits.
void quantised(Finding& finding, float lo, float hi) {
    const std::array corners{glm::vec3(lo), glm::vec3(hi)};
    const QuantiseGrid grid = QuantiseGrid::around(corners, QuantiseBox::axes);
    for (int i = 0; i <= 500; ++i) {
        const float x = i == 500 ? hi
                                 : static_cast<float>(static_cast<double>(lo) +
                                                      (static_cast<double>(hi) - static_cast<double>(lo)) * i / 500.0);
        const auto q = grid.quantise(glm::vec3(std::clamp(x, lo, hi)));
        const Quad extent = Quad(hi) - Quad(lo), back = (Quad(q[0]) + 32767) * extent / 65534;
        finding.error(static_cast<double>((back - (Quad(std::clamp(x, lo, hi)) - Quad(lo))) / (extent / 131068)));
    }
}

void add_quantisation(std::vector<Case>& cases) {
    constexpr double bound = 1.0 + 1e-9;
    cases.push_back({"geometry.quantise-tiny", Side::below, "16-bit positions in boxes of 1e-30 and of one float",
                     "within extent / 131068 of where they were", "of the bound", bound, [](Finding& finding) {
                         quantised(finding, 0.0F, 1e-30F);
                         quantised(finding, 1.0F, next_up(1.0F));
                     }});
    cases.push_back(
        {"geometry.quantise-usual", Side::at, "16-bit positions in boxes of 1 and of 1000, off the origin",
         "within extent / 131068 of where they were; the corners exactly", "of the bound", bound, [](Finding& finding) {
             quantised(finding, -0.3F, 0.7F);
             quantised(finding, 5000.0F, 6000.0F);
             const std::array corners{glm::vec3(-1.0F), glm::vec3(3.0F)};
             const auto grid = QuantiseGrid::around(corners, QuantiseBox::axes);
             finding.require(grid.quantise(corners[0])[0] == -32767 && grid.quantise(corners[1])[0] == 32767,
                             "the ends of the grid");
         }});
    cases.push_back({"geometry.quantise-huge", Side::above, "16-bit positions in boxes of 1e30 and of all floats",
                     "within extent / 131068 of where they were", "of the bound", bound, [](Finding& finding) {
                         quantised(finding, -1e30F, 1e30F);
                         quantised(finding, -largest_float, largest_float);
                     }});
    cases.push_back({"geometry.quantise-flat", Side::below, "a box without extent along an axis",
                     "q = 0, restored by a matrix that can be undone", "", 0.0, [](Finding& finding) {
                         const std::array corners{glm::vec3(1, 2, 5), glm::vec3(3, 2, 5)};
                         const auto grid = QuantiseGrid::around(corners, QuantiseBox::axes);
                         finding.require(grid.quantise(corners[1])[1] == 0, "q = 0");
                         finding.require(std::fabs(glm::determinant(grid.restore())) > 0.0,
                                         "the matrix has an inverse");
                     }});
    const auto representable = [](float extent) {
        const std::array corners{glm::vec3(0.0F), glm::vec3(extent)};
        return QuantiseGrid::around(corners, QuantiseBox::axes).representable();
    };
    // A step is extent / 65534; the least normal float is 2^-126.
    cases.push_back({"geometry.step-below", Side::below,
                     "a box so small that a step is no normal float: 65533 * 2^-126",
                     "not representable: the mesh stays as it is", "", 0.0, [representable](Finding& finding) {
                         finding.require(!representable(65533.0F * 0x1p-126F), "not representable");
                     }});
    cases.push_back({"geometry.step-at", Side::at, "a box whose step is the least normal float: 65534 * 2^-126",
                     "representable", "", 0.0, [representable](Finding& finding) {
                         finding.require(representable(65534.0F * 0x1p-126F), "representable");
                     }});
    cases.push_back({"geometry.step-above", Side::above, "a box whose step is just above the least normal float",
                     "representable", "", 0.0, [representable](Finding& finding) {
                         finding.require(representable(65536.0F * 0x1p-126F), "representable");
                     }});
}

} // namespace reports::stability::geometry

std::vector<reports::stability::Case> reports::stability::geometry_cases() {
    std::vector<Case> cases;
    geometry::add_indices(cases);
    geometry::add_meshes(cases);
    geometry::add_quantisation(cases);
    return cases;
}
