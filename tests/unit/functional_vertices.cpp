// Attribute and index fetch, primitive assembly, the vertex transform.
#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/functional/vertex_transform.hpp"
#include "tests/support/functional_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

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
