#include "traces/workloads/scalar_field.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <span>

namespace traces {

using pipeline::Semantic;

namespace {

constexpr float most_in_colour = 65504.0F; ///< the shader bounds colours by it

std::vector<double> centroid_distances(const pipeline::Resources& resources, const pipeline::Geometry& geometry,
                                       const glm::dmat4& to_eye) {
    const pipeline::AttributeReader position(resources, *geometry.find(Semantic::position));
    const pipeline::PrimitiveReader corners(resources, geometry);
    std::vector<double> distances(geometry.triangle_count());
    for (std::uint32_t i = 0; i < distances.size(); ++i) {
        glm::dvec3 sum(0.0);
        for (const std::uint32_t vertex : corners(i)) sum += glm::dvec3(position(vertex));
        distances[i] = -(to_eye * glm::dvec4(sum / 3.0, 1.0)).z;
    }
    return distances;
}

// Replaces the indices by those of a sorted list of triangles.
void sort_triangles(pipeline::Resources& resources, pipeline::Geometry& geometry, const glm::dmat4& to_eye) {
    const std::vector<double> distances = centroid_distances(resources, geometry, to_eye);
    std::vector<std::uint32_t> order(distances.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return distances[a] < distances[b]; });
    const pipeline::PrimitiveReader corners(resources, geometry);
    std::vector<std::uint32_t> indices;
    indices.reserve(order.size() * 3);
    for (const std::uint32_t triangle : order)
        for (const std::uint32_t vertex : corners(triangle)) indices.push_back(vertex);
    const auto bytes = std::as_bytes(std::span<const std::uint32_t>(indices));
    geometry.topology = pipeline::Topology::triangles;
    geometry.primitive_restart = false;
    geometry.runs.clear();
    geometry.index_type = pipeline::IndexType::u32;
    geometry.index_buffer = static_cast<std::uint32_t>(resources.buffers.size());
    geometry.index_offset = 0;
    geometry.index_count = static_cast<std::uint32_t>(indices.size());
    resources.buffers.push_back({geometry.name + " sorted indices", {bytes.begin(), bytes.end()}, 0});
}

} // namespace

ScalarRange scalar_range(const pipeline::Frame& frame, std::string_view place) {
    ScalarRange range{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    for (const pipeline::Draw& draw : frame.draws) {
        const pipeline::Geometry& geometry = frame.resources->geometries[draw.geometry];
        const pipeline::VertexAttribute* colour = geometry.find(Semantic::colour);
        if (colour == nullptr)
            throw sim::InputError(
                fmt::format("{}: expected a scalar as the red of vertex colours, as .vtk and .tetm files "
                            "and gen:tetrahedra have, but {} has no colours",
                            place, draw.name));
        const pipeline::AttributeReader read(*frame.resources, *colour);
        for (std::uint32_t i = 0; i < geometry.vertex_count; ++i) {
            const float scalar = read(i).r;
            range.lo = std::min(range.lo, scalar);
            range.hi = std::max(range.hi, scalar);
        }
    }
    const float largest = std::max(std::fabs(range.lo), std::fabs(range.hi));
    if (!frame.draws.empty() && largest > most_in_colour)
        throw sim::InputError(
            fmt::format("{}: expected scalars of at most {}, which the colours of fragments hold, got {}", place,
                        most_in_colour, largest));
    return range;
}

float fragment_scalar(const Scene& scene, float value) { return std::ldexp(value, -scene.scalar_exponent); }

std::vector<float> iso_values_of(pipeline::Frame& frame, const Scene& scene, const std::vector<float>& wanted,
                                 ScalarRange range) {
    if (wanted.empty()) return {0.5F * range.lo + 0.5F * range.hi};
    std::vector<float> values;
    for (const float value : wanted) {
        values.push_back(fragment_scalar(scene, value));
        if (!(values.back() >= range.lo && values.back() <= range.hi))
            frame.notes.push_back(fmt::format("iso-value {} has no surface: the scalars are {} to {}", value,
                                              std::ldexp(range.lo, scene.scalar_exponent),
                                              std::ldexp(range.hi, scene.scalar_exponent)));
    }
    return values;
}

void prepare_scalars(pipeline::Frame& frame, bool sorted) {
    auto resources = std::make_shared<pipeline::Resources>(*frame.resources);
    for (pipeline::Material& material : resources->materials) {
        const std::string name = material.name;
        material = {};
        material.name = name;
        material.unlit = true;
        material.double_sided = true;
    }
    if (sorted)
        for (pipeline::Draw& draw : frame.draws) {
            pipeline::Geometry geometry = resources->geometries[draw.geometry];
            sort_triangles(*resources, geometry, glm::dmat4(frame.view.view) * glm::dmat4(draw.instances.front()));
            draw.geometry = static_cast<std::uint32_t>(resources->geometries.size());
            resources->geometries.push_back(std::move(geometry));
        }
    resources->place();
    frame.resources = std::move(resources);
}

float longest_edge(const pipeline::Frame& frame) {
    double longest = 0.0; // squared
    for (const pipeline::Draw& draw : frame.draws) {
        const pipeline::Geometry& geometry = frame.resources->geometries[draw.geometry];
        const pipeline::AttributeReader position(*frame.resources, *geometry.find(Semantic::position));
        const pipeline::PrimitiveReader corners(*frame.resources, geometry);
        for (const glm::mat4& instance : draw.instances) {
            const glm::dmat3 to_world{glm::dmat4(instance)};
            for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i) {
                const auto [a, b, c] = corners(i);
                const glm::dvec3 p(position(a)), q(position(b)), r(position(c));
                for (const glm::dvec3& edge : {q - p, r - q, p - r}) {
                    const glm::dvec3 in_world = to_world * edge;
                    longest = std::max(longest, glm::dot(in_world, in_world));
                }
            }
        }
    }
    return static_cast<float>(std::sqrt(longest));
}

glm::vec3 colour_of_share(double share) {
    const auto at = static_cast<float>(std::clamp(share, 0.0, 1.0));
    const glm::vec3 cold(0.03F, 0.12F, 0.6F), middle(0.75F, 0.6F, 0.15F), warm(0.7F, 0.04F, 0.02F);
    return at < 0.5F ? glm::mix(cold, middle, 2.0F * at) : glm::mix(middle, warm, 2.0F * at - 1.0F);
}

} // namespace traces
