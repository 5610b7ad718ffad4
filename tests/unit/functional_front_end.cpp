// rasterize() as a whole: what the stream holds, the same for any number of threads.
#include "pipeline/functional/front_end.hpp"
#include "sim/check.hpp"
#include "sim/random.hpp"
#include "tests/support/functional_scene.hpp"

#include <atomic>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck/gtest.h>

namespace pipeline {
namespace {

using tests::FunctionalScene;
using tests::MeshData;

/// Several draws with everything: textures, masks, normals, colours, instances, clipped and culled primitives.
FunctionalScene busy_scene(std::uint64_t seed, std::uint32_t triangles) {
    sim::Random random(seed, "busy scene");
    FunctionalScene scene(150, 110);
    scene.view.projection = glm::perspective(glm::radians(60.0F), 150.0F / 110.0F, 0.5F, 50.0F);
    Texture texture = tests::texture_of(3, 2, {0xFF0000FF, 0x00FF0080, 0x0000FF20, 0xFFFFFFFF, 0x80808080, 0x00000000});
    texture.make_mips();
    Material textured;
    textured.alpha_mode = AlphaMode::mask;
    textured.base_texture = static_cast<std::int32_t>(scene.add_texture(texture));
    Material glass;
    glass.alpha_mode = AlphaMode::blend;
    glass.double_sided = true;
    const std::array<std::uint32_t, 3> materials{0, scene.add_material(textured), scene.add_material(glass)};
    for (std::size_t draw = 0; draw < 3; ++draw) {
        MeshData mesh;
        for (std::uint32_t i = 0; i < triangles; ++i) {
            const glm::vec3 centre(random.uniform() * 12 - 6, random.uniform() * 8 - 4, 1.0 - random.uniform() * 12);
            for (int corner = 0; corner < 3; ++corner) {
                const glm::vec3 offset(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
                mesh.positions.push_back(centre + offset * 2.0F);
                mesh.texcoords.emplace_back(random.uniform() * 4 - 2, random.uniform() * 4 - 2);
                mesh.normals.push_back(offset);
                mesh.colours.emplace_back(random.uniform(), random.uniform(), random.uniform(), 1);
            }
        }
        if (draw == 1) mesh.normals.clear();
        if (draw == 2) mesh.texcoords.clear();
        const std::uint32_t number = scene.add(mesh, materials[draw]);
        scene.draws[number].instances.push_back(glm::translate(glm::mat4(1.0F), glm::vec3(1, 0, -3)));
        scene.draws[number].instances.push_back(glm::scale(glm::mat4(1.0F), glm::vec3(-1, 1, 1)));
    }
    return scene;
}

TEST(FrontEnd, TheResultIsTheSameForAnyNumberOfThreads) {
    FunctionalScene scene = busy_scene(1, 3000);
    FrontEndOptions options;
    options.threads = 1;
    const FragmentStream alone = scene.rasterize(options);
    EXPECT_GT(alone.fragments_discarded, 0U);
    for (const unsigned threads : {2U, 3U, 0U}) {
        options.threads = threads;
        EXPECT_TRUE(tests::equal(alone, scene.rasterize(options))) << threads << " threads";
    }
}

RC_GTEST_PROP(FrontEnd, CountsAndRangesAreConsistent, (std::uint64_t seed)) {
    FunctionalScene scene = busy_scene(seed, 40);
    const FragmentStream stream = scene.rasterize();
    std::uint64_t covered = 0, dead = 0;
    std::size_t triangle = 0, quad = 0, primitive = 0;
    for (const DrawRange& range : stream.draws) {
        RC_ASSERT(range.first_primitive == primitive);
        RC_ASSERT(range.first_quad == quad);
        for (std::uint32_t i = 0; i < range.primitives; ++i, ++primitive) {
            const Primitive& p = stream.primitives[primitive];
            RC_ASSERT(p.first_triangle == triangle);
            RC_ASSERT((p.fate == PrimitiveFate::drawn) == (p.triangles > 0));
            RC_ASSERT(p.triangles <= 7 && (p.clipped || p.triangles <= 1));
            for (std::uint32_t part = 0; part < p.triangles; ++part, ++triangle) {
                const Triangle& t = stream.triangles[triangle];
                RC_ASSERT(t.draw == range.draw && t.primitive == primitive && t.first_quad == quad && t.tiles >= 1);
                for (std::uint32_t q = 0; q < t.quads; ++q, ++quad) {
                    const Quad& here = stream.quads[quad];
                    RC_ASSERT(here.triangle == triangle && here.covered != 0);
                    RC_ASSERT((here.alive & ~here.covered) == 0);
                    RC_ASSERT(here.x < stream.width && here.y < stream.height);
                    covered += static_cast<unsigned>(std::popcount(static_cast<unsigned>(here.covered)));
                    dead += static_cast<unsigned>(std::popcount(static_cast<unsigned>(here.covered ^ here.alive)));
                }
            }
        }
        RC_ASSERT(range.first_quad + range.quads == quad);
    }
    RC_ASSERT(primitive == stream.primitives.size() && triangle == stream.triangles.size() &&
              quad == stream.quads.size());
    RC_ASSERT(covered == stream.fragments && dead == stream.fragments_discarded);
    RC_ASSERT(stream.depths.size() == quad && stream.colours.size() == quad && stream.texture_lines.size() == quad);
    for (const auto& colours : stream.colours)
        for (const glm::vec4& colour : colours)
            for (int i = 0; i < 4; ++i) RC_ASSERT(std::isfinite(colour[i]));
}

TEST(FrontEnd, DrawsComeInTheGivenOrderWithTheirOwnNumbers) {
    FunctionalScene scene(16, 16);
    scene.add(tests::rectangle(0, 0, 4, 4));
    scene.add(tests::rectangle(0, 0, 8, 8));
    scene.add(tests::rectangle(0, 0, 16, 16));
    scene.resources.validate("scene");
    const std::vector<std::uint32_t> which{2, 0, 2};
    const FragmentStream stream = rasterize(scene.resources, scene.draws, which, scene.view);
    ASSERT_EQ(stream.draws.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(stream.draws[i].draw, which[i]);
    EXPECT_EQ(stream.triangles.back().draw, 2U);
    EXPECT_EQ(stream.fragments, 256U + 16U + 256U);
}

TEST(FrontEnd, LeavesOutWhatNobodyAsksFor) {
    FunctionalScene scene = busy_scene(2, 50);
    FrontEndOptions options;
    options.colours = false;
    FragmentStream stream = scene.rasterize(options);
    EXPECT_TRUE(stream.colours.empty());
    EXPECT_FALSE(stream.texture_lines.empty()); // for the alpha test
    options.alpha_test = false;
    stream = scene.rasterize(options);
    EXPECT_TRUE(stream.texture_lines.empty());
    EXPECT_EQ(stream.fragments_discarded, 0U);
    options.colours = true;
    options.textures = false;
    stream = scene.rasterize(options);
    EXPECT_EQ(stream.colours.size(), stream.quads.size());
    EXPECT_TRUE(stream.texture_lines.empty());
}

TEST(FrontEnd, AStoredQuadTakesAtMost96Bytes) {
    FunctionalScene scene = busy_scene(3, 200);
    const FragmentStream stream = scene.rasterize();
    FragmentStream per_quad; // without what is counted per triangle, primitive and draw
    per_quad.quads = stream.quads;
    per_quad.depths = stream.depths;
    per_quad.colours = stream.colours;
    per_quad.texture_lines = stream.texture_lines;
    EXPECT_LE(per_quad.bytes(), 96 * stream.quads.size());
    // The vectors are as long as they need be.
    EXPECT_EQ(stream.quads.capacity(), stream.quads.size());
    EXPECT_EQ(stream.colours.capacity(), stream.colours.size());
    EXPECT_EQ(stream.triangles.capacity(), stream.triangles.size());
    EXPECT_EQ(stream.primitives.capacity(), stream.primitives.size());
    EXPECT_LE(stream.bytes() - per_quad.bytes(), 20 * stream.triangles.size() + 12 * stream.primitives.size() + 1024);
}

TEST(FrontEnd, EmptyDrawsAreEmpty) {
    FunctionalScene scene(16, 16);
    MeshData two_vertices;
    two_vertices.positions = {{0, 0, 0}, {1, 1, 0}};
    scene.add(two_vertices);
    scene.add(tests::rectangle(0, 0, 4, 4));
    const FragmentStream stream = scene.rasterize();
    EXPECT_EQ(stream.draws.at(0).primitives, 0U);
    EXPECT_EQ(stream.draws.at(1).first_quad, 0U);
    EXPECT_EQ(stream.fragments, 16U);
    EXPECT_EQ(rasterize(scene.resources, scene.draws, {}, scene.view).quads.size(), 0U);
}

TEST(FrontEnd, RefusesUnusableInput) {
    FunctionalScene scene(16, 16);
    scene.add(tests::rectangle(0, 0, 4, 4));
    const auto refused = [&](const std::string& expected, const View& view, const std::vector<Draw>& draws,
                             const std::vector<std::uint32_t>& which) {
        try {
            rasterize(scene.resources, draws, which, view);
            ADD_FAILURE() << "accepted";
        } catch (const sim::InputError& error) {
            EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
        }
    };
    View view = scene.view;
    view.width = 16385;
    refused("16384", view, scene.draws, {0});
    view.width = 0;
    refused("1 to 16384", view, scene.draws, {0});
    view = scene.view;
    view.view[2][1] = std::numeric_limits<float>::quiet_NaN();
    refused("finite", view, scene.draws, {0});
    refused("one of 1 draws", scene.view, scene.draws, {1});
    std::vector<Draw> draws = scene.draws;
    draws[0].instances.clear();
    refused("instance", scene.view, draws, {0});
    draws = scene.draws;
    draws[0].geometry = 7;
    refused("geometry", scene.view, draws, {0});
    draws = scene.draws;
    draws[0].material = 7;
    refused("material", scene.view, draws, {0});
    draws = scene.draws;
    draws[0].instances[0][3][0] = std::numeric_limits<float>::infinity();
    refused("model matrices", scene.view, draws, {0});
}

TEST(FrontEnd, RefusesMorePrimitivesThan32BitsCount) {
    FunctionalScene scene(16, 16);
    // A fan over one vertex that claims 2^31 triangles needs no memory to be refused twice over.
    MeshData mesh = tests::rectangle(0, 0, 4, 4);
    scene.add(mesh);
    scene.resources.geometries[0].index_type = IndexType::none;
    scene.resources.geometries[0].index_count = std::numeric_limits<std::uint32_t>::max() - 1;
    scene.draws[0].instances.resize(4, glm::mat4(1.0F));
    EXPECT_THROW(rasterize(scene.resources, scene.draws, std::vector<std::uint32_t>{0}, scene.view), sim::InputError);
}

TEST(FrontEnd, StopsWhenAskedTo) {
    FunctionalScene scene = busy_scene(4, 50);
    const std::atomic<bool> stop{true};
    FrontEndOptions options;
    options.stop = &stop;
    EXPECT_THROW(scene.rasterize(options), sim::Interrupted);
}

TEST(FrontEnd, ProgressRisesToOne) {
    FunctionalScene scene = busy_scene(5, 3000);
    FrontEndOptions options;
    double last = 0.0;
    options.progress = [&](double share) {
        EXPECT_GE(share, last);
        last = share;
    };
    scene.rasterize(options);
    EXPECT_EQ(last, 1.0);
}

TEST(FrontEnd, StripsAndFansAndInstancesDrawWhatListsDraw) {
    FunctionalScene scene(16, 16);
    MeshData strip;
    strip.positions = {{0, 0, 0.5F}, {0, 8, 0.5F}, {8, 0, 0.5F}, {8, 8, 0.5F}};
    scene.add(strip);
    scene.resources.geometries[0].topology = Topology::triangle_strip;
    MeshData fan;
    fan.positions = {{8, 8, 0.5F}, {8, 16, 0.5F}, {16, 16, 0.5F}, {16, 8, 0.5F}};
    scene.add(fan);
    scene.resources.geometries[1].topology = Topology::triangle_fan;
    scene.resources.materials[0].double_sided = false; // both wind counter-clockwise throughout
    scene.draws[0].instances.push_back(glm::translate(glm::mat4(1.0F), glm::vec3(8, 0, 0)));
    const FragmentStream stream = scene.rasterize();
    EXPECT_EQ(stream.draws.size(), 3U);
    EXPECT_EQ(stream.fragments, 3U * 64U);
    for (const std::uint32_t count : tests::coverage_counts(stream)) EXPECT_LE(count, 1U);
}

} // namespace
} // namespace pipeline
