#include "traces/gltf/export_nodes.hpp"

#include "traces/gltf/export_geometry.hpp"
#include "traces/gltf/nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <optional>

namespace traces::gltf {

using nlohmann::ordered_json;

namespace {

constexpr double closest =
    1e-5; ///< what splitting a matrix may change, relative to its largest element but translation

struct Placement {
    std::array<float, 3> translation{};
    std::array<float, 4> rotation{}; ///< x, y, z, w
    std::array<float, 3> scale{};
};

double largest_element(const glm::dmat4& matrix) {
    double largest = 0.0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) largest = std::max(largest, std::fabs(matrix[column][row]));
    return largest;
}

/// Translation, rotation and scale; nothing where they do not give the matrix back.
std::optional<Placement> placement_of(const glm::mat4& instance) {
    const glm::dmat4 matrix(instance);
    glm::dvec3 scale(0.0);
    glm::dmat3 turn(1.0);
    for (int column = 0; column < 3; ++column) {
        scale[column] = glm::length(glm::dvec3(matrix[column]));
        if (!(scale[column] > 0.0)) return std::nullopt;
        turn[column] = glm::dvec3(matrix[column]) / scale[column];
    }
    if (glm::determinant(turn) < 0.0) {
        scale.x = -scale.x;
        turn[0] = -turn[0];
    }
    const glm::dquat rotation = glm::quat_cast(turn);
    Placement result;
    for (int i = 0; i < 3; ++i) {
        result.translation[static_cast<std::size_t>(i)] = instance[3][i];
        result.scale[static_cast<std::size_t>(i)] = static_cast<float>(scale[i]);
    }
    result.rotation = {static_cast<float>(rotation.x), static_cast<float>(rotation.y), static_cast<float>(rotation.z),
                       static_cast<float>(rotation.w)};
    const auto& [t, r, s] = result;
    const glm::dmat4 again =
        transform(glm::dvec3(t[0], t[1], t[2]), glm::dvec4(r[0], r[1], r[2], r[3]), glm::dvec3(s[0], s[1], s[2]));
    const bool same_row = matrix[0].w == 0.0 && matrix[1].w == 0.0 && matrix[2].w == 0.0 && matrix[3].w == 1.0;
    if (!same_row || !(largest_element(again - matrix) <= closest * largest_element(matrix))) return std::nullopt;
    return result;
}

ordered_json matrix_json(const glm::mat4& matrix) {
    ordered_json list = ordered_json::array();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) list.push_back(matrix[column][row]);
    return list;
}

void add_node(GlbFile& file, ordered_json node, const glm::mat4& matrix) {
    if (matrix != glm::mat4(1.0F)) node["matrix"] = matrix_json(matrix);
    const std::size_t number = file.add("nodes", std::move(node));
    file.json["scenes"][0]["nodes"].push_back(number);
}

bool add_instances(GlbFile& file, const pipeline::Draw& draw, std::size_t mesh) {
    std::vector<float> translations, rotations, scales;
    for (const glm::mat4& instance : draw.instances) {
        const std::optional<Placement> place = placement_of(instance);
        if (!place) return false;
        translations.insert(translations.end(), place->translation.begin(), place->translation.end());
        rotations.insert(rotations.end(), place->rotation.begin(), place->rotation.end());
        scales.insert(scales.end(), place->scale.begin(), place->scale.end());
    }
    ordered_json node = {{"name", draw.name}, {"mesh", mesh}};
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", export_floats(file, translations, 3)},
        {"ROTATION", export_floats(file, rotations, 4)},
        {"SCALE", export_floats(file, scales, 3)}};
    file.use_extension("EXT_mesh_gpu_instancing", true);
    file.notes.push_back(fmt::format("{}: {} instances are written as translation, rotation and scale", draw.name,
                                     draw.instances.size()));
    add_node(file, std::move(node), glm::mat4(1.0F));
    return true;
}

} // namespace

void export_draw(GlbFile& file, const pipeline::Draw& draw, std::size_t mesh) {
    if (draw.instances.size() > 1 && add_instances(file, draw, mesh)) return;
    for (const glm::mat4& instance : draw.instances) add_node(file, {{"name", draw.name}, {"mesh", mesh}}, instance);
    if (draw.instances.size() > 1)
        file.notes.push_back(
            fmt::format("{}: {} instances are written as that many nodes", draw.name, draw.instances.size()));
}

void export_camera(GlbFile& file, const Camera& camera) {
    ordered_json json = {{"name", camera.name}};
    if (camera.orthographic) {
        json["type"] = "orthographic";
        json["orthographic"] = {
            {"xmag", camera.xmag}, {"ymag", camera.ymag}, {"zfar", camera.far}, {"znear", camera.near}};
    } else {
        json["type"] = "perspective";
        ordered_json& perspective = json["perspective"] = {{"yfov", camera.fovy}, {"znear", camera.near}};
        if (camera.aspect > 0.0F) perspective["aspectRatio"] = camera.aspect;
        if (camera.far > 0.0F) perspective["zfar"] = camera.far;
    }
    const std::size_t number = file.add("cameras", std::move(json));
    add_node(file, {{"name", camera.name}, {"camera", number}}, camera.to_world);
}

void export_light(GlbFile& file, const Light& light) {
    static constexpr std::array<const char*, 3> types{"directional", "point", "spot"};
    ordered_json json = {{"name", light.name},
                         {"type", types.at(static_cast<std::size_t>(light.kind))},
                         {"color", {light.colour.r, light.colour.g, light.colour.b}},
                         {"intensity", light.intensity}};
    if (light.range > 0.0F) json["range"] = light.range;
    if (light.kind == LightKind::spot)
        json["spot"] = {{"innerConeAngle", light.inner_cone}, {"outerConeAngle", light.outer_cone}};
    file.use_extension("KHR_lights_punctual", false);
    ordered_json& list = file.json["extensions"]["KHR_lights_punctual"]["lights"];
    list.push_back(std::move(json));
    ordered_json node = {{"name", light.name}};
    node["extensions"]["KHR_lights_punctual"]["light"] = list.size() - 1;
    add_node(file, std::move(node), light.to_world);
}

} // namespace traces::gltf
