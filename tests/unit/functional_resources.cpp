// Resources: placement in memory, and what validate() refuses.
#include "pipeline/draw.hpp"
#include "sim/check.hpp"
#include "tests/support/functional_scene.hpp"

#include <functional>
#include <gtest/gtest.h>
#include <limits>

namespace pipeline {
namespace {

Resources good_resources() {
    tests::FunctionalScene scene(16, 16);
    scene.add_texture(tests::texture_of_one_colour(6, 5, 0xFFFFFFFF));
    scene.add(tests::rectangle(0, 0, 4, 4));
    scene.resources.geometries[0].name = "plate";
    scene.resources.materials[0].base_texture = 0;
    scene.resources.textures[0].make_mips();
    return scene.resources;
}

void expect_refused(const std::string& expected, const std::function<void(Resources&)>& spoil) {
    Resources resources = good_resources();
    spoil(resources);
    try {
        resources.validate("box.glb");
        ADD_FAILURE() << "accepted: " << expected;
    } catch (const sim::InputError& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.rfind("box.glb: ", 0), 0U) << text;
        EXPECT_NE(text.find(expected), std::string::npos) << text;
    }
}

TEST(Resources, GoodOnesAreAccepted) {
    EXPECT_NO_THROW(good_resources().validate("box.glb"));
    EXPECT_NO_THROW(Resources{}.validate("nothing"));
}

TEST(Resources, ValidateNamesWhatIsWrong) {
    expect_refused("geometry 0 \"plate\": expected a position",
                   [](Resources& r) { r.geometries[0].attributes.clear(); });
    expect_refused("one of 3 buffers, not 9", [](Resources& r) { r.geometries[0].attributes[0].buffer = 9; });
    expect_refused("1 to 4 components", [](Resources& r) { r.geometries[0].attributes[0].components = 5; });
    expect_refused("stride of at least 12", [](Resources& r) { r.geometries[0].attributes[0].stride = 8; });
    expect_refused("stride of at least 12", [](Resources& r) { r.geometries[0].attributes[0].stride = 0; });
    expect_refused("within 48 bytes", [](Resources& r) { r.geometries[0].attributes[0].offset = 1; });
    expect_refused("within 48 bytes", [](Resources& r) { r.geometries[0].vertex_count = 5; });
    expect_refused("each semantic once",
                   [](Resources& r) { r.geometries[0].attributes.push_back(r.geometries[0].attributes[0]); });
    expect_refused("index buffer below 3", [](Resources& r) { r.geometries[0].index_buffer = 3; });
    expect_refused("within 24 bytes", [](Resources& r) { r.geometries[0].index_count = 7; });
    expect_refused("index 0 below the vertex count 4, not 4",
                   [](Resources& r) { r.buffers[2].bytes[0] = std::byte{4}; });
    expect_refused("level 1 to be half",
                   [](Resources& r) { r.textures[0].levels.erase(r.textures[0].levels.begin() + 1); });
    expect_refused("bytes for 6x5 texels", [](Resources& r) { r.textures[0].levels[0].rgba.pop_back(); });
    expect_refused("at least one level", [](Resources& r) { r.textures[0].levels.clear(); });
    expect_refused("to be 1 to", [](Resources& r) { r.textures[0].levels[0].width = 0; });
    expect_refused("base texture", [](Resources& r) { r.materials[0].base_texture = 1; });
    expect_refused("base texture", [](Resources& r) { r.materials[0].base_texture = -2; });
    expect_refused("texture coordinates 0 to 7", [](Resources& r) { r.materials[0].texcoord = 8; });
    expect_refused("finite",
                   [](Resources& r) { r.materials[0].base_colour.g = std::numeric_limits<float>::infinity(); });
}

TEST(Resources, VertexProgramsNeedNoPositions) {
    Resources resources = good_resources();
    resources.geometries[0].attributes[0].semantic = Semantic::generic;
    EXPECT_THROW(resources.validate("box.glb"), sim::InputError);
    EXPECT_NO_THROW(resources.validate("box.glb", Positions::computed));
    resources.geometries[0].attributes[0].offset = 1;
    EXPECT_THROW(resources.validate("box.glb", Positions::computed), sim::InputError);
}

TEST(Resources, PackedAttributesHaveFourComponentsInFourBytes) {
    const auto packed = [](Resources& r) -> VertexAttribute& {
        VertexAttribute& attribute = r.geometries[0].attributes[0];
        attribute.type = ComponentType::s10_10_10_2;
        attribute.components = 4;
        attribute.stride = 4;
        return attribute;
    };
    Resources resources = good_resources();
    packed(resources);
    EXPECT_NO_THROW(resources.validate("box.glb"));
    EXPECT_EQ(resources.geometries[0].attributes[0].bytes(), 4U);
    expect_refused("4 components of s10_10_10_2 in position, not 3", [&](Resources& r) { packed(r).components = 3; });
    expect_refused("stride of at least 4 bytes in position, not 3", [&](Resources& r) { packed(r).stride = 3; });
    expect_refused("a known component type, not 9",
                   [&](Resources& r) { packed(r).type = static_cast<ComponentType>(9); });
    expect_refused("a known semantic, not 28",
                   [](Resources& r) { r.geometries[0].attributes[1].semantic = static_cast<Semantic>(semantics); });
}

TEST(Resources, LengthsThatOverflowAreRefused) {
    constexpr std::uint64_t huge = std::numeric_limits<std::uint64_t>::max();
    expect_refused("within 48 bytes", [](Resources& r) { r.geometries[0].attributes[0].offset = huge - 4; });
    expect_refused("within 48 bytes", [](Resources& r) {
        r.geometries[0].vertex_count = 4294967295U;
        r.geometries[0].attributes[0].stride = 4294967295U;
    });
    expect_refused("within 24 bytes", [](Resources& r) { r.geometries[0].index_offset = huge; });
}

TEST(Resources, UnindexedGeometryMayNotReadPastItsVertices) {
    expect_refused("at most 4 vertices", [](Resources& r) {
        r.geometries[0].index_type = IndexType::none;
        r.geometries[0].index_count = 5;
    });
}

TEST(Resources, PlacementIsAlignedAndInOrder) {
    Resources resources = good_resources();
    resources.place();
    std::uint64_t end = 0;
    for (const Buffer& buffer : resources.buffers) {
        EXPECT_EQ(buffer.address % 256, 0U);
        EXPECT_GE(buffer.address, end);
        end = buffer.address + buffer.bytes.size();
    }
    for (const Texture::Level& level : resources.textures[0].levels) {
        EXPECT_EQ(level.address % 256, 0U);
        EXPECT_GE(level.address, end);
        end = level.address + std::uint64_t{64} * ((level.width + 3) / 4) * ((level.height + 3) / 4);
    }
}

} // namespace
} // namespace pipeline
