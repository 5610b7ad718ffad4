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
#include <numeric>

namespace traces {

/// Patches of neighbours; ring by ring; voxel by voxel, in rows and slices, as the surface of a volume is extracted
/// (the order of range scans that were merged in a volume); or none.
enum class TriangleOrder : std::uint8_t { patches, rows, voxels, random };

/// Order of the vertices in the vertex buffer.
enum class VertexOrder : std::uint8_t { first_use, random };

} // namespace traces

template <>
struct sim::EnumNames<traces::TriangleOrder> {
    static constexpr std::array<std::string_view, 4> names{"patches", "rows", "voxels", "random"};
};

template <>
struct sim::EnumNames<traces::VertexOrder> {
    static constexpr std::array<std::string_view, 2> names{"first-use", "random"};
};

namespace traces {

namespace {

struct BlobParams {
    std::uint32_t triangles = 871'000;
    double bumps = 0.35;
    TriangleOrder order = TriangleOrder::patches;
    VertexOrder vertex_order = VertexOrder::first_use;
    std::uint32_t triangles_per_draw = 0;
    VertexLayout layout = VertexLayout::separate;
    PositionFormat position = PositionFormat::f32;
    std::string attributes = "normal:3f32";
    IndexWidth index = IndexWidth::automatic;
    std::uint32_t align = 4;
    std::uint64_t seed = 1;

    static constexpr auto fields() {
        using P = BlobParams;
        return std::tuple(
            sim::field<&P::triangles>("triangles; an odd number is rounded down").range(100, 40'000'000),
            sim::field<&P::bumps>("height of the bumps in radii; 0 = a sphere").range(0.0, 0.6),
            sim::field<&P::order>("order of the triangles: patches of neighbours, ring by ring, voxel by voxel as "
                                  "merged range scans have it, "
                                  "or none"),
            sim::field<&P::vertex_order>("order of the vertices in a draw: by first use, or none"),
            sim::field<&P::triangles_per_draw>(
                "triangles drawn with one draw call, with vertices of their own; 0 = all"),
            sim::field<&P::layout>(MeshFormatTexts::layout), sim::field<&P::position>(MeshFormatTexts::position),
            sim::field<&P::attributes>(MeshFormatTexts::attributes), sim::field<&P::index>(MeshFormatTexts::index),
            sim::field<&P::align>(MeshFormatTexts::align).unit("bytes").range(1, 4),
            sim::field<&P::seed>("of the bumps and of random orders"));
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

/// Cuts the triangles into draws, each with vertices of its own in the order of their first use: what lies together is
/// fetched together. Source: specification 004, A1.
std::vector<MeshPart> cut(Mesh& mesh, std::uint32_t triangles_per_draw) {
    const auto indices = static_cast<std::uint32_t>(mesh.indices.size());
    const std::uint32_t step = std::min(triangles_per_draw, indices / 3) * 3;
    std::vector<std::uint32_t> number(mesh.positions.size(), ~0U);
    Mesh sorted;
    std::vector<MeshPart> parts;
    for (std::uint32_t first = 0; first < indices; first += step) {
        MeshPart part{static_cast<std::uint32_t>(sorted.positions.size()), 0, first, std::min(step, indices - first)};
        for (std::uint32_t i = first; i < first + part.indices; ++i) {
            std::uint32_t& index = mesh.indices[i];
            if (number[index] == ~0U || number[index] < part.first_vertex) {
                number[index] = part.first_vertex + part.vertices++;
                sorted.positions.push_back(mesh.positions[index]);
                sorted.normals.push_back(mesh.normals[index]);
            }
            index = number[index];
        }
        parts.push_back(part);
    }
    mesh.positions = std::move(sorted.positions);
    mesh.normals = std::move(sorted.normals);
    return parts;
}

void shuffle_vertices(Mesh& mesh, const MeshPart& part, sim::Random& random) {
    std::vector<std::uint32_t> place(part.vertices);
    std::iota(place.begin(), place.end(), part.first_vertex);
    shuffle(place, random);
    const auto move_all = [&](std::vector<glm::vec3>& list) {
        const auto first = list.begin() + part.first_vertex;
        const std::vector<glm::vec3> before(first, first + part.vertices);
        for (std::uint32_t i = 0; i < part.vertices; ++i) list[place[i]] = before[i];
    };
    move_all(mesh.positions);
    move_all(mesh.normals);
    for (std::uint32_t i = part.first_index; i < part.first_index + part.indices; ++i)
        mesh.indices[i] = place[mesh.indices[i] - part.first_vertex];
}

void set_indices(Mesh& mesh, const std::vector<Triangle>& triangles) {
    mesh.indices.clear();
    for (const Triangle& triangle : triangles)
        mesh.indices.insert(mesh.indices.end(), triangle.corners.begin(), triangle.corners.end());
}

glm::dvec3 corner(const Mesh& mesh, const Triangle& triangle, std::size_t i) {
    return mesh.positions[triangle.corners[i]];
}

// An axis-aligned grid crosses a surface of area A in 1.5 A / h^2 of its edges on average over all directions, and each
// crossing is a vertex of the extracted surface. The triangles of this mesh are more regular than extracted ones, so
// its rows hold longer runs of neighbours; thinner rows make up for that: with 0.45 as many vertices are shaded per
// triangle as with the scanned Stanford dragon, 1.5 with a FIFO of 24 and 1.7 with one of 14.
double voxel_size(const Mesh& mesh, const std::vector<Triangle>& triangles) {
    double area = 0;
    for (const Triangle& triangle : triangles) {
        const glm::dvec3 a = corner(mesh, triangle, 0);
        area += glm::length(glm::cross(corner(mesh, triangle, 1) - a, corner(mesh, triangle, 2) - a)) / 2;
    }
    constexpr double thinner = 0.45;
    return thinner * std::sqrt(1.5 * area / static_cast<double>(mesh.positions.size()));
}

// Slice by slice along z, in a slice row by row along y, in a row along x.
void sort_by_voxels(const Mesh& mesh, std::vector<Triangle>& triangles) {
    const double size = voxel_size(mesh, triangles);
    constexpr double half_grid = 1 << 20;
    for (Triangle& triangle : triangles) {
        const glm::dvec3 centre =
            (corner(mesh, triangle, 0) + corner(mesh, triangle, 1) + corner(mesh, triangle, 2)) / 3.0;
        triangle.key = 0;
        for (const int axis : {2, 1, 0})
            triangle.key = triangle.key << 21U | static_cast<std::uint64_t>(centre[axis] / size + half_grid);
    }
    std::stable_sort(triangles.begin(), triangles.end(),
                     [](const Triangle& a, const Triangle& b) { return a.key < b.key; });
}

std::vector<Triangle> sorted_triangles(const Rings& rings, const Mesh& mesh, const BlobParams& params) {
    std::vector<Triangle> triangles = Sewing(rings).all();
    if (params.order == TriangleOrder::rows) return triangles; // as they were sewn
    if (params.order == TriangleOrder::voxels) {
        sort_by_voxels(mesh, triangles);
        return triangles;
    }
    std::stable_sort(triangles.begin(), triangles.end(),
                     [](const Triangle& a, const Triangle& b) { return a.key < b.key; });
    sim::Random random(params.seed, "blob order");
    if (params.order == TriangleOrder::random) shuffle(triangles, random);
    return triangles;
}

Scene build(const BlobParams& params) {
    const MeshFormat format = format_of(params, "gen:blob");
    const Rings rings(params.triangles);
    Mesh mesh;
    mesh.name = "blob";
    mesh.positions = positions_on(rings, Relief(params.bumps, params.seed));
    set_indices(mesh, sorted_triangles(rings, mesh, params));
    compute_normals(mesh);
    const auto parts = cut(mesh, params.triangles_per_draw == 0 ? params.triangles : params.triangles_per_draw);
    sim::Random random(params.seed, "blob vertices");
    if (params.vertex_order == VertexOrder::random)
        for (const MeshPart& part : parts) shuffle_vertices(mesh, part, random);
    Scene scene = scene_of_material("blob", {0.75F, 0.55F, 0.4F, 1.0F});
    add_draws(scene, mesh, parts, format, "gen:blob");
    return scene;
}

} // namespace

Generator blob_generator() {
    return make_generator<BlobParams>("blob", "a dense closed mesh with bumps, in place of a scanned figure", build);
}

} // namespace traces
