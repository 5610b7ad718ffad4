// What surfaces hold before anything is drawn: bytes by level and plane, compressed blocks, buffers, volumes.
#include "pipeline/frame.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/surface.hpp"
#include "sim/check.hpp"

#include <cstring>
#include <gtest/gtest.h>
#include <set>

namespace surface_contents_test {

using namespace pipeline;

/// Bytes that count upwards.
std::vector<std::byte> counting(std::size_t count, unsigned first = 0) {
    std::vector<std::byte> bytes(count);
    for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(first + i * 7);
    return bytes;
}

std::string refusal(const SurfaceInfo& info, const std::vector<SharedBytes>& levels) {
    try {
        make_contents(info, levels);
    } catch (const sim::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(SurfaceContents, BytesLieByLevelPlaneRowAndTexel) {
    SurfaceInfo info{.name = "t", .format = SurfaceFormat::rg8, .width = 19, .height = 5, .planes = 3, .levels = 2};
    const std::vector<SharedBytes> levels{counting(std::size_t{19} * 5 * 3 * 2),
                                          counting(std::size_t{9} * 2 * 3 * 2, 100)};
    info.contents = make_contents(info, levels);
    const SurfaceStore store(std::span(&info, 1));
    for (std::uint32_t level = 0; level < 2; ++level)
        for (std::uint32_t plane = 0; plane < 3; ++plane)
            for (std::uint32_t y = 0; y < info.height_of(level); ++y)
                for (std::uint32_t x = 0; x < info.width_of(level); ++x) {
                    const std::size_t texel =
                        (std::size_t{plane} * info.height_of(level) + y) * info.width_of(level) + x;
                    const std::byte* read = store.read(0, {x, plane * info.rows_between_planes(level) + y, level});
                    ASSERT_EQ(std::memcmp(read, &levels[level][2 * texel], 2), 0) << level << ' ' << plane;
                }
}

TEST(SurfaceContents, StoresShareThemUntilTheyWrite) {
    SurfaceInfo info{.name = "t", .format = SurfaceFormat::r8, .width = 32, .height = 16};
    info.cleared[0] = std::byte{9};
    info.contents = make_contents(info, {counting(std::size_t{32} * 16)});
    SurfaceStore store(std::span(&info, 1)), other(std::span(&info, 1));
    EXPECT_EQ(store.read(0, {5, 0}), other.read(0, {5, 0})); // the same memory
    EXPECT_EQ(store.memory(0).allocated, 2U * 256);
    EXPECT_EQ(store.digest(0), other.digest(0));
    *store.written(0, {5, 0}) = std::byte{77};
    EXPECT_EQ(*store.read(0, {6, 0}), std::byte{6 * 7});
    EXPECT_EQ(*other.read(0, {5, 0}), std::byte{5 * 7});
    EXPECT_EQ(store.differences(other, 0), 1U);
    EXPECT_NE(store.digest(0), other.digest(0));
    *store.written(0, {5, 0}) = std::byte{5 * 7};
    EXPECT_EQ(store.digest(0), other.digest(0));
    store.clear(0);
    EXPECT_EQ(*store.read(0, {5, 0}), std::byte{9});
    EXPECT_EQ(store.memory(0).allocated, 0U);
    EXPECT_EQ(store.memory(0).high_water, 2U * 256);
    EXPECT_EQ(*SurfaceStore(std::span(&info, 1)).read(0, {5, 0}), std::byte{5 * 7});
}

TEST(SurfaceContents, ContentsOfTheClearedValueAreNoDifference) {
    SurfaceInfo info{.name = "t", .format = SurfaceFormat::r8, .width = 5, .height = 3};
    info.cleared[0] = std::byte{9};
    const SurfaceStore cleared(std::span(&info, 1));
    info.contents = make_contents(info, {std::vector<std::byte>(15, std::byte{9})});
    const SurfaceStore filled(std::span(&info, 1));
    EXPECT_EQ(filled.digest(0), cleared.digest(0));
    EXPECT_EQ(filled.differences(cleared, 0), 0U);
}

TEST(SurfaceContents, LevelsWithoutBytesHoldZero) {
    SurfaceInfo info{.name = "t", .format = SurfaceFormat::r8, .width = 40, .height = 40, .levels = 2};
    info.contents = make_contents(info, {{}, counting(400)});
    EXPECT_EQ(SurfaceStore(std::span(&info, 1)).memory(0).allocated, 4U * 256); // of level 1
    info.cleared[0] = std::byte{9};
    info.contents = make_contents(info, {{}, counting(400)});
    EXPECT_EQ(*SurfaceStore(std::span(&info, 1)).read(0, {39, 39}), std::byte{0});
}

TEST(SurfaceContents, OtherNumbersOfBytesAreRefused) {
    const SurfaceInfo info{.name = "wall", .format = SurfaceFormat::rgba8, .width = 4, .height = 4, .levels = 2};
    EXPECT_EQ(refusal(info, {counting(64), counting(15)}), "surface 'wall': level 1 has 15 bytes, expected 16");
    EXPECT_EQ(refusal(info, {{}, {}, {}}), "surface 'wall': contents of 3 levels, expected 2 at most");
    SurfaceInfo blocks = info;
    blocks.format = SurfaceFormat::bc3;
    blocks.width = 5;
    EXPECT_EQ(refusal(blocks, {counting(16)}), "surface 'wall': level 0 has 16 bytes, expected 32");
    EXPECT_EQ(refusal(blocks, {counting(32), counting(16)}), "");
}

TEST(SurfaceContents, CompressedTexelsHaveTheAddressesOfTheirBlocks) {
    SurfaceInfo info{.name = "t", .format = SurfaceFormat::bc1, .width = 10, .height = 6, .planes = 2, .levels = 4};
    EXPECT_EQ(info.nominal_bytes(), 2U * 8 * (3 * 2 + 2 * 1 + 1 + 1));
    // The first block of the second row of blocks of plane 1 is white, all others black.
    std::vector<std::byte> bytes(std::size_t{12} * 8);
    for (std::size_t i = 0; i < 4; ++i) bytes[9 * 8 + i] = std::byte{0xFF};
    info.contents = make_contents(info, {bytes});
    const SurfaceStore store(std::span(&info, 1), 1000);
    std::set<std::uint64_t> lines;
    for (std::uint32_t plane = 0; plane < 2; ++plane)
        for (std::uint32_t y = 0; y < 6; ++y)
            for (std::uint32_t x = 0; x < 10; ++x) {
                const std::uint32_t row = plane * 16 + y;
                const bool white = plane == 1 && y >= 4 && x < 4;
                const glm::vec4 texel = unpack_texel(info.format, store.read(0, {x, row}));
                EXPECT_EQ(texel, white ? glm::vec4(1.0F) : glm::vec4(0, 0, 0, 1));
                EXPECT_EQ(store.address(0, {x, row}), 1024 + std::uint64_t{row / 4 * 3 + x / 4} * 8);
            }
    EXPECT_EQ(store.memory(0).allocated, 2U * 16 * 8); // pages of 16 blocks; levels without bytes have none
    EXPECT_EQ(store.end_address(), store.end_of(0));
}

TEST(SurfaceContents, CompressedSurfacesAreNotWritten) {
    const SurfaceInfo info{.name = "t", .format = SurfaceFormat::bc2, .width = 4, .height = 4};
    SurfaceStore store(std::span(&info, 1));
    EXPECT_THROW(store.written(0, {0, 0}), sim::InternalError);
    EXPECT_NO_THROW(store.clear(0));
}

TEST(SurfaceContents, PassesThatWouldWriteToCompressedSurfacesAreRefused) {
    Frame frame;
    frame.surfaces = {SurfaceInfo{.name = "wall", .format = SurfaceFormat::srgb_bc1}};
    Pass pass;
    pass.name = "paint";
    pass.reads = {0};
    frame.passes = {pass};
    EXPECT_NO_THROW(frame.check_targets());
    frame.passes[0].targets = {no_surface, 0};
    try {
        frame.check_targets();
        FAIL() << "it is accepted";
    } catch (const sim::InputError& error) {
        EXPECT_STREQ(error.what(), "pass 'paint': surface 'wall' is of format srgb_bc1, which is read only");
    }
}

TEST(SurfaceContents, BuffersAreOneRowWithoutGaps) {
    SurfaceInfo info{.name = "b", .format = SurfaceFormat::rgba16f, .width = 5000, .shape = SurfaceShape::row};
    info.contents = make_contents(info, {counting(std::size_t{5000} * 8)});
    const SurfaceStore store(std::span(&info, 1));
    EXPECT_EQ(store.memory(0).nominal, 40'000U);
    EXPECT_EQ(store.memory(0).allocated, 20U * 256 * 8);
    for (const std::uint32_t x : {0U, 255U, 256U, 4999U}) {
        EXPECT_EQ(store.address(0, {x, 0}), std::uint64_t{x} * 8);
        EXPECT_EQ(*store.read(0, {x, 0}), static_cast<std::byte>(x * 8 * 7));
    }
    EXPECT_EQ(store.end_address(), 40'000U);
}

TEST(SurfaceContents, SlicesOfAVolumeHalveWithTheLevels) {
    SurfaceInfo info{.name = "v", .format = SurfaceFormat::r8, .width = 4, .height = 4, .planes = 6, .levels = 3};
    info.shape = SurfaceShape::volume;
    EXPECT_EQ(info.nominal_bytes(), 4U * 4 * 6 + 2 * 2 * 3 + 1);
    info.contents = make_contents(info, {counting(96), counting(12), counting(1, 200)});
    const SurfaceStore store(std::span(&info, 1));
    EXPECT_EQ(*store.read(0, {1, 2 * 16 + 1, 1}), static_cast<std::byte>(11 * 7));
    EXPECT_EQ(*store.read(0, {0, 0, 2}), std::byte{200});
    EXPECT_EQ(store.rows(0, 1), 48U);
}

} // namespace surface_contents_test
