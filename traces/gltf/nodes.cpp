#include "traces/gltf/nodes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace traces::gltf {

namespace {

constexpr std::size_t deepest_level = 1000;

std::string node_place(const Document& document, std::size_t node) {
    return place_of("node", node, document.model().nodes[node].name);
}

bool all_finite(const std::vector<double>& numbers) {
    for (const double number : numbers)
        if (!std::isfinite(number)) return false;
    return true;
}

glm::dmat4 local_matrix(const Document& document, std::size_t index) {
    const tinygltf::Node& node = document.model().nodes[index];
    const auto sized = [](const std::vector<double>& list, std::size_t size) {
        return (list.empty() || list.size() == size) && all_finite(list);
    };
    document.require(
        sized(node.matrix, 16) && sized(node.translation, 3) && sized(node.rotation, 4) && sized(node.scale, 3),
        node_place(document, index), "a matrix of 16 finite numbers, or translation 3, rotation 4, scale 3");
    if (!node.matrix.empty()) {
        glm::dmat4 matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
        return matrix;
    }
    const auto& t = node.translation;
    const auto& r = node.rotation;
    const auto& s = node.scale;
    return transform(t.empty() ? glm::dvec3(0.0) : glm::dvec3(t[0], t[1], t[2]),
                     r.empty() ? glm::dvec4(0.0, 0.0, 0.0, 1.0) : glm::dvec4(r[0], r[1], r[2], r[3]),
                     s.empty() ? glm::dvec3(1.0) : glm::dvec3(s[0], s[1], s[2]));
}

/// The nodes that are nobody's child. Every node has one parent at most.
std::vector<std::size_t> find_roots(const Document& document) {
    const auto& nodes = document.model().nodes;
    std::vector<bool> has_parent(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            document.at(nodes, child, node_place(document, i), "child");
            const auto number = static_cast<std::size_t>(child);
            document.require(!has_parent[number], node_place(document, number), "one parent, got two");
            has_parent[number] = true;
        }
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (!has_parent[i]) roots.push_back(i);
    return roots;
}

struct Step {
    std::size_t node, level;
};

// Calls visit(node, level, parent's matrix) parents first, children in the order of their list.
template <class Visit>
void walk(const Document& document, const std::vector<std::size_t>& from, Visit&& visit) {
    std::vector<Step> todo;
    for (std::size_t i = from.size(); i-- > 0;) todo.push_back({from[i], 1});
    while (!todo.empty()) {
        const Step step = todo.back();
        todo.pop_back();
        document.require(step.level <= deepest_level, node_place(document, step.node), "at most {} levels of nodes",
                         deepest_level);
        visit(step.node);
        const auto& children = document.model().nodes[step.node].children;
        for (std::size_t i = children.size(); i-- > 0;)
            todo.push_back({static_cast<std::size_t>(children[i]), step.level + 1});
    }
}

std::vector<glm::dmat4> world_matrices(const Document& document, const std::vector<std::size_t>& roots) {
    const auto& nodes = document.model().nodes;
    std::vector<glm::dmat4> world(nodes.size());
    std::vector<bool> reached(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) world[i] = local_matrix(document, i);
    walk(document, roots, [&](std::size_t node) {
        reached[node] = true;
        for (const int child : nodes[node].children)
            world[static_cast<std::size_t>(child)] = world[node] * world[static_cast<std::size_t>(child)];
    });
    for (std::size_t i = 0; i < nodes.size(); ++i)
        document.require(reached[i], node_place(document, i), "no cycle of nodes");
    return world;
}

std::vector<std::size_t> scene_roots(const Document& document, const std::string& which,
                                     std::vector<std::size_t> roots) {
    const auto& model = document.model();
    if (which.empty() && model.scenes.empty()) return roots;
    int number = model.defaultScene < 0 ? 0 : model.defaultScene;
    if (!which.empty()) {
        const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), number);
        document.require(error == std::errc{} && end == which.data() + which.size(), "scene",
                         "a number after '#', got '{}'", which);
    }
    const auto& scene = document.at(model.scenes, number, "scene", "scene");
    std::vector<std::size_t> chosen;
    for (const int node : scene.nodes) {
        document.at(model.nodes, node, fmt::format("scene {}", number), "node");
        chosen.push_back(static_cast<std::size_t>(node));
    }
    return chosen;
}

glm::mat4 without_scale(const glm::dmat4& matrix) {
    glm::dmat4 result = matrix;
    for (int column = 0; column < 3; ++column) {
        const double length = glm::length(glm::dvec3(matrix[column]));
        if (length > 0.0) result[column] = matrix[column] / length;
    }
    return glm::mat4(result);
}

Camera camera_of(const Document& document, int index, const glm::dmat4& world) {
    const auto& source = document.at(document.model().cameras, index, "nodes", "camera");
    const auto place = place_of("camera", static_cast<std::size_t>(index), source.name);
    Camera camera;
    camera.name = source.name;
    camera.to_world = without_scale(world);
    camera.orthographic = source.type == "orthographic";
    if (camera.orthographic) {
        const auto& o = source.orthographic;
        document.require(o.xmag > 0.0 && o.ymag > 0.0 && o.zfar > o.znear && o.znear >= 0.0, place,
                         "positive xmag and ymag, and 0 <= znear < zfar");
        camera.xmag = static_cast<float>(o.xmag);
        camera.ymag = static_cast<float>(o.ymag);
        camera.near = static_cast<float>(o.znear);
        camera.far = static_cast<float>(o.zfar);
        return camera;
    }
    const auto& p = source.perspective;
    document.require(source.type == "perspective", place, "type perspective or orthographic");
    document.require(p.yfov > 0.0 && p.yfov < 3.14159 && p.znear > 0.0 && (p.zfar == 0.0 || p.zfar > p.znear), place,
                     "yfov between 0 and pi, and 0 < znear < zfar");
    camera.fovy = static_cast<float>(p.yfov);
    camera.aspect = static_cast<float>(p.aspectRatio);
    camera.near = static_cast<float>(p.znear);
    camera.far = static_cast<float>(p.zfar);
    return camera;
}

Light light_of(const Document& document, int index, const glm::dmat4& world) {
    const auto& source = document.at(document.model().lights, index, "nodes", "light");
    const auto place = place_of("light", static_cast<std::size_t>(index), source.name);
    Light light;
    light.name = source.name;
    light.to_world = without_scale(world);
    if (source.type == "directional")
        light.kind = LightKind::directional;
    else if (source.type == "spot")
        light.kind = LightKind::spot;
    else
        document.require(source.type == "point", place, "type directional, point or spot");
    if (source.color.size() == 3) light.colour = glm::vec3(source.color[0], source.color[1], source.color[2]);
    light.intensity = static_cast<float>(source.intensity);
    light.range = static_cast<float>(source.range);
    light.inner_cone = static_cast<float>(source.spot.innerConeAngle);
    light.outer_cone = static_cast<float>(source.spot.outerConeAngle);
    document.require(std::isfinite(light.intensity) && light.intensity >= 0.0F && std::isfinite(light.range), place,
                     "a finite intensity of at least 0");
    return light;
}

} // namespace

glm::dmat4 transform(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale) {
    const double length = glm::length(rotation);
    const auto turned = length > 0.0 ? rotation / length : glm::dvec4(0.0, 0.0, 0.0, 1.0);
    glm::dmat4 matrix = glm::mat4_cast(glm::dquat(turned.w, turned.x, turned.y, turned.z));
    for (int column = 0; column < 3; ++column) matrix[column] *= scale[column];
    matrix[3] = glm::dvec4(translation, 1.0);
    return matrix;
}

Hierarchy read_hierarchy(const Document& document, const std::string& which) {
    const std::vector<std::size_t> roots = find_roots(document);
    Hierarchy hierarchy;
    hierarchy.world = world_matrices(document, roots);
    std::vector<bool> seen(hierarchy.world.size());
    walk(document, scene_roots(document, which, roots), [&](std::size_t node) {
        document.require(!seen[node], node_place(document, node), "to be in the scene once");
        seen[node] = true;
        hierarchy.in_scene.push_back(node);
    });
    return hierarchy;
}

std::vector<glm::mat4> instances_of(const Document& document, const Accessors& accessors, std::size_t node,
                                    const glm::dmat4& world) {
    const auto& extensions = document.model().nodes[node].extensions;
    const auto found = extensions.find("EXT_mesh_gpu_instancing");
    if (found == extensions.end()) return {glm::mat4(world)};
    const std::string place = node_place(document, node) + " EXT_mesh_gpu_instancing";
    document.require(found->second.IsObject() && found->second.Has("attributes") &&
                         found->second.Get("attributes").IsObject(),
                     place, "attributes");
    const tinygltf::Value& attributes = found->second.Get("attributes");
    const auto read = [&](const char* name, std::uint8_t components) {
        if (!attributes.Has(name)) return std::vector<glm::vec4>();
        const tinygltf::Value& index = attributes.Get(name);
        document.require(index.IsInt(), place, "the number of an accessor as {}", name);
        return accessors.floats(index.GetNumberAsInt(), {components, components}, fmt::format("{} {}", place, name));
    };
    const auto translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4), scales = read("SCALE", 3);
    const auto count = std::max({translations.size(), rotations.size(), scales.size()});
    document.require(count >= 1, place, "TRANSLATION, ROTATION or SCALE");
    for (const auto* list : {&translations, &rotations, &scales})
        document.require(list->empty() || list->size() == count, place, "{} elements in each attribute, got {}", count,
                         list->size());
    std::vector<glm::mat4> matrices(count);
    for (std::size_t i = 0; i < count; ++i)
        matrices[i] =
            glm::mat4(world * transform(translations.empty() ? glm::dvec3(0.0) : glm::dvec3(translations[i]),
                                        rotations.empty() ? glm::dvec4(0.0, 0.0, 0.0, 1.0) : glm::dvec4(rotations[i]),
                                        scales.empty() ? glm::dvec3(1.0) : glm::dvec3(scales[i])));
    return matrices;
}

std::vector<Camera> read_cameras(const Document& document, const Hierarchy& hierarchy) {
    std::vector<std::pair<int, std::size_t>> used; // camera, node
    for (const std::size_t node : hierarchy.in_scene)
        if (document.model().nodes[node].camera >= 0) used.emplace_back(document.model().nodes[node].camera, node);
    std::stable_sort(used.begin(), used.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Camera> cameras;
    for (const auto& [camera, node] : used) cameras.push_back(camera_of(document, camera, hierarchy.world[node]));
    return cameras;
}

std::vector<Light> read_lights(const Document& document, const Hierarchy& hierarchy) {
    std::vector<Light> lights;
    for (const std::size_t node : hierarchy.in_scene) {
        const auto& extensions = document.model().nodes[node].extensions;
        const auto found = extensions.find("KHR_lights_punctual");
        if (found == extensions.end() || !found->second.IsObject() || !found->second.Has("light")) continue;
        lights.push_back(light_of(document, found->second.Get("light").GetNumberAsInt(), hierarchy.world[node]));
    }
    return lights;
}

} // namespace traces::gltf
