#include "traces/preparation/patches.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <glm/glm.hpp>
#include <numeric>
#include <span>

namespace traces {

namespace {

std::vector<glm::dvec3> positions_of(const TriangleMesh& mesh) {
    const auto position = std::find_if(mesh.attributes.begin(), mesh.attributes.end(), [](const auto& attribute) {
        return attribute.semantic == pipeline::Semantic::position;
    });
    CHECK(position != mesh.attributes.end());
    const pipeline::AttributeReader read(mesh.streams[position->buffer].records.data(), *position);
    std::vector<glm::dvec3> positions;
    positions.reserve(mesh.vertices);
    for (std::uint32_t i = 0; i < mesh.vertices; ++i) positions.emplace_back(glm::vec3(read(i)));
    return positions;
}

std::vector<glm::dvec3> centroids_of(const TriangleMesh& mesh) {
    const std::vector<glm::dvec3> positions = positions_of(mesh);
    std::vector<glm::dvec3> centroids(mesh.indices.size() / 3, glm::dvec3(0.0));
    for (std::size_t i = 0; i < centroids.size() * 3; ++i) centroids[i / 3] += positions[mesh.indices[i]] / 3.0;
    return centroids;
}

double trace_of(const glm::dmat3& m) { return m[0][0] + m[1][1] + m[2][2]; }

/// The direction of largest variance; not of unit length, zero where all points are one.
glm::dvec3 principal_axis(std::span<const std::uint32_t> members, const std::vector<glm::dvec3>& points) {
    glm::dvec3 middle(0.0);
    for (const std::uint32_t i : members) middle += points[i] / static_cast<double>(members.size());
    glm::dmat3 covariance(0.0);
    for (const std::uint32_t i : members) {
        const glm::dvec3 arm = points[i] - middle;
        covariance += glm::outerProduct(arm, arm);
    }
    // Powers of a matrix tend to its largest eigenvalue: 2^8 of them tell axes apart that differ by a few percent.
    for (int i = 0; i < 8; ++i) {
        const double trace = trace_of(covariance);
        if (!(trace > 0.0)) return glm::dvec3(0.0);
        covariance /= trace;
        covariance = covariance * covariance;
    }
    int longest = 0;
    for (int column = 1; column < 3; ++column)
        if (glm::dot(covariance[column], covariance[column]) > glm::dot(covariance[longest], covariance[longest]))
            longest = column;
    return covariance[longest];
}

/// Halves at the median along the principal axis; equal places are told apart by number. `key` is room to work in.
void halve(std::span<std::uint32_t> members, const std::vector<glm::dvec3>& points, std::vector<double>& key) {
    const glm::dvec3 axis = principal_axis(members, points);
    for (const std::uint32_t i : members) key[i] = glm::dot(axis, points[i]);
    std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2), members.end(),
                     [&key](std::uint32_t a, std::uint32_t b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
}

class Splitter {
  public:
    Splitter(const TriangleMesh& mesh, std::uint32_t vertices)
        : mesh_(mesh),
          budget_(vertices),
          centroids_(centroids_of(mesh)),
          key_(centroids_.size()),
          seen_(mesh.vertices, 0) {}

    Patches run() {
        Patches patches;
        patches.triangles.resize(centroids_.size());
        std::iota(patches.triangles.begin(), patches.triangles.end(), 0U);
        std::vector<Range> todo;
        if (!centroids_.empty()) todo.push_back({0, centroids_.size()});
        while (!todo.empty()) {
            const Range range = todo.back();
            todo.pop_back();
            const std::span members = std::span(patches.triangles).subspan(range.first, range.end - range.first);
            if (within_budget(members)) {
                std::sort(members.begin(), members.end());
                patches.ends.push_back(range.end);
                continue;
            }
            halve(members, centroids_, key_);
            const std::size_t middle = range.first + members.size() / 2;
            todo.push_back({middle, range.end});
            todo.push_back({range.first, middle});
        }
        return patches;
    }

  private:
    struct Range {
        std::size_t first = 0, end = 0;
    };
    bool within_budget(std::span<const std::uint32_t> members) {
        if (members.size() == 1 || members.size() * 3 <= budget_) return true;
        ++stamp_;
        std::uint32_t distinct = 0;
        for (const std::uint32_t triangle : members)
            for (std::size_t corner = 0; corner < 3; ++corner) {
                std::uint32_t& seen = seen_[mesh_.indices[std::size_t{triangle} * 3 + corner]];
                if (seen == stamp_) continue;
                seen = stamp_;
                if (++distinct > budget_) return false;
            }
        return true;
    }

    const TriangleMesh& mesh_;
    std::uint32_t budget_;
    std::vector<glm::dvec3> centroids_;
    std::vector<double> key_;         ///< by triangle: its place along the axis
    std::vector<std::uint32_t> seen_; ///< by vertex: the last count that met it
    std::uint32_t stamp_ = 0;
};

} // namespace

std::vector<std::uint32_t> places_along_a_split(const TriangleMesh& mesh) {
    const std::vector<glm::dvec3> points = positions_of(mesh);
    std::vector<std::uint32_t> order(points.size()), places(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<double> key(points.size());
    std::vector<std::span<std::uint32_t>> todo{std::span(order)};
    while (!todo.empty()) {
        const std::span<std::uint32_t> members = todo.back();
        todo.pop_back();
        if (members.size() < 2) continue;
        halve(members, points, key);
        todo.push_back(members.subspan(members.size() / 2));
        todo.push_back(members.first(members.size() / 2));
    }
    for (std::uint32_t place = 0; place < order.size(); ++place) places[order[place]] = place;
    return places;
}

Patches split_into_patches(const TriangleMesh& mesh, std::uint32_t vertices) {
    CHECK(mesh.topology == pipeline::Topology::triangles && vertices >= 3);
    return Splitter(mesh, vertices).run();
}

} // namespace traces
