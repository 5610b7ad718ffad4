// Fragments that carry the cosine between their normal and the direction to the eye.
#include "pipeline/functional/front_end.hpp"
#include "pipeline/functional/shader.hpp"
#include "traces/camera.hpp"
#include "traces/scene.hpp"
#include "traces/view_rays.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace pipeline {
namespace {

/// Calls visit(x, y, depth, colour) for every fragment of draw 0.
void for_each_fragment(const traces::Scene& scene, const View& view,
                       const std::function<void(unsigned, unsigned, float, const glm::vec4&)>& visit) {
    FrontEndOptions options;
    options.fragment_colour = FragmentColour::cosine;
    options.both_faces = true;
    const std::vector<std::uint32_t> first{0};
    const FragmentStream stream = rasterize(*scene.resources, scene.draws, first, view, options);
    ASSERT_GT(stream.fragments, 1000U);
    for (std::size_t i = 0; i < stream.quads.size(); ++i)
        for (unsigned lane = 0; lane < 4; ++lane)
            if ((stream.quads[i].covered >> lane & 1U) != 0)
                visit(static_cast<unsigned>(stream.quads[i].x) + lane % 2,
                      static_cast<unsigned>(stream.quads[i].y) + lane / 2, stream.depths[i][lane],
                      stream.colours[i][lane]);
}

TEST(Cosine, OfASphereIsThatOfItsRadii) {
    const traces::Scene scene = traces::load_scene("gen:csg?segments=512");
    const View view = traces::make_view(scene, "0.4,0.2,4,0,0,0,40", 96, 96);
    const traces::ViewRays rays(view);
    const glm::dvec3 middle(view.view * glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
    for_each_fragment(scene, view, [&](unsigned x, unsigned y, float depth, const glm::vec4& colour) {
        const glm::dvec3 place = rays.place(x, y, rays.distance(depth));
        const double cosine = std::fabs(glm::dot(glm::normalize(place - middle), glm::normalize(place)));
        EXPECT_NEAR(static_cast<double>(colour.r), cosine, 0.01);
        EXPECT_EQ(colour.r, colour.g);
        EXPECT_EQ(colour.r, colour.b);
        EXPECT_EQ(colour.a, 1.0F);
    });
}

TEST(Cosine, WithoutVertexNormalsIsThatOfTheFace) {
    const traces::Scene scene = traces::load_scene("gen:tetrahedra?n=1"); // faces only, along and across the cube
    const View view = traces::make_view(scene, "0,0,3,0,0,0,20", 96, 96);
    const traces::ViewRays rays(view);
    std::size_t facing = 0, others = 0;
    for_each_fragment(scene, view, [&](unsigned x, unsigned y, float depth, const glm::vec4& colour) {
        const double distance = rays.distance(depth);
        const double to_axis = distance / glm::length(rays.place(x, y, distance));
        const bool front = std::fabs(distance - 2.5) < 1e-4;
        facing += front;
        others += !front;
        if (front) {
            EXPECT_NEAR(static_cast<double>(colour.r), to_axis, 1e-4);
        }
        EXPECT_TRUE(colour.r >= 0.0F && colour.r <= 1.0F);
    });
    EXPECT_GT(facing, 1000U);
    EXPECT_GT(others, 1000U);
}

TEST(Cosine, InAParallelProjectionTakesTheViewAxis) {
    const traces::Scene scene = traces::load_scene("gen:quads?n=1");
    const View view = traces::make_view(scene, "auto", 64, 64);
    for_each_fragment(scene, view,
                      [&](unsigned, unsigned, float, const glm::vec4& colour) { EXPECT_EQ(colour.r, 1.0F); });
}

TEST(Cosine, CostsItsOwnInstructionsAndReadsNoColour) {
    const traces::Scene sphere = traces::load_scene("gen:csg");
    const traces::Scene tetrahedra = traces::load_scene("gen:tetrahedra?n=1");
    Needs needs;
    needs.colours = needs.normals = true;
    needs.fragment_colour = FragmentColour::cosine;
    const ShaderCost smooth = shader_cost(sphere.resources->materials[0], sphere.resources->geometries[0], needs);
    EXPECT_EQ(smooth.alu, 9U);
    EXPECT_EQ(smooth.registers, 3U);
    const ShaderCost flat = shader_cost(tetrahedra.resources->materials[0], tetrahedra.resources->geometries[0], needs);
    EXPECT_EQ(flat.alu, 12U);
    EXPECT_EQ(flat.registers, 4U);
}

} // namespace
} // namespace pipeline
