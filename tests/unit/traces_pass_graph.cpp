#include "sim/check.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/camera.hpp"
#include "traces/pass_graph.hpp"
#include "traces/workloads.hpp"

#include <gtest/gtest.h>

namespace traces_pass_graph_test {

using pipeline::Frame;
using pipeline::Pass;
using Names = std::vector<std::string>;

// Three draws: opaque, opaque with alpha test, transparent. Normals and colours are there; the mask has no texture.
traces::Scene three_draws() {
    support::GltfFile file = support::triangle_file();
    const int normals = file.add({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    file.json["materials"] = nlohmann::json::parse(R"([{}, {"alphaMode": "MASK"}, {"alphaMode": "BLEND"}])");
    auto primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = normals;
    file.json["meshes"][0]["primitives"] = nlohmann::json::array();
    for (const int material : {0, 1, 2}) {
        primitive["material"] = material;
        file.json["meshes"][0]["primitives"].push_back(primitive);
    }
    return file.load();
}

const traces::Scene& scene() {
    static const traces::Scene loaded = three_draws();
    return loaded;
}

Frame frame_with(const Names& settings, const std::string& workload = "transparency") {
    traces::WorkloadOptions options;
    for (const std::string& setting : settings) options.set(setting);
    return traces::build_frame(scene(), traces::make_view(scene(), "auto", 64, 64), workload, options);
}

class NothingKernel final : public pipeline::Kernel {
  public:
    pipeline::KernelShape shape() const override { return {.reads = 1}; }
    void run(const glm::uvec2&, pipeline::SurfaceAccess&, pipeline::KernelStores&) const override {}
};

Names pass_names(const Frame& frame) {
    Names names;
    for (const Pass& pass : frame.passes) names.push_back(pass.name);
    return names;
}

Names left_out(const Frame& frame) {
    Names list;
    for (const auto& item : frame.left_out) list.push_back(item.unit + ": " + item.reason);
    return list;
}

std::string error_of(const Names& settings, const std::string& workload = "transparency") {
    try {
        frame_with(settings, workload);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

Frame empty_frame() {
    Frame frame;
    frame.resources = scene().resources;
    frame.draws = scene().draws;
    return frame;
}

Names surface_names(const Frame& frame, const std::vector<pipeline::SurfaceId>& surfaces) {
    Names names;
    for (const pipeline::SurfaceId surface : surfaces) names.push_back(frame.surfaces.at(surface).name);
    return names;
}

TEST(PassGraph, PassesNobodyReadsAreCulled) {
    traces::PassGraph graph(empty_frame());
    graph.add_clear("clear", {"depth", "colour"});
    graph.add_draw("shadow", {}, {"depth"}, {0});
    graph.add_clear("clear again", {"depth"});
    graph.add_draw("picture", {"depth"}, {"depth", "colour"}, {0, 1});
    graph.add_draw("afterwards", {"depth"}, {"depth"}, {2});
    graph.output("colour");
    const Frame frame = graph.lower();
    EXPECT_EQ(pass_names(frame), (Names{"clear", "clear again", "picture"}));
    EXPECT_EQ(surface_names(frame, frame.passes[0].clears), Names{"colour"});
    EXPECT_EQ(frame.left_out[0].unit, "pass shadow");
    EXPECT_EQ(frame.left_out[0].reason, "nobody reads depth");
    EXPECT_EQ(frame.left_out[1].unit, "pass afterwards");
}

TEST(PassGraph, ChainsOfReadersKeepTheirPasses) {
    traces::PassGraph graph(empty_frame());
    graph.add_draw("first", {}, {"depth"}, {0});
    graph.add_draw("second", {"depth"}, {"colour"}, {1});
    graph.add_surface("picture", pipeline::SurfaceFormat::rgba32f);
    graph.add_kernel("last", std::make_shared<NothingKernel>(), {"colour"}, {"picture"});
    graph.output("picture");
    const Frame frame = graph.lower();
    EXPECT_EQ(pass_names(frame), (Names{"first", "second", "last"}));
    EXPECT_TRUE(frame.passes[1].states[0].depth.test);
    EXPECT_FALSE(frame.passes[1].states[0].depth.write);
    EXPECT_TRUE(frame.needs.early_depth);
    ASSERT_EQ(frame.passes[2].reads, std::vector<pipeline::SurfaceId>{frame.passes[1].targets[0]});
    ASSERT_EQ(frame.passes[2].targets, std::vector<pipeline::SurfaceId>{frame.output});
    EXPECT_EQ(frame.surfaces[frame.output].name, "picture");
}

TEST(PassGraph, KernelsAskFragmentsForNothing) {
    traces::PassGraph graph(empty_frame());
    graph.add_surface("picture", pipeline::SurfaceFormat::rgba32f);
    graph.add_draw("depths", {}, {"depth"}, {0});
    graph.add_kernel("picture", std::make_shared<NothingKernel>(), {"depth"}, {"picture"});
    graph.output("picture");
    const Frame frame = graph.lower();
    EXPECT_EQ(pass_names(frame), (Names{"depths", "picture"}));
    EXPECT_FALSE(frame.needs.colours);
    EXPECT_FALSE(frame.needs.colour_surface);
}

TEST(PassGraph, PassesWithoutDrawsAreCulled) {
    traces::PassGraph graph(empty_frame());
    graph.add_draw("nothing", {}, {"colour"}, {});
    graph.add_draw("something", {}, {"colour"}, {0});
    graph.output("colour");
    const Frame frame = graph.lower();
    EXPECT_EQ(pass_names(frame), Names{"something"});
    EXPECT_EQ(frame.left_out[0].unit, "pass nothing");
    EXPECT_EQ(frame.left_out[0].reason, "it draws nothing");
}

TEST(PassGraph, WritesNobodyReadsAreDropped) {
    traces::PassGraph graph(empty_frame());
    graph.add_draw("both", {}, {"depth", "colour"}, {0});
    graph.output("depth");
    const Frame frame = graph.lower();
    EXPECT_FALSE(frame.passes[0].writes_colour());
    EXPECT_FALSE(frame.needs.colours);
    EXPECT_FALSE(frame.needs.normals);
    EXPECT_EQ(frame.left_out[0].unit, "colour of pass both");
}

TEST(Workloads, TransparencyDrawsEverythingIntoTheKBuffer) {
    const Frame frame = frame_with({});
    EXPECT_EQ(pass_names(frame), (Names{"clear k-buffer", "geometry", "picture"}));
    EXPECT_EQ(frame.passes[1].draws, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(frame.passes[1].runs_program());
    EXPECT_FALSE(frame.passes[1].states[0].depth.test);
    EXPECT_TRUE(frame.passes[1].both_faces);
    ASSERT_NE(frame.program, nullptr);
    EXPECT_EQ(frame.program->k(), 4U);
    EXPECT_EQ(frame.program->bytes_per_pixel(), 64U);
    EXPECT_EQ(frame.workload, "transparency");
    EXPECT_EQ(left_out(frame),
              (Names{"pass opaque: every draw is transparent by choice", "index buffer: no drawn geometry has indices",
                     "vertex colours: no drawn geometry has them",
                     "texture coordinates: no drawn material has a texture and coordinates for it",
                     "textures: no drawn material has a texture and coordinates for it",
                     "depth surface: no pass tests or writes depth",
                     "early depth test: no pass tests a depth surface that it does not write",
                     "colour surface: no pass writes it"}));
}

TEST(Workloads, DepthsAloneNeedNoColours) {
    const Frame frame = frame_with({"entry=z", "k=16"});
    EXPECT_EQ(frame.program->bytes_per_pixel(), 64U);
    EXPECT_FALSE(frame.needs.colours);
    EXPECT_FALSE(frame.needs.normals);
    EXPECT_TRUE(frame.needs.alpha_test);
    const Names list = left_out(frame);
    EXPECT_NE(std::find(list.begin(), list.end(), "normals: no pass reads colours"), list.end());
    EXPECT_NE(std::find(list.begin(), list.end(), "colours: no pass reads colours"), list.end());
}

TEST(Workloads, TransparentMaterialsLieBehindOpaqueOnes) {
    const Frame frame = frame_with({"transparent=materials"});
    EXPECT_EQ(pass_names(frame), (Names{"clear", "opaque", "clear k-buffer", "geometry", "picture"}));
    EXPECT_EQ(frame.passes[1].draws, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_TRUE(frame.passes[1].states[0].depth.test && frame.passes[1].states[0].depth.write &&
                frame.passes[1].writes_colour());
    EXPECT_EQ(frame.passes[3].draws, (std::vector<std::uint32_t>{2}));
    EXPECT_TRUE(frame.passes[3].states[0].depth.test && frame.passes[3].runs_program());
    EXPECT_FALSE(frame.passes[3].states[0].depth.write);
    EXPECT_TRUE(frame.needs.depth && frame.needs.early_depth && frame.needs.colour_surface && frame.needs.kbuffer);
}

TEST(Workloads, OpaqueColoursAreNotWrittenWhenLayersAreDepths) {
    const Frame frame = frame_with({"transparent=materials", "entry=z"});
    EXPECT_FALSE(frame.passes[1].writes_colour());
    EXPECT_FALSE(frame.needs.colour_surface);
    EXPECT_NE(std::find(left_out(frame).begin(), left_out(frame).end(), "colour of pass opaque: nobody reads it"),
              left_out(frame).end());
}

TEST(Workloads, SceneWithoutTransparentMaterialsHasNoKBuffer) {
    traces::Scene opaque = scene();
    opaque.draws.pop_back();
    traces::WorkloadOptions options;
    options.set("transparent=materials");
    const Frame frame = traces::build_frame(opaque, traces::make_view(opaque, "auto", 8, 8), "transparency", options);
    EXPECT_EQ(pass_names(frame), (Names{"clear", "opaque"}));
    EXPECT_EQ(frame.program, nullptr);
    EXPECT_EQ(left_out(frame)[0], "pass geometry: no draw has a transparent material");
}

TEST(Workloads, OpaqueIsOnePassWithDepth) {
    const Frame frame = frame_with({"depth_format=d16"}, "opaque");
    EXPECT_EQ(pass_names(frame), (Names{"clear", "opaque"}));
    EXPECT_EQ(frame.depth_format, pipeline::SurfaceFormat::d16);
    EXPECT_EQ(frame.program, nullptr);
    EXPECT_TRUE(frame.needs.depth && frame.needs.colour_surface && frame.needs.normals);
}

TEST(Workloads, GeometryIsOnePassOfDepthsThatReadsAllAttributesOrPositions) {
    const Frame all = frame_with({}, "geometry");
    EXPECT_EQ(pass_names(all), (Names{"clear", "geometry"}));
    EXPECT_TRUE(all.passes[1].states[0].depth.test && all.passes[1].states[0].depth.write);
    EXPECT_TRUE(all.passes[1].writes_colour() && !all.passes[1].runs_program());
    EXPECT_TRUE(all.needs.colours && all.needs.colour_surface);
    EXPECT_EQ(all.needs.fragment_colour, pipeline::FragmentColour::flat);
    EXPECT_FALSE(all.needs.normals || all.needs.vertex_colours || all.needs.textures || all.needs.alpha_test);
    EXPECT_EQ(all.needs.attributes, (1U << pipeline::semantics) - 1);
    const Names list = left_out(all);
    EXPECT_TRUE(std::none_of(list.begin(), list.end(), [](const auto& line) { return line.starts_with("normals"); }));

    const Frame positions = frame_with({"reads=position", "depth_format=d32f"}, "geometry");
    EXPECT_EQ(positions.needs.attributes, 0U);
    EXPECT_EQ(positions.depth_format, pipeline::SurfaceFormat::d32f);
    EXPECT_EQ(left_out(positions)[1], "normals: fragments have the base colour of their material");
}

// The geometry of one draw of three_draws() with an attribute of every semantic.
Frame frame_of_every_attribute(const Names& settings, const std::string& workload) {
    traces::Scene all = scene();
    auto resources = std::make_shared<pipeline::Resources>(*all.resources);
    for (std::uint32_t i = 0; i < pipeline::semantics; ++i) {
        const auto semantic = static_cast<pipeline::Semantic>(i);
        if (resources->geometries[0].find(semantic) != nullptr) continue;
        pipeline::VertexAttribute attribute = *resources->geometries[0].find(pipeline::Semantic::position);
        attribute.semantic = semantic;
        resources->geometries[0].attributes.push_back(attribute);
    }
    all.resources = resources;
    traces::WorkloadOptions options;
    for (const std::string& setting : settings) options.set(setting);
    return traces::build_frame(all, traces::make_view(all, "auto", 8, 8), workload, options);
}

TEST(Workloads, EveryAttributeThatNobodyReadsIsListed) {
    const Frame positions = frame_of_every_attribute({"reads=position"}, "geometry");
    Names units;
    for (const auto& item : positions.left_out) units.push_back(item.unit);
    const Names expected{"normals",
                         "vertex colours",
                         "texture coordinates",
                         "secondary colours",
                         "texture coordinates 1",
                         "texture coordinates 2",
                         "texture coordinates 3",
                         "texture coordinates 4",
                         "texture coordinates 5",
                         "texture coordinates 6",
                         "texture coordinates 7",
                         "generic attributes"};
    for (const std::string& unit : expected) EXPECT_EQ(std::count(units.begin(), units.end(), unit), 1) << unit;
    EXPECT_EQ(std::count(units.begin(), units.end(), "texture coordinates 0"), 0); // that is "texture coordinates"

    for (const auto& item : frame_of_every_attribute({}, "geometry").left_out)
        EXPECT_EQ(std::count(expected.begin(), expected.end(), item.unit), 0) << item.unit;
    // A lit picture reads normals and colours.
    for (const auto& item : frame_of_every_attribute({}, "opaque").left_out)
        EXPECT_TRUE(item.unit != "normals" && item.unit != "vertex colours");
}

TEST(Workloads, OptionsAreCheckedByName) {
    EXPECT_EQ(error_of({"k=65"}), "workload transparency: k: expected whole number 1 to 64, got 65");
    EXPECT_EQ(error_of({"K=4"}), "workload transparency: unknown key 'K'");
    EXPECT_EQ(error_of({"opacty=0.5"}), "workload transparency: unknown key 'opacty'; did you mean 'opacity'?");
    EXPECT_EQ(error_of({"entry=rgb"}),
              "workload transparency: entry: expected one of rgbz | z | zo | zor, got \"rgb\"; did you mean 'rgbz'?");
    EXPECT_EQ(error_of({"opacity=1.5"}), "workload transparency: opacity: expected number 0 to 1, got 1.5");
    EXPECT_EQ(error_of({"k"}), "workload: expected KEY=VALUE, got 'k'");
    EXPECT_EQ(error_of({"k=1", "k=2"}), "workload: 'k' is set twice");
    const std::string unknown = error_of({}, "transparent");
    EXPECT_TRUE(unknown.starts_with("workload: expected one of transparency, ")) << unknown;
    EXPECT_TRUE(unknown.ends_with("got 'transparent'; did you mean 'transparency'?")) << unknown;
}

TEST(Workloads, EveryOneOfTheTableBuildsAFrame) {
    const traces::Scene field = traces::load_scene("gen:tetrahedra?n=1"); // has what any of them asks for
    const pipeline::View view = traces::make_view(field, "auto", 64, 64);
    for (const traces::Workload& workload : traces::workloads()) {
        EXPECT_FALSE(workload.summary.empty());
        EXPECT_FALSE(workload.parameters.empty());
        EXPECT_FALSE(traces::build_frame(field, view, workload.id).passes.empty()) << workload.id;
    }
}

} // namespace traces_pass_graph_test
