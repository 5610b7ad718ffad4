// Coverage, depth, blending and counters against Mesa's llvmpipe.
//
// Both get the same vertices and the same matrix. Triangles that lie within the screen must agree in every pixel.
#include "pipeline/functional/clip.hpp"
#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/functional/front_end.hpp"
#include "pipeline/functional/vertex_transform.hpp"
#include "sim/random.hpp"
#include "tests/support/mesa_fixture.hpp"
#include "tests/support/mesa_scenes.hpp"

#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>
#include <set>

namespace tests {
namespace {

using pipeline::FragmentStream;
using pipeline::Quad;

OwnPicture nearest_fragments(const FragmentStream& stream) {
    OwnPicture picture;
    picture.id.resize(std::size_t{stream.width} * stream.height);
    picture.depth.assign(picture.id.size(), 1.0F);
    for_each_fragment(stream, [&](std::size_t pixel, std::size_t quad, std::size_t lane) {
        const float depth = stream.depths[quad][lane];
        if (!(depth < picture.depth[pixel])) return;
        picture.depth[pixel] = depth;
        picture.id[pixel] = primitive_of(stream, stream.quads[quad]) + 1;
    });
    return picture;
}

/// 4x4-aligned blocks of pixels that each triangle covers a pixel of, summed.
std::uint64_t count_blocks(const FragmentStream& stream) {
    std::uint64_t blocks = 0;
    for (const pipeline::Triangle& triangle : stream.triangles) {
        std::set<std::pair<int, int>> touched;
        for (std::uint32_t i = 0; i < triangle.quads; ++i) {
            const Quad& quad = stream.quads[triangle.first_quad + i];
            touched.emplace(quad.x / 4, quad.y / 4);
        }
        blocks += touched.size();
    }
    return blocks;
}

std::vector<glm::vec4> random_colours(std::size_t count) {
    sim::Random random(7, "colours");
    std::vector<glm::vec4> colours(count);
    for (glm::vec4& colour : colours)
        for (int channel = 0; channel < 4; ++channel) colour[channel] = static_cast<float>(random.uniform());
    return colours;
}

/// Corners of a triangle on the screen: pixels and depth.
std::array<glm::dvec3, 3> corners_of(const TriangleScene& scene, std::uint32_t triangle) {
    const pipeline::Viewport viewport(scene.width, scene.height);
    std::array<glm::dvec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec3& position = scene.positions[scene.indices[triangle * 3 + i]];
        const auto vertex = pipeline::transform_vertex(scene.matrix, viewport, glm::vec4(position, 1.0F));
        corners[i] = glm::dvec3(vertex.window, vertex.depth);
    }
    return corners;
}

/// Difference of two depths of one triangle in units of D24. Mesa's may lie beyond the triangle's corners, where the
/// pixel centre is inside only because of snapping; that excess does not count.
double depth_units(const std::array<glm::dvec3, 3>& corners, float own, float mesa) {
    const auto [least, greatest] = std::minmax({corners[0].z, corners[1].z, corners[2].z});
    return std::fabs(static_cast<double>(own) - std::clamp(static_cast<double>(mesa), least, greatest)) * 16777215.0;
}

/// What depths may differ by: 2 units of D24, and the rounding of Mesa's plane equation, whose single-precision terms
/// count from pixel (0, 0) and whose slopes are differences of products.
double depth_tolerance(const TriangleScene& scene, const std::array<glm::dvec3, 3>& corners) {
    const glm::dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
    const double area = std::fabs(a.x * b.y - b.x * a.y);
    const double slope_x = (std::fabs(a.z * b.y) + std::fabs(b.z * a.y)) / area;
    const double slope_y = (std::fabs(b.z * a.x) + std::fabs(a.z * b.x)) / area;
    constexpr double roundings = 4.0;
    return 2.0 + roundings * (slope_x * scene.width + slope_y * scene.height);
}

class MesaRasterization : public ExactMesaTest {
  protected:
    static void expect_equal_coverage(const TriangleScene& scene) {
        SCOPED_TRACE(scene.name);
        const FragmentStream stream = rasterize_scene(scene);
        const OwnPicture own = count_fragments(stream);
        const MesaPicture mesa = renderer_->render(scene, MesaMode::count);
        std::size_t wrong_counts = 0, wrong_ids = 0;
        for (std::size_t i = 0; i < own.count.size(); ++i) {
            wrong_counts += static_cast<float>(own.count[i]) != mesa.colour[i].r ? 1U : 0U;
            wrong_ids += own.id[i] != mesa.id[i] ? 1U : 0U;
        }
        EXPECT_GT(stream.fragments, 0U);
        EXPECT_EQ(wrong_counts, 0U);
        EXPECT_EQ(wrong_ids, 0U);
        EXPECT_EQ(stream.fragments, mesa.samples_passed);
        EXPECT_EQ(count_blocks(stream) * 16, mesa.fs_invocations);
    }

    /// Returns the number of pixels that show another triangle: 0, but for ties within the rounding of Mesa's depth.
    static std::size_t expect_equal_visibility(const TriangleScene& scene) {
        SCOPED_TRACE(scene.name);
        const FragmentStream stream = rasterize_scene(scene);
        const OwnPicture own = nearest_fragments(stream);
        const MesaPicture mesa = renderer_->render(scene, MesaMode::nearest);
        std::size_t ties = 0, unexplained_ids = 0, wrong_depths = 0, visible = 0, over_two_units = 0;
        for (std::size_t i = 0; i < own.id.size(); ++i) {
            if (own.id[i] == 0 && mesa.id[i] == 0) continue;
            ++visible;
            if (own.id[i] == 0 || mesa.id[i] == 0) {
                ++unexplained_ids;
                continue;
            }
            const auto corners = corners_of(scene, mesa.id[i] - 1);
            const double units = depth_units(corners, own.depth[i], mesa.depth[i]);
            const bool close = units <= depth_tolerance(scene, corners);
            over_two_units += units > 2.0 ? 1U : 0U;
            if (own.id[i] == mesa.id[i]) {
                wrong_depths += close ? 0U : 1U;
            } else {
                (close ? ties : unexplained_ids) += 1;
            }
        }
        EXPECT_EQ(unexplained_ids, 0U);
        EXPECT_EQ(wrong_depths, 0U);
        fmt::print("{}: {} of {} pixels differ by more than 2 units of D24, {} ties show another triangle\n",
                   scene.name, over_two_units, visible, ties);
        return ties;
    }
};

TEST_F(MesaRasterization, CoverageOfRandomTrianglesIsEqual) {
    expect_equal_coverage(random_soup(20000, 2.0, 1));
    expect_equal_coverage(random_soup(20000, 12.0, 2));
    expect_equal_coverage(random_soup(4000, 60.0, 3));
}

TEST_F(MesaRasterization, CoverageOfTrianglesWithTiesIsEqual) {
    for (const std::uint32_t grid : {1U, 2U, 4U, 256U}) expect_equal_coverage(random_soup(20000, 8.0, 4, grid));
}

TEST_F(MesaRasterization, CoverageInPerspectiveIsEqual) {
    expect_equal_coverage(sphere_grid(3, 16, 24));
    expect_equal_coverage(sphere_grid(2, 100, 100));
}

TEST_F(MesaRasterization, VisibilityIsEqual) {
    EXPECT_EQ(expect_equal_visibility(random_soup(20000, 12.0, 5)), 0U);
    EXPECT_EQ(expect_equal_visibility(random_soup(4000, 60.0, 6)), 0U);
    EXPECT_EQ(expect_equal_visibility(sphere_grid(3, 16, 24)), 0U);
    EXPECT_EQ(expect_equal_visibility(sphere_grid(2, 100, 100)), 0U);
}

class MesaRasterizationOfMesh : public MesaRasterization, public testing::WithParamInterface<const char*> {};

TEST_P(MesaRasterizationOfMesh, CoverageAndVisibilityAreEqual) {
    const auto scene = mesh_scene(GetParam());
    if (!scene) GTEST_SKIP() << GetParam() << " is not there: ROPSIM_SHARED_DIR names no folder with it";
    expect_equal_coverage(*scene);
    // Neighbouring triangles of a silhouette may have the same depth, to the last bits, at a pixel on their common
    // edge.
    const std::size_t ties = expect_equal_visibility(*scene);
    EXPECT_LE(ties, 20U);
}

INSTANTIATE_TEST_SUITE_P(Meshes, MesaRasterizationOfMesh,
                         testing::Values("scenes/stanford_bunny/stanford_bunny.glb", "scenes/suzanne/Suzanne.gltf",
                                         "scenes/utah_teapot/utah_teapot.glb",
                                         "scenes/stanford_dragon/stanford_dragon.gltf"),
                         [](const auto& parameter) { return std::filesystem::path(parameter.param).stem().string(); });

TEST_F(MesaRasterization, BackFaceCullingIsEqual) {
    const TriangleScene scene = sphere_grid(3, 16, 24);
    const OwnPicture own = count_fragments(rasterize_scene(scene, false));
    const MesaPicture mesa = renderer_->render(scene, MesaMode::count, {}, true);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < own.count.size(); ++i)
        wrong += static_cast<float>(own.count[i]) != mesa.colour[i].r ? 1U : 0U;
    EXPECT_EQ(wrong, 0U);
}

TEST_F(MesaRasterization, OrderedBlendingInFloatIsBitExact) {
    const TriangleScene scene = random_soup(20000, 12.0, 8);
    const std::vector<glm::vec4> colours = random_colours(scene.indices.size() / 3);
    const FragmentStream stream = rasterize_scene(scene);
    std::vector<glm::vec4> own(std::size_t{scene.width} * scene.height, glm::vec4(0.0F));
    for_each_fragment(stream, [&](std::size_t pixel, std::size_t quad, std::size_t) {
        own[pixel] = blended(pipeline::blends::over(), colours[primitive_of(stream, stream.quads[quad])], own[pixel]);
    });
    const MesaPicture mesa = renderer_->render(scene, MesaMode::blend, colours);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < own.size(); ++i) wrong += own[i] != mesa.colour[i] ? 1U : 0U;
    EXPECT_EQ(wrong, 0U);
}

/// Pixels within `reach` pixels of a line segment are marked.
void mark_near(const glm::dvec2& from, const glm::dvec2& to, double reach, std::uint32_t width, std::uint32_t height,
               std::vector<bool>& marked) {
    const glm::dvec2 low = glm::min(from, to) - reach, high = glm::max(from, to) + reach;
    const auto first = [](double v) { return static_cast<std::uint32_t>(std::max(v, 0.0)); };
    const glm::dvec2 along = to - from;
    for (std::uint32_t y = first(low.y); y < height && y <= high.y; ++y)
        for (std::uint32_t x = first(low.x); x < width && x <= high.x; ++x) {
            const glm::dvec2 pixel(x, y);
            const double length = glm::dot(along, along);
            const double t = length > 0.0 ? std::clamp(glm::dot(pixel - from, along) / length, 0.0, 1.0) : 0.0;
            if (glm::distance(pixel, from + t * along) <= reach) marked[std::size_t{y} * width + x] = true;
        }
}

/// Pixels near an edge of a triangle that leaves the view volume, cut edges included.
std::vector<bool> near_clipped_edges(const TriangleScene& scene) {
    const pipeline::Viewport viewport(scene.width, scene.height);
    std::vector<bool> marked(std::size_t{scene.width} * scene.height);
    for (std::size_t i = 0; i < scene.indices.size(); i += 3) {
        std::array<pipeline::ScreenVertex, 3> vertices;
        for (std::size_t k = 0; k < 3; ++k)
            vertices[k] = pipeline::transform_vertex(scene.matrix, viewport,
                                                     glm::vec4(scene.positions[scene.indices[i + k]], 1.0F));
        if (((vertices[0].outside | vertices[1].outside | vertices[2].outside) & pipeline::outside::view_volume) == 0)
            continue;
        const auto polygon = clip_triangle(viewport, {.vertices = {&vertices[0], &vertices[1], &vertices[2]}});
        for (std::uint32_t k = 0; k < polygon.count; ++k) {
            const auto from = screen_vertex(viewport, polygon.corners[k]);
            const auto to = screen_vertex(viewport, polygon.corners[(k + 1) % polygon.count]);
            mark_near(from.window, to.window, 1.0, scene.width, scene.height, marked);
        }
    }
    return marked;
}

TEST_F(MesaRasterization, ClippedTrianglesDifferOnlyAtTheirEdges) {
    // Mesa cuts at the screen's edges too, and the corners it makes there snap to other places.
    std::size_t different = 0, fragments = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const TriangleScene scene = clipped_soup(30, 150.0, seed);
        const FragmentStream stream = rasterize_scene(scene);
        const OwnPicture own = count_fragments(stream);
        const MesaPicture mesa = renderer_->render(scene, MesaMode::count);
        const std::vector<bool> explained = near_clipped_edges(scene);
        std::size_t unexplained = 0;
        for (std::size_t i = 0; i < own.count.size(); ++i) {
            if (static_cast<float>(own.count[i]) == mesa.colour[i].r) continue;
            ++different;
            unexplained += explained[i] ? 0U : 1U;
        }
        EXPECT_EQ(unexplained, 0U) << "seed " << seed;
        fragments += stream.fragments;
    }
    fmt::print("{} pixels of {} fragments differ\n", different, fragments);
    EXPECT_LT(static_cast<double>(different), 1e-4 * static_cast<double>(fragments));
}

} // namespace
} // namespace tests
