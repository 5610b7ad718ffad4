#include "traces/gltf_import.hpp"

#include "sim/check.hpp"
#include "sim/counted.hpp"
#include "traces/gltf/accessors.hpp"
#include "traces/gltf/document.hpp"
#include "traces/gltf/geometry.hpp"
#include "traces/gltf/materials.hpp"
#include "traces/gltf/nodes.hpp"

#include <algorithm>
#include <cmath>

namespace traces {

namespace {

/// A small file can ask for any number of instances: of each node, each primitive, each instance.
constexpr std::size_t most_instances = 1U << 22U;

bool is_finite(const glm::mat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return true;
}

class Importer {
  public:
    Importer(gltf::Document& document, const std::string& which, Scene& scene)
        : document_(document),
          scene_(scene),
          hierarchy_(gltf::read_hierarchy(document, which)),
          accessors_(document, scene.resources->buffers),
          materials_(document, *scene.resources),
          geometries_(document, accessors_, hierarchy_, *scene.resources) {}

    void run() {
        scene_.triangles = gltf::count_triangles(document_, accessors_);
        for (const std::size_t node : hierarchy_.in_scene) add_node(node);
        scene_.cameras = gltf::read_cameras(document_, hierarchy_);
        scene_.lights = gltf::read_lights(document_, hierarchy_);
        geometries_.add_notes(document_.notes);
        if (left_out_ > 0)
            document_.notes.push_back(fmt::format("{} of points and lines {} left out", sim::counted(left_out_, "draw"),
                                                  left_out_ == 1 ? "is" : "are"));
        if (without_place_ > 0)
            document_.notes.push_back(fmt::format("{} of primitives without POSITION {} left out",
                                                  sim::counted(without_place_, "draw"),
                                                  without_place_ == 1 ? "is" : "are"));
        if (hidden_ > 0)
            document_.notes.push_back(
                fmt::format("{} not visible", hidden_ == 1 ? "1 node is" : sim::counted(hidden_, "node") + " are"));
        const auto has_triangles = [&](const pipeline::Draw& draw) {
            return scene_.resources->geometries[draw.geometry].triangle_count() > 0;
        };
        if (std::none_of(scene_.draws.begin(), scene_.draws.end(), has_triangles)) fail_empty();
    }

  private:
    void add_node(std::size_t index) {
        const tinygltf::Node& node = document_.model().nodes[index];
        if (node.mesh < 0) return;
        if (hierarchy_.hidden[index]) {
            ++hidden_;
            return;
        }
        const std::string place = gltf::place_of("node", index, node.name);
        const auto& mesh = document_.at(document_.model().meshes, node.mesh, place, "mesh");
        auto matrices = gltf::instances_of(document_, accessors_, index, hierarchy_.world[index]);
        for (const glm::mat4& matrix : matrices) document_.require(is_finite(matrix), place, "a finite transform");
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            if (!gltf::makes_triangles(mesh.primitives[i])) {
                ++left_out_;
                continue;
            }
            if (!mesh.primitives[i].attributes.contains("POSITION")) { // to be skipped (glTF 2.0, section 3.7.2.1)
                ++without_place_;
                continue;
            }
            instances_ += matrices.size();
            document_.require(instances_ <= most_instances, place, "at most {} instances in all", most_instances);
            pipeline::Draw draw;
            draw.name = mesh.primitives.size() == 1 ? place : fmt::format("{} primitive {}", place, i);
            draw.geometry = geometries_.use(index, i);
            draw.material = materials_.use(mesh.primitives[i].material, place);
            draw.instances = matrices;
            if (node.skin >= 0) draw.instances.assign(matrices.size(), geometries_.skin_to_world(draw.geometry));
            scene_.draws.push_back(std::move(draw));
        }
    }

    [[noreturn]] void fail_empty() const {
        std::string text;
        for (const std::string& note : document_.notes) text += "; " + note;
        throw sim::InputError(fmt::format(
            "{}: expected at least one triangle to draw (nodes in the scene, with primitives of mode 4 to 6, whose "
            "attributes have a POSITION, with a count of 3 or more){}",
            document_.name(), text));
    }

    gltf::Document& document_;
    Scene& scene_;
    gltf::Hierarchy hierarchy_;
    gltf::Accessors accessors_;
    gltf::Materials materials_;
    gltf::Geometries geometries_;
    std::size_t left_out_ = 0;
    std::size_t without_place_ = 0;
    std::size_t hidden_ = 0;
    std::size_t instances_ = 0;
};

} // namespace

Scene import_gltf(const std::filesystem::path& path, const std::string& which) {
    gltf::Document document(path);
    Scene scene;
    scene.resources = std::make_shared<pipeline::Resources>();
    scene.name = document.name(); // with its folders, for errors
    scene.hash = document.hash();
    Importer(document, which, scene).run();
    scene.notes = std::move(document.notes);
    finish_scene(scene);
    scene.name = path.filename().string() + (which.empty() ? "" : "#" + which);
    return scene;
}

} // namespace traces
