#include "traces/gltf/nodes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

namespace traces::gltf {

namespace {

std::string node_place(const Document& document, std::size_t node) {
    return place_of("node", node, document.model().nodes[node].name);
}

glm::dmat4 local_matrix(const Document& document, std::size_t index) {
    const tinygltf::Node& node = document.model().nodes[index];
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
        for (std::size_t c = 0; c < nodes[i].children.size(); ++c) {
            const auto child = static_cast<std::size_t>(nodes[i].children[c]);
            document.require(!has_parent[child], fmt::format("nodes[{}].children[{}]", i, c),
                             "a node that is nobody else's child, got {}", child);
            has_parent[child] = true;
        }
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (!has_parent[i]) roots.push_back(i);
    return roots;
}

// Calls visit(node) parents first, children in the order of their list. Without recursion: files can nest their nodes
// as deeply as they like.
template <class Visit>
void walk(const Document& document, const std::vector<std::size_t>& from, Visit&& visit) {
    std::vector<std::size_t> todo(from.rbegin(), from.rend());
    while (!todo.empty()) {
        const std::size_t node = todo.back();
        todo.pop_back();
        visit(node);
        const auto& children = document.model().nodes[node].children;
        for (std::size_t i = children.size(); i-- > 0;) todo.push_back(static_cast<std::size_t>(children[i]));
    }
}

bool is_visible(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    return found == node.extensions.end() || !found->second.Has("visible") || found->second.Get("visible").Get<bool>();
}

void spread_from_parents(const Document& document, const std::vector<std::size_t>& roots, Hierarchy& hierarchy) {
    const auto& nodes = document.model().nodes;
    std::vector<bool> reached(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        hierarchy.world.push_back(local_matrix(document, i));
        hierarchy.hidden.push_back(!is_visible(nodes[i]));
    }
    walk(document, roots, [&](std::size_t node) {
        reached[node] = true;
        for (const int number : nodes[node].children) {
            const auto child = static_cast<std::size_t>(number);
            hierarchy.world[child] = hierarchy.world[node] * hierarchy.world[child];
            hierarchy.hidden[child] = hierarchy.hidden[child] || hierarchy.hidden[node];
        }
    });
    for (std::size_t i = 0; i < nodes.size(); ++i)
        document.require(reached[i], fmt::format("nodes[{}].children", i), "no cycle of nodes");
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
    for (const int node : scene.nodes) chosen.push_back(static_cast<std::size_t>(node));
    return chosen;
}

// What looks along -z of its node with +y up, as a rotation and a place: the node's scale is ignored, the sign of it,
// too (glTF 2.0, section 3.10). Where axes are not at right angles, the direction of view is kept, then what is up.
// Nothing where the scale is 0.
std::optional<glm::mat4> without_scale(const glm::dmat4& world) {
    glm::dmat4 result = world;
    for (int column = 0; column < 3; ++column) {
        const double length = glm::length(glm::dvec3(world[column]));
        if (!(length > 0.0 && std::isfinite(length))) return std::nullopt;
        result[column] = world[column] / length;
    }
    const glm::dvec3 x(result[0]), y(result[1]), z(result[2]);
    constexpr double right_enough = 1e-6;
    if (std::max({std::fabs(glm::dot(x, y)), std::fabs(glm::dot(y, z)), std::fabs(glm::dot(z, x))}) > right_enough) {
        const glm::dvec3 across = glm::cross(y, z);
        if (!(glm::length(across) > 0.0)) return std::nullopt;
        result[0] = glm::dvec4(glm::normalize(across), 0.0);
        result[1] = glm::dvec4(glm::cross(z, glm::dvec3(result[0])), 0.0);
    } else if (glm::determinant(glm::dmat3(result)) < 0.0) {
        result[0] = -result[0];
    }
    return glm::mat4(result);
}

Camera camera_of(const Document& document, int index, std::size_t node, const glm::dmat4& world) {
    const auto& source = document.at(document.model().cameras, index, "nodes", "camera");
    const std::string place = fmt::format("cameras[{}].{}", index, source.type);
    const auto require_order = [&](double near, double far) {
        document.require(far > near, place + ".zfar", "more than znear {}, got {}", near, far);
    };
    Camera camera;
    camera.name = source.name;
    const auto to_world = without_scale(world);
    document.require(to_world.has_value(), node_place(document, node),
                     "a scale that is not 0, as a camera stands there");
    camera.to_world = *to_world;
    camera.orthographic = source.type == "orthographic";
    if (camera.orthographic) {
        const auto& o = source.orthographic;
        document.require(o.xmag > 0.0, place, "an object");
        require_order(o.znear, o.zfar);
        camera.xmag = static_cast<float>(o.xmag);
        camera.ymag = static_cast<float>(o.ymag);
        camera.near = static_cast<float>(o.znear);
        camera.far = static_cast<float>(o.zfar);
        return camera;
    }
    const auto& p = source.perspective;
    document.require(p.yfov > 0.0, place, "an object");
    if (p.zfar != 0.0) require_order(p.znear, p.zfar);
    camera.fovy = static_cast<float>(p.yfov);
    camera.aspect = static_cast<float>(p.aspectRatio);
    camera.near = static_cast<float>(p.znear);
    camera.far = static_cast<float>(p.zfar);
    return camera;
}

Light light_of(const Document& document, int index, const glm::dmat4& world) {
    const auto& source = document.at(document.model().lights, index, "nodes", "light");
    Light light;
    light.name = source.name;
    light.to_world = without_scale(world).value_or(glm::translate(glm::mat4(1.0F), glm::vec3(world[3])));
    if (source.type == "directional")
        light.kind = LightKind::directional;
    else if (source.type == "spot")
        light.kind = LightKind::spot;
    if (source.color.size() == 3) light.colour = glm::vec3(source.color[0], source.color[1], source.color[2]);
    light.intensity = static_cast<float>(source.intensity);
    light.range = static_cast<float>(source.range);
    light.inner_cone = static_cast<float>(source.spot.innerConeAngle);
    light.outer_cone = static_cast<float>(source.spot.outerConeAngle);
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
    spread_from_parents(document, roots, hierarchy);
    std::vector<bool> seen(hierarchy.world.size());
    walk(document, scene_roots(document, which, roots), [&](std::size_t node) {
        document.require(!seen[node], "scenes.nodes", "roots only, got node {} and one above it", node);
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
    const tinygltf::Value& attributes = found->second.Get("attributes");
    const auto read = [&](const char* name, std::uint8_t components) {
        if (!attributes.Has(name)) return std::vector<glm::vec4>();
        return accessors.floats(attributes.Get(name).GetNumberAsInt(), {components, components},
                                fmt::format("{} {}", place, name));
    };
    const auto translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4), scales = read("SCALE", 3);
    const auto count = std::max({translations.size(), rotations.size(), scales.size()});
    document.require(count >= 1, place, "attributes TRANSLATION, ROTATION or SCALE");
    for (const auto* list : {&translations, &rotations, &scales})
        document.require(list->empty() || list->size() == count, place,
                         "a count of {} in each of its attributes, got {}", count, list->size());
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
    for (const auto& [camera, node] : used) cameras.push_back(camera_of(document, camera, node, hierarchy.world[node]));
    return cameras;
}

std::vector<Light> read_lights(const Document& document, const Hierarchy& hierarchy) {
    std::vector<Light> lights;
    for (const std::size_t node : hierarchy.in_scene) {
        const auto& extensions = document.model().nodes[node].extensions;
        const auto found = extensions.find("KHR_lights_punctual");
        if (found == extensions.end() || hierarchy.hidden[node]) continue;
        lights.push_back(light_of(document, found->second.Get("light").GetNumberAsInt(), hierarchy.world[node]));
    }
    return lights;
}

} // namespace traces::gltf
