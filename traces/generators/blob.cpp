// A dense closed mesh with bumps, in place of a scanned figure (specification 004, section 9.7).
//
// Rings of vertices round an axis, as many in each as its length asks for, are sewn together, so that triangles have
// about one size and vertices about six neighbours, as in a scan.
#include "sim/check.hpp"
#include "traces/generators/mesh.hpp"
#include "traces/generators/table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traces {

enum class TriangleOrder : std::uint8_t { patches, random };

} // namespace traces

template <>
struct sim::EnumNames<traces::TriangleOrder> {
    static constexpr std::array<std::string_view, 2> names{"patches", "random"};
};

namespace traces {

namespace {

struct BlobParams {
    std::uint32_t triangles = 871'000;
    double bumps = 0.35;
    TriangleOrder order = TriangleOrder::patches;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using P = BlobParams;
        return std::tuple(sim::field<&P::triangles>("triangles; an odd number is rounded down").range(100, 40'000'000),
                          sim::field<&P::bumps>("height of the bumps in radii; 0 = a sphere").range(0.0, 0.6),
                          sim::field<&P::order>("order of the triangles: patches of neighbours, or none"),
                          sim::field<&P::seed>("of the bumps and of the random order"));
    }
};
static_assert(sim::fully_described<BlobParams>);

constexpr double pi = std::numbers::pi;

// Rings from pole to pole; ring i has size[i] vertices, the first of them being vertex first[i]. The poles are vertices
// 0 and 1. A closed mesh of V vertices has 2V - 4 triangles.
struct Rings {
    std::vector<std::uint32_t> size, first;

    explicit Rings(std::uint32_t triangles) {
        const std::uint32_t vertices = triangles / 2;
        // Equilateral triangles of side `step` tile the unit sphere; rings lie their height apart.
        const double step = std::sqrt(16.0 * pi / (std::sqrt(3.0) * triangles));
        const auto bands = static_cast<std::uint32_t>(std::lround(pi / (step * std::sqrt(3.0) / 2.0)));
        double total = 0.0, sum = 0.0;
        for (std::uint32_t i = 1; i < bands; ++i) total += std::sin(pi * i / bands);
        std::uint32_t placed = 0;
        for (std::uint32_t i = 1; i < bands; ++i) {
            sum += std::sin(pi * i / bands);
            const auto until =
                i + 1 == bands ? vertices : static_cast<std::uint32_t>(std::lround(vertices * sum / total));
            CHECK(until >= placed + 3);
            first.push_back(2 + placed);
            size.push_back(until - placed);
            placed = until;
        }
    }
    double polar(std::size_t ring) const {
        return pi * static_cast<double>(ring + 1) / static_cast<double>(size.size() + 1);
    }
    double azimuth(std::size_t ring, std::uint32_t i) const {
        // Every other ring is turned by half a step.
        return 2.0 * pi * (i + 0.5 * static_cast<double>(ring % 2)) / size[ring];
    }
};

// A sum of waves along random directions; the shorter the wave the lower it is.
class Relief {
  public:
    Relief(double height, std::uint64_t seed) {
        sim::Random random(seed, "blob relief");
        double total = 0.0;
        for (int i = 0; i < 10; ++i) {
            const double z = 2.0 * random.uniform() - 1.0, angle = 2.0 * pi * random.uniform();
            const double across = std::sqrt(1.0 - z * z), frequency = 3.0 + 2.5 * i;
            const glm::dvec3 axis(across * std::cos(angle), across * std::sin(angle), z);
            waves_.push_back({axis * frequency, 2.0 * pi * random.uniform(), 1.0 / std::sqrt(frequency)});
            total += waves_.back().height;
        }
        for (Wave& wave : waves_) wave.height *= 2.0 * height / total;
    }
    glm::dvec3 operator()(const glm::dvec3& direction) const {
        double radius = 1.0;
        for (const Wave& wave : waves_) radius += wave.height * std::sin(glm::dot(wave.along, direction) + wave.phase);
        return direction * std::max(radius, 0.2);
    }

  private:
    struct Wave {
        glm::dvec3 along;
        double phase, height;
    };
    std::vector<Wave> waves_;
};

struct Triangle {
    std::array<std::uint32_t, 3> corners;
    std::uint64_t key; ///< patch: 8 bands high, about 8 vertices wide
};

class Sewing {
  public:
    explicit Sewing(const Rings& rings) : rings_(rings) {
        const auto widest = *std::max_element(rings.size.begin(), rings.size.end());
        sectors_ = std::max(1U, widest / 8);
    }
    std::vector<Triangle> all() && {
        const auto last = static_cast<std::uint32_t>(rings_.size.size() - 1);
        cap(0, 0, false);
        for (std::uint32_t ring = 0; ring < last; ++ring) band(ring);
        cap(last, 1, true);
        return std::move(triangles_);
    }

  private:
    void add(std::uint32_t band, double turn, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto sector = std::min(static_cast<std::uint32_t>(turn * sectors_), sectors_ - 1);
        triangles_.push_back({{a, b, c}, (std::uint64_t{band / 8} * sectors_ + sector) * 8 + band % 8});
    }
    std::uint32_t vertex(std::uint32_t ring, std::uint32_t i) const {
        return rings_.first[ring] + i % rings_.size[ring];
    }

    void cap(std::uint32_t ring, std::uint32_t pole, bool south) {
        for (std::uint32_t i = 0; i < rings_.size[ring]; ++i) {
            const std::uint32_t a = vertex(ring, i), b = vertex(ring, i + 1);
            add(south ? ring + 1 : 0, static_cast<double>(i) / rings_.size[ring], pole, south ? a : b, south ? b : a);
        }
    }
    // Between two rings, always on with the side whose next vertex comes first.
    void band(std::uint32_t ring) {
        const std::uint32_t above = rings_.size[ring], below = rings_.size[ring + 1];
        for (std::uint32_t i = 0, j = 0; i < above || j < below;) {
            const double turn = static_cast<double>(i + j) / (above + below);
            const bool step_above =
                j == below || (i < above && rings_.azimuth(ring, i + 1) < rings_.azimuth(ring + 1, j + 1));
            const std::uint32_t a = vertex(ring, i), b = vertex(ring + 1, j);
            if (step_above)
                add(ring + 1, turn, a, vertex(ring, ++i), b);
            else
                add(ring + 1, turn, a, vertex(ring + 1, ++j), b);
        }
    }

    const Rings& rings_;
    std::uint32_t sectors_;
    std::vector<Triangle> triangles_;
};

std::vector<glm::vec3> positions_on(const Rings& rings, const Relief& relief) {
    std::vector<glm::vec3> positions{relief({0.0, 1.0, 0.0}), relief({0.0, -1.0, 0.0})};
    for (std::size_t ring = 0; ring < rings.size.size(); ++ring) {
        const double across = std::sin(rings.polar(ring)), y = std::cos(rings.polar(ring));
        for (std::uint32_t i = 0; i < rings.size[ring]; ++i) {
            const double angle = rings.azimuth(ring, i);
            positions.emplace_back(relief({across * std::cos(angle), y, across * std::sin(angle)}));
        }
    }
    return positions;
}

/// Vertices in the order of their first use: what lies together is fetched together.
void number_by_use(Mesh& mesh) {
    constexpr std::uint32_t unused = ~0U;
    std::vector<std::uint32_t> number(mesh.positions.size(), unused);
    std::vector<glm::vec3> positions;
    positions.reserve(mesh.positions.size());
    for (std::uint32_t& index : mesh.indices) {
        if (number[index] == unused) {
            number[index] = static_cast<std::uint32_t>(positions.size());
            positions.push_back(mesh.positions[index]);
        }
        index = number[index];
    }
    mesh.positions = std::move(positions);
}

void set_indices(Mesh& mesh, const std::vector<Triangle>& triangles) {
    mesh.indices.clear();
    for (const Triangle& triangle : triangles)
        mesh.indices.insert(mesh.indices.end(), triangle.corners.begin(), triangle.corners.end());
}

Scene build(const BlobParams& params) {
    const Rings rings(params.triangles);
    std::vector<Triangle> triangles = Sewing(rings).all();
    std::stable_sort(triangles.begin(), triangles.end(),
                     [](const Triangle& a, const Triangle& b) { return a.key < b.key; });
    sim::Random random(params.seed, "blob order");
    if (params.order == TriangleOrder::random) shuffle(triangles, random);
    Mesh mesh;
    mesh.name = "blob";
    mesh.positions = positions_on(rings, Relief(params.bumps, params.seed));
    set_indices(mesh, triangles);
    number_by_use(mesh);
    compute_normals(mesh);
    Scene scene = scene_of_material("blob", {0.75F, 0.55F, 0.4F, 1.0F});
    add_draw(scene, add_mesh(*scene.resources, mesh, VertexLayout::separate));
    return scene;
}

} // namespace

Generator blob_generator() {
    return make_generator<BlobParams>("blob", "a dense closed mesh with bumps, in place of a scanned figure", build);
}

} // namespace traces
