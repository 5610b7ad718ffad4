#include "traces/preparation/conservation.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "traces/preparation/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/glm.hpp>
#include <map>
#include <vector>
#include <xxhash.h>

namespace traces {

using pipeline::Geometry;
using pipeline::Resources;
using pipeline::Semantic;
using pipeline::VertexAttribute;

namespace {

/// A hash per vertex; the order of the attributes does not matter.
std::vector<std::uint64_t> vertex_hashes(const Resources& resources, const Geometry& geometry) {
    std::vector<std::uint64_t> hashes(geometry.vertex_count, 0);
    for (const VertexAttribute& attribute : geometry.attributes) {
        const auto seed = static_cast<std::uint64_t>(attribute.semantic);
        const std::byte* first = resources.buffers[attribute.buffer].bytes.data() + attribute.offset;
        for (std::size_t i = 0; i < hashes.size(); ++i)
            hashes[i] += XXH3_64bits_withSeed(first + i * attribute.stride, attribute.bytes(), seed);
    }
    return hashes;
}

/// Turns the corners so that the smallest hash comes first.
std::uint64_t triangle_hash(std::array<std::uint64_t, 3> corners) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return XXH3_64bits(corners.data(), sizeof corners);
}

bool differ(const std::array<std::uint64_t, 3>& corners) {
    return corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
}

DrawnTriangles triangles_of(const Resources& resources, const Geometry& geometry) {
    DrawnTriangles result;
    result.lists = geometry.topology == pipeline::Topology::triangles;
    const std::vector<std::uint64_t> hashes = vertex_hashes(resources, geometry);
    const pipeline::PrimitiveReader read(resources, geometry);
    for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i) {
        const std::array<std::uint32_t, 3> vertices = read(i);
        std::array<std::uint64_t, 3> corners{hashes[vertices[0]], hashes[vertices[1]], hashes[vertices[2]]};
        if (differ(corners)) {
            ++result.triangles;
            result.hash += triangle_hash(corners);
        } else {
            std::sort(corners.begin(), corners.end()); // winding means nothing here
            ++result.degenerate;
            result.degenerate_hash += triangle_hash(corners);
        }
    }
    return result;
}

/// Odd, so that multiplying by it loses nothing.
std::uint64_t draw_factor(const pipeline::Draw& draw) {
    return XXH3_64bits_withSeed(draw.instances.data(), draw.instances.size() * sizeof(glm::mat4), draw.material) | 1U;
}

/// The vertices of two geometries that stand at the same corners; each of `after` once.
struct VertexPair {
    std::uint32_t before = 0, after = 0;
};

std::vector<VertexPair> paired_vertices(const Resources& old_resources, const Geometry& old_geometry,
                                        const Resources& resources, const Geometry& geometry) {
    CHECK(old_geometry.triangle_count() == geometry.triangle_count());
    const pipeline::PrimitiveReader read_old(old_resources, old_geometry), read(resources, geometry);
    std::vector<std::uint32_t> old_of(geometry.vertex_count, no_vertex);
    std::vector<VertexPair> pairs;
    for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i) {
        const std::array<std::uint32_t, 3> from = read_old(i), to = read(i);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            std::uint32_t& known = old_of[to[corner]];
            if (known == no_vertex) pairs.push_back({from[corner], to[corner]});
            CHECK(known == no_vertex || known == from[corner]);
            known = from[corner];
        }
    }
    return pairs;
}

void check_attributes(const Resources& old_resources, const Geometry& old_geometry, const Resources& resources,
                      const Geometry& geometry, std::span<const VertexPair> pairs, std::span<const Semantic> changed) {
    CHECK(old_geometry.attributes.size() == geometry.attributes.size());
    for (const VertexAttribute& attribute : geometry.attributes) {
        if (std::find(changed.begin(), changed.end(), attribute.semantic) != changed.end()) continue;
        const VertexAttribute* old_attribute = old_geometry.find(attribute.semantic);
        CHECK(old_attribute != nullptr);
        const pipeline::AttributeReader read_old(old_resources, *old_attribute), read(resources, attribute);
        for (const VertexPair& pair : pairs) {
            const glm::vec4 from = read_old(pair.before), to = read(pair.after);
            CHECK_MSG(glm::floatBitsToUint(from) == glm::floatBitsToUint(to),
                      fmt::format("{}: vertex {} changed", geometry.name, pair.before));
        }
    }
}

double largest_distance(const pipeline::AttributeReader& read_old, const glm::dmat4& old_matrix,
                        const pipeline::AttributeReader& read, const glm::dmat4& matrix,
                        std::span<const VertexPair> pairs) {
    double largest = 0.0; // squared
    for (const VertexPair& pair : pairs) {
        const glm::dvec4 from(glm::dvec3(glm::vec3(read_old(pair.before))), 1.0);
        const glm::dvec4 to(glm::dvec3(glm::vec3(read(pair.after))), 1.0);
        const glm::dvec3 arm(old_matrix * from - matrix * to);
        largest = std::max(largest, glm::dot(arm, arm));
    }
    return std::sqrt(largest);
}

} // namespace

DrawnTriangles drawn_triangles(const Scene& scene) {
    std::map<std::uint32_t, DrawnTriangles> known;
    DrawnTriangles sum;
    for (const pipeline::Draw& draw : scene.draws) {
        const auto [entry, is_new] = known.try_emplace(draw.geometry);
        if (is_new) entry->second = triangles_of(*scene.resources, scene.resources->geometries[draw.geometry]);
        const std::uint64_t factor = draw_factor(draw);
        sum.triangles += entry->second.triangles;
        sum.hash += entry->second.hash * factor;
        sum.degenerate += entry->second.degenerate;
        sum.degenerate_hash += entry->second.degenerate_hash * factor;
        sum.lists = sum.lists && entry->second.lists;
    }
    return sum;
}

void check_same_triangles(const DrawnTriangles& before, const DrawnTriangles& after, bool drops_degenerate) {
    CHECK_MSG(before.triangles == after.triangles,
              fmt::format("{} triangles became {}", before.triangles, after.triangles));
    CHECK(before.hash == after.hash);
    if (drops_degenerate || !before.lists || !after.lists) return;
    CHECK_MSG(before.degenerate == after.degenerate,
              fmt::format("{} degenerate triangles became {}", before.degenerate, after.degenerate));
    CHECK(before.degenerate_hash == after.degenerate_hash);
}

double check_same_order(const Scene& before, const Scene& after, std::span<const Semantic> changed) {
    CHECK(before.draws.size() == after.draws.size());
    std::map<std::uint32_t, std::vector<VertexPair>> known; // by the geometry after
    double largest = 0.0;
    for (std::size_t i = 0; i < before.draws.size(); ++i) {
        const pipeline::Draw &from = before.draws[i], &to = after.draws[i];
        CHECK(from.instances.size() == to.instances.size() && from.material == to.material);
        const Geometry& old_geometry = before.resources->geometries[from.geometry];
        const Geometry& geometry = after.resources->geometries[to.geometry];
        const auto [entry, is_new] = known.try_emplace(to.geometry);
        if (is_new) {
            entry->second = paired_vertices(*before.resources, old_geometry, *after.resources, geometry);
            check_attributes(*before.resources, old_geometry, *after.resources, geometry, entry->second, changed);
        }
        const pipeline::AttributeReader read_old(*before.resources, *old_geometry.find(Semantic::position));
        const pipeline::AttributeReader read(*after.resources, *geometry.find(Semantic::position));
        for (std::size_t j = 0; j < from.instances.size(); ++j)
            largest = std::max(largest, largest_distance(read_old, glm::dmat4(from.instances[j]), read,
                                                         glm::dmat4(to.instances[j]), entry->second));
    }
    return largest;
}

} // namespace traces
