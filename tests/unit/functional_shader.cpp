// Interpolation, lighting, alpha test, declared cost: what a fragment's colour is made of.
#include "pipeline/functional/interpolation.hpp"
#include "pipeline/functional/number_formats.hpp"
#include "pipeline/functional/shader.hpp"
#include "sim/random.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace pipeline {
namespace {

using tests::FunctionalScene;
using tests::MeshData;

template <class Visit>
void for_each_covered(const FragmentStream& stream, Visit&& visit) {
    for (std::size_t i = 0; i < stream.quads.size(); ++i)
        for (std::size_t lane = 0; lane < 4; ++lane)
            if (((stream.quads[i].covered >> lane) & 1U) != 0)
                visit(stream.quads[i].x + static_cast<unsigned>(lane % 2),
                      stream.quads[i].y + static_cast<unsigned>(lane / 2), i, lane);
}

TEST(Interpolation, ScreenSpaceIsLinearInParallelProjection) {
    FunctionalScene scene(64, 64);
    MeshData mesh = tests::rectangle(0, 0, 64, 64);
    mesh.positions[1].z = mesh.positions[3].z = 1.0F; // depth 0.5 to 1 from left to right
    mesh.colours = {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 0, 1}};
    scene.add(mesh);
    const FragmentStream stream = scene.rasterize();
    for_each_covered(stream, [&](unsigned x, unsigned y, std::size_t quad, std::size_t lane) {
        const float u = (static_cast<float>(x) + 0.5F) / 64.0F, v = (static_cast<float>(y) + 0.5F) / 64.0F;
        EXPECT_FLOAT_EQ(stream.depths[quad][lane], 0.5F + 0.5F * u);
        EXPECT_NEAR(stream.colours[quad][lane].r, u, 1e-6F);
        EXPECT_NEAR(stream.colours[quad][lane].g, v, 1e-6F);
    });
}

TEST(Interpolation, IsPerspectiveCorrect) {
    // A floor with its world z as colour: at every pixel the colour must be the z that the pixel's ray meets.
    FunctionalScene scene(128, 128);
    scene.view.projection = glm::perspective(glm::radians(90.0F), 1.0F, 0.5F, 200.0F);
    MeshData mesh;
    mesh.positions = {{-400, -1, -1}, {400, -1, -1}, {-400, -1, -100}, {400, -1, -100}};
    mesh.indices = {0, 1, 2, 2, 1, 3};
    for (const glm::vec3& position : mesh.positions) mesh.colours.emplace_back(-position.z, 0, 0, 1);
    scene.add(mesh);
    const FragmentStream stream = scene.rasterize();
    EXPECT_GT(stream.fragments, 7000U);
    for_each_covered(stream, [&](unsigned, unsigned y, std::size_t quad, std::size_t lane) {
        const double expected = 1.0 / ((static_cast<double>(y) + 0.5 - 64.0) / 64.0);
        EXPECT_NEAR(stream.colours[quad][lane].r, expected, 4e-3 * expected);
    });
}

RC_GTEST_PROP(Interpolation, NeverLeavesTheRangeOfTheCorners, (std::uint64_t seed)) {
    sim::Random random(seed, "range");
    FunctionalScene scene(48, 48);
    scene.view.projection = glm::perspective(glm::radians(70.0F), 1.0F, 0.01F, 100.0F);
    MeshData mesh;
    for (int i = 0; i < 30; ++i) { // many slivers
        const double depth = -0.001 - 5.0 * random.uniform();
        const glm::dvec3 base((random.uniform() - 0.5) * 3.0, (random.uniform() - 0.5) * 3.0, depth);
        const double thin = std::exp2(-20.0 * random.uniform());
        mesh.positions.emplace_back(base);
        mesh.positions.emplace_back(base + glm::dvec3(random.uniform(), random.uniform(), -random.uniform()));
        mesh.positions.emplace_back(base + thin * glm::dvec3(random.uniform(), random.uniform(), random.uniform()));
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.colours.emplace_back(random.uniform() < 0.5 ? 0.25F : 0.75F, 0.5F, 0, 1);
    scene.add(mesh);
    const FragmentStream stream = scene.rasterize();
    for_each_covered(stream, [&](unsigned, unsigned, std::size_t quad, std::size_t lane) {
        const glm::vec4& colour = stream.colours[quad][lane];
        RC_ASSERT(colour.r >= 0.25F - 1e-6F && colour.r <= 0.75F + 1e-6F);
        RC_ASSERT(std::fabs(colour.g - 0.5F) < 1e-6F);
    });
    for (const auto& depths : stream.depths)
        for (const float depth : depths) RC_ASSERT(depth >= 0.0F && depth <= 1.0F);
}

TEST(Lighting, FacesTheCameraFullyAndIsTwoSided) {
    Material lit;
    lit.double_sided = true;
    lit.base_colour = glm::vec4(0.5F, 0.25F, 1.0F, 1.0F);
    for (const float direction : {1.0F, -1.0F}) {
        FunctionalScene scene(8, 8);
        MeshData mesh = tests::rectangle(0, 0, 8, 8);
        mesh.normals.assign(4, glm::vec3(0, 0, 3.0F * direction)); // length does not matter
        scene.add(mesh, scene.add_material(lit));
        EXPECT_EQ(scene.rasterize().colours.at(0)[0], lit.base_colour);
    }
}

TEST(Lighting, IsAmbientOnSurfacesSeenEdgeOn) {
    FunctionalScene scene(8, 8);
    MeshData mesh = tests::rectangle(0, 0, 8, 8);
    mesh.normals.assign(4, glm::vec3(1, 0, 0));
    Material lit;
    lit.double_sided = true;
    scene.add(mesh, scene.add_material(lit));
    EXPECT_EQ(scene.rasterize().colours.at(0)[0], glm::vec4(glm::vec3(ambient_light), 1.0F));
}

TEST(Lighting, WithoutNormalsTheFaceHasOne) {
    FunctionalScene scene(8, 8);
    MeshData mesh = tests::rectangle(0, 0, 8, 8);
    mesh.positions[1].z = mesh.positions[3].z = 0.5F + 8.0F / 256.0F; // rises 1/256 per pixel
    Material lit;
    lit.double_sided = true;
    scene.add(mesh, scene.add_material(lit));
    const float cosine = 1.0F / std::sqrt(1.0F + 1.0F / 65536.0F);
    EXPECT_NEAR(scene.rasterize().colours.at(0)[0].r, ambient_light + (1.0F - ambient_light) * cosine, 1e-6F);
}

TEST(Lighting, NormalsGoThroughTheInverseTranspose) {
    // A plane at 45 degrees, squeezed to a tenth in z: its normal turns towards z.
    FunctionalScene scene(8, 8);
    MeshData mesh = tests::rectangle(0, 0, 8, 8, 0.0F);
    mesh.normals.assign(4, glm::normalize(glm::vec3(1, 0, 1)));
    Material lit;
    lit.double_sided = true;
    scene.add(mesh, scene.add_material(lit), glm::scale(glm::mat4(1.0F), glm::vec3(1, 1, 0.1F)));
    const float cosine = 10.0F / std::sqrt(101.0F);
    EXPECT_NEAR(scene.rasterize().colours.at(0)[0].r, ambient_light + (1.0F - ambient_light) * cosine, 1e-6F);
}

TEST(Lighting, NormalsOfNoLengthAndSingularMatricesAreHarmless) {
    FunctionalScene scene(8, 8);
    MeshData mesh = tests::rectangle(0, 0, 8, 8, 0.0F);
    mesh.normals.assign(4, glm::vec3(0));
    mesh.normals[1] = glm::vec3(std::nanf(""), 1e38F, -1e38F);
    Material lit;
    lit.double_sided = true;
    scene.add(mesh, scene.add_material(lit), glm::scale(glm::mat4(1.0F), glm::vec3(1, 1, 0)));
    const FragmentStream stream = scene.rasterize();
    EXPECT_EQ(stream.fragments, 64U);
    for_each_covered(stream, [&](unsigned, unsigned, std::size_t quad, std::size_t lane) {
        EXPECT_TRUE(stream.colours[quad][lane].r >= 0.0F && stream.colours[quad][lane].r <= 1.0F);
    });
}

TEST(Shading, MultipliesBaseVertexAndTextureColours) {
    FunctionalScene scene(8, 8);
    MeshData mesh = tests::rectangle(0, 0, 8, 8);
    mesh.colours.assign(4, glm::vec4(0.5F, 1.0F, 0.25F, 0.5F));
    Material material;
    material.unlit = true;
    material.double_sided = true;
    material.alpha_mode = AlphaMode::blend;
    material.base_colour = glm::vec4(1.0F, 0.5F, 1.0F, 0.5F);
    material.base_texture =
        static_cast<std::int32_t>(scene.add_texture(tests::texture_of_one_colour(4, 4, 0xFF8000FF)));
    scene.add(mesh, scene.add_material(material));
    const FragmentStream stream = scene.rasterize();
    const glm::vec4 expected(0.5F, 0.5F * srgb_decode_table()[128], 0.0F, 0.25F);
    EXPECT_EQ(stream.colours.at(0)[0], expected);
    EXPECT_NE(stream.texture_lines.at(0), ~0U);
}

TEST(Shading, OpaqueSurfacesHaveAlphaOne) {
    FunctionalScene scene(8, 8);
    Material material = scene.resources.materials[0];
    material.base_colour.a = 0.3F;
    scene.add(tests::rectangle(0, 0, 8, 8), scene.add_material(material));
    EXPECT_EQ(scene.rasterize().colours.at(0)[0].a, 1.0F);
}

TEST(Shading, PixelsThatAreNotCoveredAreBlack) {
    FunctionalScene scene(8, 8);
    scene.add(tests::rectangle(1, 1, 2, 2));
    const FragmentStream stream = scene.rasterize();
    ASSERT_EQ(stream.quads.size(), 1U);
    EXPECT_EQ(stream.quads[0].covered, 8);
    EXPECT_EQ(stream.colours[0][0], glm::vec4(0.0F));
    EXPECT_EQ(stream.colours[0][3], glm::vec4(1.0F));
}

/// Fragments that survive the alpha test at this alpha and cutoff.
FragmentStream alpha_tested(float alpha, float cutoff, const FrontEndOptions& options = {}) {
    FunctionalScene scene(8, 8);
    Material material = scene.resources.materials[0];
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = cutoff;
    material.base_colour.a = alpha;
    scene.add(tests::rectangle(0, 0, 8, 8), scene.add_material(material));
    return scene.rasterize(options);
}

TEST(AlphaTest, AlphaEqualToTheCutoffIsDrawn) {
    EXPECT_EQ(alpha_tested(0.5F, 0.5F).fragments_discarded, 0U);
    EXPECT_EQ(alpha_tested(std::nextafter(0.5F, 0.0F), 0.5F).fragments_discarded, 64U);
    EXPECT_EQ(alpha_tested(0.0F, 0.0F).fragments_discarded, 0U);
    EXPECT_EQ(alpha_tested(1.0F, 1.1F).fragments_discarded, 64U);
    EXPECT_EQ(alpha_tested(0.7F, 0.5F).colours.at(0)[0].a, 1.0F); // what is left is opaque
}

TEST(AlphaTest, TexelAlphaEqualToTheCutoffIsDrawn) {
    // Interpolated coordinates and bilinear weights must not disturb a constant alpha.
    FunctionalScene scene(16, 16);
    Material material = scene.resources.materials[0];
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = 51.0F / 255.0F;
    material.base_texture =
        static_cast<std::int32_t>(scene.add_texture(tests::texture_of_one_colour(5, 3, 0xFFFFFF33)));
    scene.add(tests::rectangle(0.3F, 0.7F, 15.1F, 14.9F), scene.add_material(material));
    const FragmentStream stream = scene.rasterize();
    EXPECT_GT(stream.fragments, 0U);
    EXPECT_EQ(stream.fragments_discarded, 0U);
}

TEST(AlphaTest, VertexAlphaEqualToTheCutoffIsDrawn) {
    for (const float alpha : {0.1F, 0.3F, 0.7F}) {
        FunctionalScene scene(64, 64);
        scene.view.projection = glm::perspective(glm::radians(70.0F), 1.0F, 0.1F, 100.0F);
        Material material = scene.resources.materials[0];
        material.alpha_mode = AlphaMode::mask;
        material.alpha_cutoff = alpha;
        MeshData mesh;
        mesh.positions = {{-1, -1, -1}, {2, -0.7F, -3}, {-0.3F, 2, -7}};
        mesh.colours.assign(3, glm::vec4(1, 1, 1, alpha));
        scene.add(mesh, scene.add_material(material));
        const FragmentStream stream = scene.rasterize();
        EXPECT_GT(stream.fragments, 100U);
        EXPECT_EQ(stream.fragments_discarded, 0U);
    }
}

TEST(AlphaTest, WorksWithoutColoursAndCanBeLeftOut) {
    FrontEndOptions options;
    options.colours = false;
    EXPECT_EQ(alpha_tested(0.2F, 0.5F, options).fragments_discarded, 64U);
    EXPECT_TRUE(alpha_tested(0.2F, 0.5F, options).colours.empty());
    options.alpha_test = false;
    EXPECT_EQ(alpha_tested(0.2F, 0.5F, options).fragments_discarded, 0U);
}

TEST(Shading, MipLevelsComeFromTheQuadAlsoAtEdges) {
    // Each texel is a pixel; the texture's levels differ in colour. Thin triangles whose quads are mostly helper pixels
    // must still find level 0.
    FunctionalScene scene(32, 32);
    Texture texture = tests::texture_of_one_colour(32, 32, 0xFF0000FF);
    texture.levels.push_back(tests::texture_of_one_colour(16, 16, 0x00FF00FF).levels[0]);
    Material material = scene.resources.materials[0];
    material.base_texture = static_cast<std::int32_t>(scene.add_texture(texture));
    MeshData mesh;
    mesh.positions = {{0, 0, 0.5F}, {32, 30.4F, 0.5F}, {32, 32, 0.5F}};
    for (const glm::vec3& position : mesh.positions)
        mesh.texcoords.emplace_back(position.x / 32.0F, position.y / 32.0F);
    scene.add(mesh, scene.add_material(material));
    const FragmentStream stream = scene.rasterize();
    EXPECT_GT(stream.fragments, 10U);
    for_each_covered(stream, [&](unsigned, unsigned, std::size_t quad, std::size_t lane) {
        EXPECT_EQ(stream.colours[quad][lane], glm::vec4(1, 0, 0, 1));
    });
}

TEST(Shading, DegenerateAndNotFiniteTexcoordsAreHarmless) {
    for (const float bad : {0.0F, std::nanf(""), INFINITY, -INFINITY, 3e38F}) {
        FunctionalScene scene(16, 16);
        Texture texture = tests::texture_of_one_colour(5, 3, 0xFF0000FF);
        texture.min_filter = Filter::linear_mip_linear;
        texture.make_mips();
        Material material = scene.resources.materials[0];
        material.base_texture = static_cast<std::int32_t>(scene.add_texture(texture));
        MeshData mesh = tests::rectangle(0, 0, 16, 16);
        for (glm::vec2& texcoord : mesh.texcoords) texcoord = glm::vec2(bad);
        mesh.texcoords[1] = glm::vec2(0.5F, bad);
        scene.add(mesh, scene.add_material(material));
        const FragmentStream stream = scene.rasterize();
        for_each_covered(stream, [&](unsigned, unsigned, std::size_t quad, std::size_t lane) {
            EXPECT_EQ(stream.colours[quad][lane], glm::vec4(1, 0, 0, 1));
        });
    }
}

TEST(Shading, TexcoordTransformOfTheMaterialIsApplied) {
    FunctionalScene scene(8, 8);
    Texture texture = tests::texture_of(2, 1, {0xFF0000FF, 0x00FF00FF});
    texture.mag_filter = Filter::nearest;
    Material material = scene.resources.materials[0];
    material.base_texture = static_cast<std::int32_t>(scene.add_texture(texture));
    material.uv_transform[2] = glm::vec3(0.5F, 0.0F, 1.0F); // moves u by half
    scene.add(tests::rectangle(0, 0, 8, 8), scene.add_material(material));
    EXPECT_EQ(scene.rasterize().colours.at(0)[0], glm::vec4(0, 1, 0, 1));
}

TEST(Shading, FlatColoursAreThoseOfTheMaterialWhateverTheGeometryHas) {
    FunctionalScene scene(8, 8);
    tests::MeshData mesh = tests::rectangle(0, 0, 8, 8);
    mesh.normals.assign(4, {1, 0, 0}); // seen edge-on
    mesh.colours.assign(4, {0.5F, 0.5F, 0.5F, 0.1F});
    Material material;
    material.double_sided = true;
    material.base_colour = {0.25F, 0.5F, 0.75F, 1.0F};
    material.alpha_mode = AlphaMode::mask;
    material.base_texture = static_cast<std::int32_t>(scene.add_texture(tests::texture_of_one_colour(1, 1, 0)));
    scene.add(mesh, scene.add_material(material));
    FrontEndOptions options;
    options.fragment_colour = FragmentColour::flat;
    const FragmentStream stream = scene.rasterize(options);
    EXPECT_EQ(stream.fragments, 64U);
    EXPECT_EQ(stream.fragments_discarded, 0U);
    for_each_covered(stream, [&](unsigned, unsigned, std::size_t quad, std::size_t lane) {
        EXPECT_EQ(stream.colours[quad][lane], material.base_colour);
    });
    EXPECT_EQ(scene.rasterize().fragments_discarded, 64U); // the alpha of the others is 0
}

TEST(ShaderCost, GrowsWithWhatTheShaderUses) {
    Needs needs;
    needs.colours = needs.textures = needs.normals = needs.vertex_colours = needs.alpha_test = true;
    Geometry bare;
    bare.attributes = {VertexAttribute{}};
    Geometry full = bare;
    for (const Semantic semantic : {Semantic::normal, Semantic::colour, Semantic::texcoord0}) {
        VertexAttribute attribute;
        attribute.semantic = semantic;
        full.attributes.push_back(attribute);
    }
    Material unlit;
    unlit.unlit = true;
    Material textured;
    textured.base_texture = 0;
    textured.alpha_mode = AlphaMode::mask;

    const auto cost = [&](const Material& material, const Geometry& geometry) {
        return shader_cost(material, geometry, needs);
    };
    EXPECT_EQ(cost(unlit, bare).alu, 1U);
    EXPECT_EQ(cost(unlit, full).alu, 3U);       // vertex colour
    EXPECT_EQ(cost(Material{}, bare).alu, 10U); // face normal
    EXPECT_EQ(cost(Material{}, full).alu, 9U);  // vertex colour and normal
    EXPECT_EQ(cost(textured, full).alu, 13U);   // and texture and alpha test
    EXPECT_EQ(cost(textured, full).textures, 1U);
    EXPECT_EQ(cost(textured, bare).textures, 0U); // nothing to look it up with
    EXPECT_EQ(cost(textured, full).registers, 5U);
    needs = Needs{};
    EXPECT_EQ(cost(textured, full).alu, 1U); // depth only
    needs.colours = true;
    needs.fragment_colour = FragmentColour::flat;
    EXPECT_EQ(cost(textured, full).alu, 1U);
    EXPECT_EQ(cost(textured, full).textures, 0U);
}

} // namespace
} // namespace pipeline
