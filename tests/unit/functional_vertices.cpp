// Attribute and index fetch, primitive assembly, the vertex transform.
#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/functional/vertex_transform.hpp"
#include "sim/check.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck/gtest.h>

namespace pipeline {
namespace {

template <class Element>
glm::vec4 fetch(ComponentType type, std::uint8_t components, bool normalized, const std::vector<Element>& elements,
                std::uint32_t stride, std::uint64_t offset = 0, std::uint32_t index = 0) {
    Resources resources;
    resources.buffers = {tests::buffer_of(elements)};
    const VertexAttribute attribute{Semantic::position, type, components, normalized, 0, offset, stride};
    return AttributeReader(resources, attribute)(index);
}

TEST(AttributeFetch, MissingComponentsAreZeroAndOne) {
    EXPECT_EQ(fetch<float>(ComponentType::f32, 1, false, {5}, 4), glm::vec4(5, 0, 0, 1));
    EXPECT_EQ(fetch<float>(ComponentType::f32, 2, false, {5, 6}, 8), glm::vec4(5, 6, 0, 1));
    EXPECT_EQ(fetch<float>(ComponentType::f32, 3, false, {5, 6, 7}, 12), glm::vec4(5, 6, 7, 1));
    EXPECT_EQ(fetch<float>(ComponentType::f32, 4, false, {5, 6, 7, 8}, 16), glm::vec4(5, 6, 7, 8));
}

TEST(AttributeFetch, IntegersAreTakenByValue) {
    EXPECT_EQ(fetch<std::int8_t>(ComponentType::s8, 3, false, {-128, 127, -1}, 3), glm::vec4(-128, 127, -1, 1));
    EXPECT_EQ(fetch<std::uint8_t>(ComponentType::u8, 3, false, {0, 200, 255}, 3), glm::vec4(0, 200, 255, 1));
    EXPECT_EQ(fetch<std::int16_t>(ComponentType::s16, 2, false, {-32768, 32767}, 4), glm::vec4(-32768, 32767, 0, 1));
    EXPECT_EQ(fetch<std::uint16_t>(ComponentType::u16, 2, false, {65535, 1}, 4), glm::vec4(65535, 1, 0, 1));
    EXPECT_EQ(fetch<std::uint32_t>(ComponentType::u32, 1, false, {4294967295U}, 4), glm::vec4(4294967296.0F, 0, 0, 1));
}

TEST(AttributeFetch, NormalizedIntegersSpanTheUnitRange) {
    EXPECT_EQ(fetch<std::int8_t>(ComponentType::s8, 4, true, {-128, -127, 0, 127}, 4), glm::vec4(-1, -1, 0, 1));
    EXPECT_EQ(fetch<std::uint8_t>(ComponentType::u8, 3, true, {0, 51, 255}, 3), glm::vec4(0, 0.2F, 1, 1));
    EXPECT_EQ(fetch<std::int16_t>(ComponentType::s16, 3, true, {-32768, -32767, 32767}, 6), glm::vec4(-1, -1, 1, 1));
    EXPECT_EQ(fetch<std::uint16_t>(ComponentType::u16, 2, true, {0, 65535}, 4), glm::vec4(0, 1, 0, 1));
    EXPECT_EQ(fetch<std::uint32_t>(ComponentType::u32, 2, true, {0, 4294967295U}, 8), glm::vec4(0, 1, 0, 1));
}

// x in the low bits: 2_10_10_10_REV of OpenGL 4.5, section 10.3.8.
constexpr std::uint32_t word_of(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t w) {
    return x | y << 10U | z << 20U | w << 30U;
}

TEST(AttributeFetch, PackedTenBitIntegersAreTakenByValue) {
    using Words = std::vector<std::uint32_t>;
    const Words words{word_of(0x3FF, 0x1FF, 0x200, 2), word_of(1, 2, 3, 1)};
    EXPECT_EQ(fetch(ComponentType::s10_10_10_2, 4, false, words, 4), glm::vec4(-1, 511, -512, -2));
    EXPECT_EQ(fetch(ComponentType::u10_10_10_2, 4, false, words, 4), glm::vec4(1023, 511, 512, 2));
    EXPECT_EQ(fetch(ComponentType::s10_10_10_2, 4, false, words, 4, 0, 1), glm::vec4(1, 2, 3, 1));
    EXPECT_EQ(fetch(ComponentType::u10_10_10_2, 4, false, Words{word_of(0, 0, 0, 3)}, 4), glm::vec4(0, 0, 0, 3));
}

TEST(AttributeFetch, PackedTenBitIntegersSpanTheUnitRange) {
    using Words = std::vector<std::uint32_t>;
    EXPECT_EQ(fetch(ComponentType::s10_10_10_2, 4, true, Words{word_of(0x200, 0x201, 0x1FF, 1)}, 4),
              glm::vec4(-1, -1, 1, 1));
    EXPECT_EQ(fetch(ComponentType::s10_10_10_2, 4, true, Words{word_of(0, 73, 0, 2)}, 4),
              glm::vec4(0, 1.0F / 7.0F, 0, -1)); // 73 * 7 = 511; w has the values -2, -1, 0, 1
    EXPECT_EQ(fetch(ComponentType::u10_10_10_2, 4, true, Words{word_of(0, 1023, 341, 1)}, 4),
              glm::vec4(0, 1, 1.0F / 3.0F, 1.0F / 3.0F));
}

TEST(AttributeFetch, SlotsOfSemantics) {
    EXPECT_EQ(slot_of(Semantic::position), Slot::position);
    EXPECT_EQ(slot_of(Semantic::normal), Slot::normal);
    EXPECT_EQ(slot_of(Semantic::colour), Slot::colour);
    EXPECT_EQ(slot_of(Semantic::secondary_colour), Slot::colour);
    for (std::uint32_t set = 0; set < texcoord_sets; ++set) EXPECT_EQ(slot_of(texcoord(set)), Slot::texcoord);
    EXPECT_EQ(slot_of(Semantic::generic), Slot::generic);
    EXPECT_EQ(sim::enum_name(Semantic::texcoord7), "texcoord7");
    EXPECT_EQ(sim::enum_name(last_component_type), "u10_10_10_2");
}

TEST(AttributeFetch, HalfFloats) {
    EXPECT_EQ(fetch<std::uint16_t>(ComponentType::f16, 3, false, {0x3C00, 0xC000, 0x3800}, 6),
              glm::vec4(1, -2, 0.5F, 1));
}

TEST(AttributeFetch, AnyStrideAndAlignment) {
    std::vector<std::uint8_t> bytes(64, 0xEE);
    const float value = 3.25F;
    std::memcpy(bytes.data() + 3 + 2 * 7, &value, 4); // offset 3, stride 7, element 2
    EXPECT_EQ(fetch(ComponentType::f32, 1, false, bytes, 7, 3, 2), glm::vec4(3.25F, 0, 0, 1));
}

TEST(AttributeFetch, DivisorsAdvanceByInstances) {
    Resources resources;
    resources.buffers = {tests::buffer_of(std::vector<float>{0, 1, 2, 3})};
    VertexAttribute attribute{Semantic::generic, ComponentType::f32, 1, false, 0, 4, 4};
    attribute.divisor = 2;
    for (const std::uint32_t instance : {0U, 1U, 2U, 3U, 5U})
        for (const std::uint32_t vertex : {0U, 7U})
            EXPECT_EQ(AttributeReader(resources, attribute, instance)(vertex).x,
                      1.0F + static_cast<float>(instance / 2));
    EXPECT_TRUE(has_elements_for(resources, attribute, 6));
    EXPECT_FALSE(has_elements_for(resources, attribute, 7));
    attribute.divisor = 0;
    EXPECT_TRUE(has_elements_for(resources, attribute, 1000));
}

TEST(AttributeFetch, InstancesHaveTheirOwnColoursAndPlaces) {
    tests::FunctionalScene scene(32, 8);
    tests::MeshData mesh = tests::rectangle(0, 0, 8, 8);
    mesh.colours = {{0.25F, 0, 0, 1}, {0.5F, 0, 0, 1}, {0.75F, 0, 0, 1}, {1, 0, 0, 1}};
    scene.add(mesh);
    for (VertexAttribute& attribute : scene.resources.geometries[0].attributes)
        if (attribute.semantic == Semantic::colour) attribute.divisor = 2;
    scene.draws[0].instances.clear();
    for (int i = 0; i < 4; ++i) {
        glm::mat4 model(1.0F);
        model[3][0] = static_cast<float>(8 * i);
        scene.draws[0].instances.push_back(model);
    }
    const FragmentStream stream = scene.rasterize();
    EXPECT_EQ(stream.fragments, 256U);
    for (std::size_t i = 0; i < stream.quads.size(); ++i) {
        if ((stream.quads[i].covered & 1U) == 0) continue;
        EXPECT_EQ(stream.colours[i][0].r, stream.quads[i].x < 16 ? 0.25F : 0.5F);
    }
    for (VertexAttribute& attribute : scene.resources.geometries[0].attributes)
        if (attribute.semantic == Semantic::colour) attribute.offset = 3 * sizeof(glm::vec4);
    EXPECT_THROW(scene.rasterize(), sim::InputError);
}

// Instances of one matrix whose positions advance are not the same vertices.
TEST(AttributeFetch, PositionsMayAdvanceByInstances) {
    tests::FunctionalScene scene(16, 8);
    scene.add({.positions = {{2.5F, 2.5F, 0.5F}, {5.5F, 2.5F, 0.5F}, {9.5F, 2.5F, 0.5F}},
               .normals = {},
               .colours = {},
               .texcoords = {},
               .indices = {}});
    Geometry& geometry = scene.resources.geometries[0];
    geometry.topology = Topology::points;
    geometry.index_count = geometry.vertex_count = 1;
    geometry.attributes[0].divisor = 1;
    geometry.attributes[0].components = 2; // depth 0 then
    scene.draws[0].instances.assign(3, glm::mat4(1.0F));
    const FragmentStream stream = scene.rasterize();
    ASSERT_EQ(stream.quads.size(), 3U);
    EXPECT_EQ(stream.quads[0].x, 2U);
    EXPECT_EQ(stream.quads[1].x, 4U);
    EXPECT_EQ(stream.quads[2].x, 8U);
    EXPECT_EQ(stream.depths[0][0], 0.0F);
}

TEST(IndexFetch, EveryWidthAndNone) {
    Resources resources;
    resources.buffers = {tests::buffer_of(std::vector<std::uint8_t>{9, 1, 2, 3, 4, 5, 6, 7, 8})};
    Geometry geometry;
    geometry.index_offset = 1;
    geometry.index_type = IndexType::u8;
    EXPECT_EQ(IndexReader(resources, geometry)(1), 2U);
    geometry.index_type = IndexType::u16;
    EXPECT_EQ(IndexReader(resources, geometry)(1), 0x0403U);
    geometry.index_type = IndexType::u32;
    EXPECT_EQ(IndexReader(resources, geometry)(1), 0x08070605U);
    geometry.index_type = IndexType::none;
    EXPECT_EQ(IndexReader(resources, geometry)(7), 7U);
}

TEST(PrimitiveAssembly, StripsAndFansKeepTheirWinding) {
    using Corners = std::array<std::uint32_t, 3>;
    const Resources resources;
    Geometry geometry;
    geometry.index_count = 5;
    geometry.topology = Topology::triangle_strip;
    EXPECT_EQ(geometry.triangle_count(), 3U);
    EXPECT_EQ(PrimitiveReader(resources, geometry)(0), (Corners{0, 1, 2}));
    EXPECT_EQ(PrimitiveReader(resources, geometry)(1), (Corners{1, 3, 2}));
    EXPECT_EQ(PrimitiveReader(resources, geometry)(2), (Corners{2, 3, 4}));
    geometry.topology = Topology::triangle_fan;
    EXPECT_EQ(geometry.triangle_count(), 3U);
    EXPECT_EQ(PrimitiveReader(resources, geometry)(1), (Corners{2, 3, 0}));
    geometry.topology = Topology::triangles;
    EXPECT_EQ(geometry.triangle_count(), 1U);
    geometry.index_count = 2;
    geometry.topology = Topology::triangle_strip;
    EXPECT_EQ(geometry.triangle_count(), 0U);
}

/// Indices of 16 bits; 0xFFFF restarts.
struct RestartedGeometry {
    Resources resources;

    RestartedGeometry(Topology topology, const std::vector<std::uint16_t>& indices) {
        resources.buffers = {tests::buffer_of(indices), tests::buffer_of(std::vector<float>(300))};
        Geometry geometry;
        geometry.topology = topology;
        geometry.attributes = {{.buffer = 1}};
        geometry.vertex_count = 100;
        geometry.index_type = IndexType::u16;
        geometry.index_count = static_cast<std::uint32_t>(indices.size());
        geometry.primitive_restart = true;
        resources.geometries = {geometry};
        resources.find_runs();
    }
    Geometry& geometry() { return resources.geometries[0]; }
    std::vector<std::array<std::uint32_t, 3>> triangles() {
        std::vector<std::array<std::uint32_t, 3>> list;
        const PrimitiveReader read(resources, geometry());
        for (std::uint32_t i = 0; i < geometry().primitive_count(); ++i) list.push_back(read(i));
        return list;
    }
};

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

TEST(PrimitiveRestart, EndsStripsFansAndBegunTriangles) {
    const std::vector<std::uint16_t> indices{0, 1, 2, 3, 0xFFFF, 4, 5, 6, 7, 8};
    EXPECT_EQ(RestartedGeometry(Topology::triangle_strip, indices).triangles(),
              (Triangles{{0, 1, 2}, {1, 3, 2}, {4, 5, 6}, {5, 7, 6}, {6, 7, 8}}));
    EXPECT_EQ(RestartedGeometry(Topology::triangle_fan, indices).triangles(),
              (Triangles{{1, 2, 0}, {2, 3, 0}, {5, 6, 4}, {6, 7, 4}, {7, 8, 4}}));
    EXPECT_EQ(RestartedGeometry(Topology::triangles, indices).triangles(), (Triangles{{0, 1, 2}, {4, 5, 6}}));
    const std::vector<std::uint16_t> few{0, 1, 2, 0xFFFF, 9, 0xFFFF, 4, 5};
    EXPECT_EQ(RestartedGeometry(Topology::points, few).triangles(),
              (Triangles{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {9, 9, 9}, {4, 4, 4}, {5, 5, 5}}));
    EXPECT_EQ(RestartedGeometry(Topology::lines, few).triangles(), (Triangles{{0, 1, 1}, {4, 5, 5}}));
    EXPECT_EQ(RestartedGeometry(Topology::line_strip, few).triangles(), (Triangles{{0, 1, 1}, {1, 2, 2}, {4, 5, 5}}));
    EXPECT_EQ(RestartedGeometry(Topology::line_loop, few).triangles(),
              (Triangles{{0, 1, 1}, {1, 2, 2}, {2, 0, 0}, {4, 5, 5}, {5, 4, 4}}));
}

TEST(PrimitiveRestart, RunsWithoutTrianglesLeaveNoTrace) {
    RestartedGeometry odd(Topology::triangle_strip,
                          {0xFFFF, 0xFFFF, 9, 0xFFFF, 8, 7, 0xFFFF, 1, 2, 3, 0xFFFF, 4, 5, 6, 0xFFFF, 0xFFFF});
    EXPECT_EQ(odd.triangles(), (Triangles{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(odd.geometry().runs, (std::vector<IndexRun>{{7, 0}, {11, 1}, {16, 2}}));
    EXPECT_NO_THROW(odd.resources.validate("odd"));
    EXPECT_EQ(used_vertices(odd.resources, odd.geometry()).first, 1U);
    EXPECT_EQ(used_vertices(odd.resources, odd.geometry()).end, 10U);
    RestartedGeometry nothing(Topology::triangle_strip, {0xFFFF, 0xFFFF});
    EXPECT_EQ(nothing.geometry().triangle_count(), 0U);
    EXPECT_EQ(used_vertices(nothing.resources, nothing.geometry()).end, 0U);
    RestartedGeometry empty(Topology::triangle_fan, {});
    EXPECT_EQ(empty.geometry().triangle_count(), 0U);
}

TEST(PrimitiveRestart, ValidateRefusesWhatDoesNotFit) {
    const auto error = [](const std::function<void(RestartedGeometry&)>& spoil) -> std::string {
        RestartedGeometry geometry(Topology::triangle_strip, {0, 1, 2, 0xFFFF, 3, 4, 5});
        spoil(geometry);
        try {
            geometry.resources.validate("strips");
        } catch (const sim::InputError& refused) {
            return refused.what();
        }
        return "";
    };
    EXPECT_EQ(error([](RestartedGeometry&) {}), "");
    EXPECT_EQ(error([](RestartedGeometry& g) { g.geometry().runs.clear(); }),
              "strips: geometry 0: expected the runs between the restarts of its indices");
    EXPECT_EQ(error([](RestartedGeometry& g) { g.geometry().primitive_restart = false; }),
              "strips: geometry 0: expected index 3 below the vertex count 100, not 65535");
    EXPECT_EQ(error([](RestartedGeometry& g) {
                  g.geometry().index_count = 3;
                  g.geometry().primitive_restart = false;
              }),
              "strips: geometry 0: expected no runs of indices without primitive restart");
    EXPECT_EQ(error([](RestartedGeometry& g) {
                  g.geometry().index_type = IndexType::none;
                  g.resources.find_runs();
              }),
              "strips: geometry 0: expected indices where primitives are restarted");
    EXPECT_NE(error([](RestartedGeometry& g) {
                  g.geometry().index_count = 4'000'000'000;
                  g.resources.find_runs();
              }).find("4000000000 indices of 2 bytes"),
              std::string::npos);
}

// Strips cut out of one index buffer equal as many draws of one strip each.
RC_GTEST_PROP(PrimitiveRestart, EqualsSeparateStrips, ()) {
    const auto lengths = *rc::gen::container<std::vector<std::uint32_t>>(rc::gen::inRange(0U, 9U));
    const auto topology = *rc::gen::element(Topology::triangle_strip, Topology::triangle_fan, Topology::triangles);
    std::vector<std::uint16_t> indices;
    Triangles expected;
    std::uint16_t vertex = 0;
    for (const std::uint32_t length : lengths) {
        std::vector<std::uint16_t> strip;
        for (std::uint32_t i = 0; i < length; ++i) strip.push_back(static_cast<std::uint16_t>(vertex++ % 100));
        Resources alone;
        alone.buffers = {tests::buffer_of(strip)};
        Geometry geometry;
        geometry.topology = topology;
        geometry.index_type = IndexType::u16;
        geometry.index_count = length;
        const PrimitiveReader read(alone, geometry);
        for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i) expected.push_back(read(i));
        indices.insert(indices.end(), strip.begin(), strip.end());
        indices.push_back(0xFFFF);
    }
    RC_ASSERT(RestartedGeometry(topology, indices).triangles() == expected);
}

TEST(UsedVertices, AreTheRangeOfTheIndices) {
    Resources resources;
    resources.buffers = {tests::buffer_of(std::vector<std::uint16_t>{7, 3, 5})};
    Geometry geometry;
    geometry.index_type = IndexType::u16;
    geometry.index_count = 3;
    EXPECT_EQ(used_vertices(resources, geometry).first, 3U);
    EXPECT_EQ(used_vertices(resources, geometry).end, 8U);
    geometry.index_count = 0;
    EXPECT_EQ(used_vertices(resources, geometry).end, 0U);
}

TEST(VertexTransform, SnapsToNearestEvenSubPixel) {
    const tests::FunctionalScene scene(512, 512);
    const Viewport viewport(512, 512);
    const glm::mat4 matrix = clip_matrix(scene.view, glm::mat4(1.0F));
    const auto place = [&](float x, float y, float depth) {
        return transform_vertex(matrix, viewport, glm::vec4(x, y, depth, 1));
    };
    EXPECT_EQ(place(0.5F, 0.5F, 0.25F).x, 0);
    EXPECT_EQ(place(0.5F, 0.5F, 0.25F).y, 0);
    EXPECT_EQ(place(0.5F, 0.5F, 0.25F).depth, 0.25F);
    EXPECT_EQ(place(10.0F, 3.0F, 0).x, 10 * 256 - 128);
    EXPECT_EQ(place(10.0F, 3.0F, 0).y, 3 * 256 - 128);
    EXPECT_EQ(place(1.5F + 0x1p-9F, 0, 0).x, 256);     // half a sub-pixel: down to even
    EXPECT_EQ(place(1.5F + 3 * 0x1p-9F, 0, 0).x, 258); // one and a half: up to even
    EXPECT_EQ(place(512.0F, 512.0F, 1).outside, 0U);   // on the edge is inside
    EXPECT_EQ(place(512.5F, 0, 0).outside, outside::right);
    EXPECT_EQ(place(0, 0, 1.5F).outside, outside::far);
    EXPECT_EQ(place(0, 0, -0.5F).outside, outside::near);
}

TEST(VertexTransform, NotFinitePositionsAreMarked) {
    const Viewport viewport(64, 64);
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN()})
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec4 position(0, 0, 0, 1);
            position[axis] = bad;
            EXPECT_EQ(transform_vertex(glm::mat4(1.0F), viewport, position).outside, outside::not_finite);
        }
    const glm::mat4 huge(3e38F); // finite in, infinite out
    EXPECT_EQ(transform_vertex(huge, viewport, glm::vec4(2, 0, 0, 1)).outside, outside::not_finite);
}

TEST(VertexTransform, VerticesInTheEyePlaneStayFinite) {
    const Viewport viewport(64, 64);
    ScreenVertex vertex;
    vertex.clip = glm::vec4(0.0F);
    viewport.project(vertex);
    EXPECT_EQ(vertex.x, 32 * 256 - 128);
    EXPECT_EQ(vertex.depth, 0.5F);
}

} // namespace
} // namespace pipeline
