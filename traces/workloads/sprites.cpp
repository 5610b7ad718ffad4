#include "traces/workloads/sprites.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "traces/workloads/scalar_field.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <span>

namespace traces {

using pipeline::Semantic;

namespace {

void add_points(std::vector<SpritePoint>& points, const pipeline::Resources& resources,
                const pipeline::Geometry& geometry, const glm::dmat4& to_eye) {
    const pipeline::AttributeReader position(resources, *geometry.find(Semantic::position));
    const pipeline::VertexAttribute* colour = geometry.find(Semantic::colour);
    for (std::uint32_t i = 0; i < geometry.vertex_count; ++i) {
        const glm::dvec4 place = to_eye * glm::dvec4(glm::dvec3(position(i)), 1.0);
        const float scalar = colour == nullptr ? 0.0F : pipeline::AttributeReader(resources, *colour)(i).r;
        points.push_back({glm::vec3(glm::dvec3(place)), scalar});
    }
}

template <class T>
pipeline::VertexAttribute add_attribute(pipeline::Resources& resources, Semantic semantic,
                                        const std::vector<T>& values) {
    pipeline::VertexAttribute attribute;
    attribute.semantic = semantic;
    attribute.components = sizeof(T) / 4; // floats
    attribute.stride = sizeof(T);
    attribute.buffer = static_cast<std::uint32_t>(resources.buffers.size());
    const auto bytes = std::as_bytes(std::span<const T>(values));
    resources.buffers.push_back(
        {semantic == Semantic::position ? "sprites" : "sprite colours", {bytes.begin(), bytes.end()}, 0});
    return attribute;
}

/// Half a sprite in eye space, for each unit of w of its point.
glm::dvec2 half_size(const pipeline::View& view, double size) {
    return {size / view.width / static_cast<double>(view.projection[0][0]),
            size / view.height / static_cast<double>(view.projection[1][1])};
}

std::vector<glm::vec3> corners_of(const std::vector<SpritePoint>& points, const pipeline::View& view, double size) {
    const glm::dvec2 half = half_size(view, size);
    const double w_slope = static_cast<double>(view.projection[2][3]),
                 w_offset = static_cast<double>(view.projection[3][3]);
    std::vector<glm::vec3> corners;
    corners.reserve(points.size() * 4);
    for (const SpritePoint& point : points) {
        const glm::dvec3 place(point.place);
        const double w = w_slope * place.z + w_offset;
        for (const double y : {-1.0, 1.0})
            for (const double x : {-1.0, 1.0})
                corners.emplace_back(glm::vec3(place + glm::dvec3(x * half.x * w, y * half.y * w, 0.0)));
    }
    return corners;
}

std::vector<std::uint32_t> indices_of(std::size_t points) {
    std::vector<std::uint32_t> indices;
    indices.reserve(points * 6);
    for (std::size_t i = 0; i < points; ++i)
        for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U})
            indices.push_back(static_cast<std::uint32_t>(i * 4) + corner);
    return indices;
}

std::vector<glm::vec3> colours_of(const std::vector<SpritePoint>& points) {
    const auto [lo, hi] = std::minmax_element(points.begin(), points.end(),
                                              [](const auto& a, const auto& b) { return a.scalar < b.scalar; });
    const double first = static_cast<double>(lo->scalar), range = static_cast<double>(hi->scalar) - first;
    std::vector<glm::vec3> colours;
    for (const SpritePoint& point : points) {
        const double share = range > 0.0 ? (static_cast<double>(point.scalar) - first) / range : 0.5;
        colours.insert(colours.end(), 4, colour_of_share(share));
    }
    return colours;
}

std::vector<float> scalars_of(const std::vector<SpritePoint>& points) {
    std::vector<float> scalars;
    for (const SpritePoint& point : points) scalars.insert(scalars.end(), 4, point.scalar);
    return scalars;
}

pipeline::Material sprite_material() {
    pipeline::Material material;
    material.name = "sprites";
    material.unlit = true;
    material.double_sided = true;
    return material;
}

} // namespace

std::vector<SpritePoint> points_of(const pipeline::Frame& frame) {
    std::uint64_t count = 0;
    for (const pipeline::Draw& draw : frame.draws)
        count += std::uint64_t{frame.resources->geometries[draw.geometry].vertex_count} * draw.instances.size();
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() / 6;
    if (count > most)
        throw sim::InputError(fmt::format("workload particles: expected at most {} points, got {}", most, count));
    std::vector<SpritePoint> points;
    points.reserve(count);
    for (const pipeline::Draw& draw : frame.draws)
        for (const glm::mat4& instance : draw.instances)
            add_points(points, *frame.resources, frame.resources->geometries[draw.geometry],
                       glm::dmat4(frame.view.view) * glm::dmat4(instance));
    return points;
}

void draw_sprites(pipeline::Frame& frame, const std::vector<SpritePoint>& points, double size, SpriteColour colour) {
    CHECK(!points.empty());
    auto resources = std::make_shared<pipeline::Resources>();
    resources->materials.push_back(sprite_material());
    pipeline::Geometry geometry;
    geometry.name = "sprites";
    geometry.vertex_count = static_cast<std::uint32_t>(points.size() * 4);
    geometry.attributes.push_back(add_attribute(*resources, Semantic::position, corners_of(points, frame.view, size)));
    geometry.attributes.push_back(colour == SpriteColour::scalar
                                      ? add_attribute(*resources, Semantic::colour, scalars_of(points))
                                      : add_attribute(*resources, Semantic::colour, colours_of(points)));
    const std::vector<std::uint32_t> indices = indices_of(points.size());
    const auto bytes = std::as_bytes(std::span<const std::uint32_t>(indices));
    geometry.index_type = pipeline::IndexType::u32;
    geometry.index_count = static_cast<std::uint32_t>(indices.size());
    geometry.index_buffer = static_cast<std::uint32_t>(resources->buffers.size());
    resources->buffers.push_back({"sprite indices", {bytes.begin(), bytes.end()}, 0});
    resources->geometries.push_back(std::move(geometry));
    resources->place();
    frame.resources = std::move(resources);
    frame.draws = {{"sprites", 0, 0, {glm::mat4(1.0F)}}};
    frame.view.view = glm::mat4(1.0F);
}

} // namespace traces
