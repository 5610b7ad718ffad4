#include "traces/generators/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace traces {

Scene scene_of_material(std::string material, const glm::vec4& colour) {
    Scene scene;
    scene.resources = std::make_shared<pipeline::Resources>();
    pipeline::Material only;
    only.name = std::move(material);
    only.base_colour = colour;
    only.double_sided = true;
    scene.resources->materials.push_back(std::move(only));
    return scene;
}

void compute_normals(Mesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0F));
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const glm::vec3 twice_area =
            glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        for (const std::uint32_t corner : {a, b, c}) mesh.normals[corner] += twice_area;
    }
    for (glm::vec3& normal : mesh.normals) {
        const float length = glm::length(normal);
        normal = length > 0.0F ? normal / length : glm::vec3(0.0F, 1.0F, 0.0F);
    }
}

Colour colour_of(std::uint64_t number) {
    // Steps of the golden ratio around the colour wheel never come near a recent hue.
    const double hue = static_cast<double>(number % 1000003) * 0.6180339887498949;
    const double turn = (hue - std::floor(hue)) * 6.0;
    const auto ramp = [&](double centre) {
        const double distance = std::abs(turn - centre) > 3.0 ? 6.0 - std::abs(turn - centre) : std::abs(turn - centre);
        return static_cast<std::uint8_t>(255.0 * (0.15 + 0.85 * std::clamp(2.0 - distance, 0.0, 1.0)));
    };
    return {ramp(0.0), ramp(2.0), ramp(4.0), 255};
}

std::vector<float> layer_depths(std::uint32_t n, DepthOrder order, std::uint64_t seed) {
    std::vector<float> depths(n);
    for (std::uint32_t i = 0; i < n; ++i) depths[i] = static_cast<float>((i + 1.0) / (n + 1.0));
    if (order == DepthOrder::back_to_front) std::reverse(depths.begin(), depths.end());
    sim::Random random(seed, "layer depths");
    if (order == DepthOrder::random) shuffle(depths, random);
    return depths;
}

} // namespace traces
