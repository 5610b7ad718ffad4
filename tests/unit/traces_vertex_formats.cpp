// Formats of generated meshes: what lies where, and that the picture does not depend on it.
#include "pipeline/functional/vertex_fetch.hpp"
#include "sim/check.hpp"
#include "tests/support/scene_files.hpp"
#include "traces/generators.hpp"
#include "traces/generators/vertex_format.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <rapidcheck/gtest.h>
#include <set>

namespace traces_vertex_formats_test {

using pipeline::AttributeReader;
using pipeline::ComponentType;
using pipeline::Geometry;
using pipeline::PrimitiveReader;
using pipeline::Semantic;
using traces::AttributeFormat;
using traces::PositionGrid;
using traces::Scene;

std::vector<AttributeFormat> read(std::string_view text) { return traces::read_attribute_formats(text, "here"); }

std::string error_of(const std::string& spec) {
    try {
        if (spec.starts_with("gen:"))
            traces::load_scene(spec);
        else
            read(spec);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return {};
}

const Geometry& geometry_of(const Scene& scene, std::size_t number = 0) {
    return scene.resources->geometries.at(number);
}

/// World positions of the three corners of each triangle of each draw, in order.
std::vector<glm::dvec3> corners_of(const Scene& scene) {
    std::vector<glm::dvec3> corners;
    for (const pipeline::Draw& draw : scene.draws) {
        const Geometry& geometry = geometry_of(scene, draw.geometry);
        const AttributeReader position(*scene.resources, *geometry.find(Semantic::position));
        const PrimitiveReader triangle(*scene.resources, geometry);
        const glm::dmat4 to_world(draw.instances.at(0));
        for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i)
            for (const std::uint32_t vertex : triangle(i))
                corners.emplace_back(to_world * glm::dvec4(position(vertex)));
    }
    return corners;
}

TEST(VertexFormats, AttributesAreReadFromText) {
    EXPECT_TRUE(read("none").empty());
    EXPECT_EQ(read("normal:3f32"), (std::vector<AttributeFormat>{{Semantic::normal, ComponentType::f32, 3}}));
    const auto list = read("texcoord:2s16+colour:4u8+texcoord:4f32*7+secondary_colour:3u8+generic:4u10_10_10_2");
    ASSERT_EQ(list.size(), 11U);
    EXPECT_EQ(list[0], (AttributeFormat{Semantic::texcoord0, ComponentType::s16, 2}));
    EXPECT_EQ(list[1], (AttributeFormat{Semantic::colour, ComponentType::u8, 4}));
    EXPECT_EQ(list[2], (AttributeFormat{Semantic::texcoord1, ComponentType::f32, 4}));
    EXPECT_EQ(list[8], (AttributeFormat{Semantic::texcoord7, ComponentType::f32, 4}));
    EXPECT_EQ(list[9].bytes(), 3U);
    EXPECT_EQ(list[10].bytes(), 4U);
}

TEST(VertexFormats, TextErrorsNameWhatWasExpected) {
    EXPECT_EQ(error_of("normals:3f32"), "here: expected one of normal, colour, secondary_colour, texcoord, generic; "
                                        "did you mean 'normal'?, got 'normals:3f32'");
    EXPECT_EQ(error_of("normal"), "here: expected 1 to 4 components behind ':', got 'normal'");
    EXPECT_EQ(error_of("normal:"), "here: expected 1 to 4 components behind ':', got 'normal:'");
    EXPECT_EQ(error_of("normal:5f32"), "here: expected 1 to 4 components behind ':', got 'normal:5f32'");
    EXPECT_EQ(error_of("normal:3x"), "here: expected one of the types f32, f16, s8, u8, s16, u16, u32, s10_10_10_2, "
                                     "u10_10_10_2, got 'normal:3x'");
    EXPECT_EQ(error_of("normal:3s10_10_10_2"),
              "here: expected 4 components of a packed type, got 'normal:3s10_10_10_2'");
    EXPECT_EQ(error_of("colour:4u8*2"), "here: expected '*' behind texture coordinates only, got 'colour:4u8*2'");
    for (const char* text : {"texcoord:2f32*0", "texcoord:2f32*9", "texcoord:2f32*", "texcoord:2f32*2x"})
        EXPECT_EQ(error_of(text), std::string("here: expected 1 to 8 sets behind '*', got '") + text + "'");
    EXPECT_EQ(error_of("texcoord:2f32*8+texcoord:1u8"),
              "here: expected at most 8 sets of texture coordinates, got 'texcoord:1u8'");
    EXPECT_EQ(error_of("colour:4u8+colour:4f32"), "here: expected each attribute but texcoord once, got 'colour:4f32'");
    for (const char* text : {"", "+", "normal:3f32+", "+normal:3f32", "none+normal:3f32"})
        EXPECT_NE(error_of(text), "") << text;
    EXPECT_EQ(error_of("gen:grass?blades=5&align=3"), "gen:grass: align: expected 1, 2 or 4, got 3");
    EXPECT_TRUE(error_of("gen:blob?attributes=normal").starts_with("gen:blob: attributes: expected 1 to 4"));
    EXPECT_EQ(error_of("gen:grass?attributes=5"), "gen:grass: attributes: expected text, got 5");
}

// What is written is read back to within half a step of the type; out of range goes to the nearest end.
RC_GTEST_PROP(VertexFormats, ElementsSurviveWritingAndReading, ()) {
    const auto type = static_cast<ComponentType>(*rc::gen::inRange(0, 9));
    const auto components = static_cast<std::uint8_t>(pipeline::is_packed(type) ? 4 : *rc::gen::inRange(1, 5));
    glm::dvec4 value(0.0, 0.0, 0.0, 1.0);
    for (int i = 0; i < components; ++i) value[i] = *rc::gen::inRange(-1200, 1200) / 1000.0;
    std::vector<std::byte> bytes(17, std::byte{0xAB});
    traces::write_element(bytes.data(), type, components, true, value);
    const pipeline::VertexAttribute attribute{Semantic::normal, type, components, true, 0, 0, 16};
    RC_ASSERT(bytes[attribute.bytes()] == std::byte{0xAB});
    const glm::dvec4 back(AttributeReader(bytes.data(), attribute)(0));
    const bool is_float = type == ComponentType::f32 || type == ComponentType::f16;
    const bool is_unsigned = type == ComponentType::u8 || type == ComponentType::u16 || type == ComponentType::u32 ||
                             type == ComponentType::u10_10_10_2;
    const std::map<ComponentType, double> largest{{ComponentType::s8, 127},           {ComponentType::u8, 255},
                                                  {ComponentType::s16, 32767},        {ComponentType::u16, 65535},
                                                  {ComponentType::u32, 4294967295.0}, {ComponentType::s10_10_10_2, 511},
                                                  {ComponentType::u10_10_10_2, 1023}};
    for (int i = 0; i < 4; ++i) {
        double steps = is_float ? 1024.0 : largest.at(type); // a half has 10 bits behind its first
        if (pipeline::is_packed(type) && i == 3) steps = is_unsigned ? 3 : 1;
        const double expected = is_float ? value[i] : std::clamp(value[i], is_unsigned ? 0.0 : -1.0, 1.0);
        RC_ASSERT(std::fabs(back[i] - expected) <= 0.5 / steps + 1e-7);
    }
}

TEST(VertexFormats, WholeNumbersAreWrittenByValue) {
    std::array<std::byte, 16> bytes{};
    traces::write_element(bytes.data(), ComponentType::s16, 3, false, {-32767.0, 32767.0, 40000.0, 1.0});
    const pipeline::VertexAttribute attribute{Semantic::position, ComponentType::s16, 3, false, 0, 0, 8};
    EXPECT_EQ(AttributeReader(bytes.data(), attribute)(0), glm::vec4(-32767, 32767, 32767, 1));
    traces::write_element(bytes.data(), ComponentType::s10_10_10_2, 4, false, {-512.0, 511.0, -1.0, -2.0});
    const pipeline::VertexAttribute packed{Semantic::position, ComponentType::s10_10_10_2, 4, false, 0, 0, 4};
    EXPECT_EQ(AttributeReader(bytes.data(), packed)(0), glm::vec4(-512, 511, -1, -2));
}

RC_GTEST_PROP(VertexFormats, G11PositionsOf16BitsAreOffByAtMostTheExtentOver131068, ()) {
    const auto coordinate = [] { return *rc::gen::inRange(-1'000'000, 1'000'000) / 977.0; };
    const glm::dvec3 a(coordinate(), coordinate(), coordinate()), b(coordinate(), coordinate(), coordinate());
    const glm::dvec3 lo = glm::min(a, b), hi = glm::max(a, b);
    const PositionGrid grid(lo, hi);
    const double share = *rc::gen::inRange(0, 1001) / 1000.0;
    for (const glm::dvec3& position : {lo, hi, lo + (hi - lo) * share}) {
        const glm::dvec3 code = grid.code(position);
        for (int axis = 0; axis < 3; ++axis) {
            RC_ASSERT(std::fabs(code[axis]) <= 32767.0);
            RC_ASSERT(code[axis] == std::floor(code[axis]));
            const double back = grid.centre[axis] + code[axis] * grid.step[axis];
            RC_ASSERT(std::fabs(back - position[axis]) <= (hi[axis] - lo[axis]) / 131068.0 * (1.0 + 1e-9));
        }
    }
}

TEST(VertexFormats, G11BlobAndGrassOf16BitsDrawTheSamePlaces) {
    for (const std::string spec :
         {"gen:blob?triangles=3000", "gen:blob?triangles=3000&triangles_per_draw=500", "gen:grass?blades=400",
          "gen:grass?blades=400&blades_per_draw=33&layout=interleaved"}) {
        const Scene wide = traces::load_scene(spec);
        const Scene narrow = traces::load_scene(spec + "&position=s16");
        ASSERT_EQ(geometry_of(narrow).find(Semantic::position)->type, ComponentType::s16);
        const auto expected = corners_of(wide), found = corners_of(narrow);
        ASSERT_EQ(found.size(), expected.size());
        const glm::dvec3 extent(wide.hi - wide.lo);
        for (std::size_t i = 0; i < found.size(); ++i)
            for (int axis = 0; axis < 3; ++axis) // half a step of the draw, and the rounding of its matrix to floats
                ASSERT_LE(std::fabs(found[i][axis] - expected[i][axis]), extent[axis] * (1.0 / 131068.0 + 1e-6))
                    << spec << " corner " << i;
    }
}

TEST(VertexFormats, NormalsOnAStretchedGridPointWhereTheyDid) {
    const Scene wide = traces::load_scene("gen:grass?blades=200&blades_per_draw=30");
    const Scene narrow = traces::load_scene("gen:grass?blades=200&blades_per_draw=30&position=s16");
    for (std::size_t d = 0; d < wide.draws.size(); ++d) {
        const AttributeReader before(*wide.resources, *geometry_of(wide, d).find(Semantic::normal));
        const AttributeReader after(*narrow.resources, *geometry_of(narrow, d).find(Semantic::normal));
        const glm::dmat3 to_world{glm::dmat4(narrow.draws[d].instances[0])};
        const glm::dmat3 cofactors = glm::transpose(glm::inverse(to_world));
        for (std::uint32_t i = 0; i < geometry_of(wide, d).vertex_count; ++i)
            ASSERT_GT(glm::dot(glm::normalize(cofactors * glm::dvec3(after(i))), glm::normalize(glm::dvec3(before(i)))),
                      1.0 - 1e-9);
    }
}

TEST(VertexFormats, DefaultsAreWhatTheyWere) {
    const std::string same = "&position=f32&attributes=normal:3f32&layout=separate&index=auto&align=4";
    for (const std::string spec : {"gen:grass?blades=50", "gen:blob?triangles=500"})
        EXPECT_EQ(traces::load_scene(spec).hash, traces::load_scene(spec + same).hash);
    const std::string four = "gen:blob?triangles=500&attributes=";
    EXPECT_NE(traces::load_scene(four + "texcoord:4f32").hash, traces::load_scene(four + "generic:4f32").hash);
    EXPECT_EQ(traces::load_scene("gen:grass?blades=1000").hash, "733427ee4dc35df1");
    EXPECT_EQ(traces::load_scene("gen:grid-soup?boxes=60").hash, "bbf24c329b8c52f4");
    EXPECT_EQ(traces::load_scene("gen:particles").hash, "0c2a7a1e9e950e53");
    EXPECT_EQ(traces::load_scene("gen:blob?triangles=2000").hash, "518260ed01aa392d");
    EXPECT_EQ(traces::load_scene("gen:blob?triangles=2000&order=random").hash, "d1b3715feca23ef2");
}

TEST(VertexFormats, StridesAndOffsetsAreRoundedUpToTheAlignment) {
    const std::string spec = "gen:grass?blades=10&position=s16&attributes=normal:3s8+colour:3u8+texcoord:1f16";
    const auto offsets = [&](const std::string& more) {
        const Scene scene = traces::load_scene(spec + more);
        std::vector<std::uint64_t> list;
        for (const auto& attribute : geometry_of(scene).attributes) list.push_back(attribute.offset);
        list.push_back(geometry_of(scene).attributes[0].stride);
        return list;
    };
    using List = std::vector<std::uint64_t>;
    EXPECT_EQ(offsets("&layout=interleaved&align=1"), (List{0, 6, 9, 12, 14}));
    EXPECT_EQ(offsets("&layout=interleaved&align=2"), (List{0, 6, 10, 14, 16}));
    EXPECT_EQ(offsets("&layout=interleaved&align=4"), (List{0, 8, 12, 16, 20}));
    EXPECT_EQ(offsets("&align=4"), (List{0, 0, 0, 0, 8}));
    const Scene tight = traces::load_scene(spec + "&align=1");
    const std::vector<std::uint32_t> strides{6, 3, 3, 2};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(geometry_of(tight).attributes[i].stride, strides[i]);
    EXPECT_EQ(tight.resources->buffers.size(), 5U); // four attributes, indices
    EXPECT_EQ(tight.resources->buffers[1].bytes.size(), 70U * 3);
    EXPECT_EQ(traces::load_scene("gen:blob?triangles=500&attributes=none").resources->buffers.size(), 2U);
}

TEST(VertexFormats, AttributesThatTheMeshLacksHaveValues) {
    const Scene scene = traces::load_scene(
        "gen:blob?triangles=500&attributes=colour:4u8+secondary_colour:3f32+texcoord:2u16*2+generic:4s10_10_10_2");
    const auto reader = [&](Semantic semantic) {
        return AttributeReader(*scene.resources, *geometry_of(scene).find(semantic));
    };
    const glm::dvec3 extent(scene.hi - scene.lo);
    for (std::uint32_t i = 0; i < geometry_of(scene).vertex_count; ++i) {
        EXPECT_EQ(reader(Semantic::colour)(i), glm::vec4(1.0F));
        EXPECT_EQ(reader(Semantic::secondary_colour)(i), glm::vec4(0, 0, 0, 1));
        const glm::dvec3 place = (glm::dvec3(reader(Semantic::position)(i)) - glm::dvec3(scene.lo)) / extent;
        EXPECT_NEAR(static_cast<double>(reader(Semantic::texcoord1)(i).y), place.y, 1e-4);
        EXPECT_NEAR(static_cast<double>(reader(Semantic::generic)(i).z), place.z, 2e-3);
    }
    EXPECT_EQ(geometry_of(scene).find(Semantic::normal), nullptr);
}

TEST(VertexFormats, SixteenBitIndicesReach65536VerticesAndNoMore) {
    // A blob of V vertices has 2V - 4 triangles.
    const auto spec = [](std::uint32_t vertices, const char* index) {
        return "gen:blob?triangles=" + std::to_string(2 * vertices - 4) + "&attributes=none&index=" + index;
    };
    for (const std::uint32_t vertices : {65535U, 65536U}) {
        const Scene scene = traces::load_scene(spec(vertices, "u16"));
        EXPECT_EQ(geometry_of(scene).vertex_count, vertices);
        EXPECT_EQ(geometry_of(scene).index_type, pipeline::IndexType::u16);
        EXPECT_EQ(pipeline::used_vertices(*scene.resources, geometry_of(scene)).end, vertices);
    }
    EXPECT_EQ(error_of(spec(65537, "u16")),
              "gen:blob: index: expected u32 or at most 65536 vertices in a draw, got u16 and 65537");
    const Scene automatic = traces::load_scene(spec(65537, "auto"));
    EXPECT_EQ(geometry_of(automatic).index_type, pipeline::IndexType::u32);
    EXPECT_EQ(error_of("gen:grass?blades=9363&index=u16"),
              "gen:grass: index: expected u32 or at most 65536 vertices in a draw, got u16 and 65541");
    EXPECT_EQ(error_of("gen:grass?blades=9363&blades_per_draw=9362&index=u16"), "");
}

TEST(VertexFormats, ThirtyTwoBitIndicesNameTheSameVertices) {
    const Scene narrow = traces::load_scene("gen:blob?triangles=1000");
    const Scene wide = traces::load_scene("gen:blob?triangles=1000&index=u32");
    EXPECT_EQ(geometry_of(narrow).index_type, pipeline::IndexType::u16);
    EXPECT_EQ(geometry_of(wide).index_type, pipeline::IndexType::u32);
    EXPECT_EQ(wide.resources->buffers.back().bytes.size(), 2 * narrow.resources->buffers.back().bytes.size());
    EXPECT_EQ(corners_of(narrow), corners_of(wide));
}

TEST(VertexFormats, BlobInDrawsHasItsTrianglesAndVerticesOfItsOwn) {
    const Scene one = traces::load_scene("gen:blob?triangles=5000");
    const Scene many = traces::load_scene("gen:blob?triangles=5000&triangles_per_draw=700");
    ASSERT_EQ(many.draws.size(), 8U);
    EXPECT_EQ(many.triangles, 5000U);
    EXPECT_EQ(geometry_of(many, 7).triangle_count(), 100U);
    EXPECT_EQ(corners_of(one), corners_of(many));
    EXPECT_GT(many.vertices, one.vertices); // those on borders are there twice
    EXPECT_LT(many.vertices, one.vertices * 5 / 4);
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(pipeline::used_vertices(*many.resources, geometry_of(many, i)).end,
                  geometry_of(many, i).vertex_count);
}

TEST(VertexFormats, RandomVertexOrderChangesWhereVerticesLieAndNothingElse) {
    for (const std::string draws : {"", "&triangles_per_draw=999"}) {
        const Scene sorted = traces::load_scene("gen:blob?triangles=4000" + draws);
        const Scene random = traces::load_scene("gen:blob?triangles=4000&vertex_order=random" + draws);
        EXPECT_EQ(corners_of(sorted), corners_of(random));
        const auto jumps = [](const Scene& scene) { // mean distance between the vertices of an edge
            const Geometry& geometry = geometry_of(scene);
            const PrimitiveReader triangle(*scene.resources, geometry);
            double sum = 0.0;
            for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i)
                sum += std::fabs(static_cast<double>(triangle(i)[0]) - triangle(i)[1]);
            return sum / geometry.triangle_count() / geometry.vertex_count;
        };
        EXPECT_LT(jumps(sorted), 0.1);
        EXPECT_NEAR(jumps(random), 1.0 / 3.0, 0.03); // of two random places in a list
    }
}

TEST(VertexFormats, RowsOfABlobFollowEachOther) {
    const Scene rows = traces::load_scene("gen:blob?triangles=4000&order=rows&bumps=0");
    const auto corners = corners_of(rows);
    double above = 2.0;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const double top = std::max({corners[i].y, corners[i + 1].y, corners[i + 2].y});
        EXPECT_LE(top, above + 1e-6); // from the north pole down
        above = top;
    }
    std::multiset<double> a, b;
    for (const auto& corner : corners) a.insert(corner.x);
    for (const auto& corner : corners_of(traces::load_scene("gen:blob?triangles=4000&bumps=0"))) b.insert(corner.x);
    EXPECT_EQ(a, b);
}

} // namespace traces_vertex_formats_test
