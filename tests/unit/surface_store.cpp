// Surfaces: pages on first touch, clears, addresses, memory used.
#include "models/programs/nearest_k.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/surface.hpp"

#include <gtest/gtest.h>
#include <set>

namespace pipeline {
namespace {

SurfaceInfo colour_surface(std::uint32_t width, std::uint32_t height) {
    SurfaceInfo info{.name = "colour", .format = SurfaceFormat::rgba8, .width = width, .height = height};
    pack_colour(info.format, {0.0F, 1.0F, 0.0F, 1.0F}, info.cleared.data());
    return info;
}

TEST(SurfaceStore, TakesNoMemoryUntilSomethingIsWritten) {
    const std::vector<SurfaceInfo> list{colour_surface(100, 40)};
    SurfaceStore store(list);
    EXPECT_EQ(store.memory(0).nominal, 100U * 40 * 4);
    EXPECT_EQ(store.memory(0).allocated, 0U);
    EXPECT_EQ(unpack_texel(SurfaceFormat::rgba8, store.read(0, {99, 39})), glm::vec4(0.0F, 1.0F, 0.0F, 1.0F));
    pack_colour(SurfaceFormat::rgba8, glm::vec4(1.0F), store.written(0, {17, 20}));
    EXPECT_EQ(store.memory(0).allocated, 16U * 16 * 4);
    EXPECT_EQ(unpack_texel(SurfaceFormat::rgba8, store.read(0, {17, 20})), glm::vec4(1.0F));
    EXPECT_EQ(unpack_texel(SurfaceFormat::rgba8, store.read(0, {16, 20})), glm::vec4(0.0F, 1.0F, 0.0F, 1.0F));
}

TEST(SurfaceStore, AClearGivesThePagesBackAndRemembersTheMost) {
    const std::vector<SurfaceInfo> list{colour_surface(64, 64)};
    SurfaceStore store(list);
    for (std::uint32_t x = 0; x < 64; x += 16) *store.written(0, {x, 0}) = std::byte{9};
    store.clear(0);
    EXPECT_EQ(store.memory(0).allocated, 0U);
    EXPECT_EQ(store.memory(0).high_water, 4U * 16 * 16 * 4);
    EXPECT_EQ(*store.read(0, {0, 0}), std::byte{0});
}

TEST(SurfaceStore, ACopyHasTheSameBytesAndIsItsOwn) {
    const std::vector<SurfaceInfo> list{colour_surface(32, 32)};
    SurfaceStore store(list);
    *store.written(0, {3, 5}) = std::byte{200};
    SurfaceStore copy = store;
    EXPECT_TRUE(copy.same(store, 0, {3, 5}));
    EXPECT_EQ(copy.memory(0).allocated, store.memory(0).allocated);
    *copy.written(0, {3, 5}) = std::byte{201};
    EXPECT_FALSE(copy.same(store, 0, {3, 5}));
    EXPECT_TRUE(copy.same(store, 0, {31, 31}));
}

// No two texels of any surface, plane or level share a byte.
TEST(SurfaceStore, AddressesDoNotOverlap) {
    SurfaceInfo mipped = colour_surface(19, 7);
    mipped.levels = 5;
    SurfaceInfo planes{.name = "planes", .format = SurfaceFormat::rgba16f, .width = 5, .height = 6, .planes = 3};
    SurfaceInfo kbuffer{.name = "k-buffer", .width = 6, .height = 4};
    kbuffer.program = models::make_nearest_k(models::EntryKind::rgbz, 3);
    const std::vector<SurfaceInfo> list{mipped, planes, kbuffer};
    const SurfaceStore store(list, 1000);
    std::set<std::uint64_t> bytes;
    std::uint64_t expected = 0;
    const auto add = [&](std::uint64_t address, std::uint32_t count) {
        EXPECT_GE(address, 1000U);
        EXPECT_LE(address + count, store.end_address());
        for (std::uint32_t i = 0; i < count; ++i) bytes.insert(address + i);
        expected += count;
    };
    for (SurfaceId surface = 0; surface < 2; ++surface)
        for (std::uint32_t level = 0; level < list[surface].levels; ++level)
            for (std::uint32_t row = 0; row < store.rows(surface, level); ++row)
                for (std::uint32_t x = 0; x < list[surface].width_of(level); ++x)
                    add(store.address(surface, {x, row, level}), list[surface].texel_bytes());
    for (std::uint32_t row = 0; row < 4; ++row)
        for (std::uint32_t x = 0; x < 6; ++x)
            for (std::uint32_t target = 0; target < kbuffer.program->targets(); ++target)
                add(store.address(2, {x, row}, target), 16);
    EXPECT_EQ(bytes.size(), expected);
}

TEST(SurfaceStore, ABlockOfAKBufferIsALineForEachTarget) {
    SurfaceInfo kbuffer{.name = "k-buffer", .width = 8, .height = 8};
    kbuffer.program = models::make_nearest_k(models::EntryKind::rgbz, 4);
    const SurfaceStore store(std::vector<SurfaceInfo>{kbuffer});
    for (std::uint32_t target = 0; target < 4; ++target) {
        std::set<std::uint64_t> lines;
        for (std::uint32_t i = 0; i < 4; ++i) lines.insert(store.address(0, {2 + i % 2, 4 + i / 2}, target) / 64);
        EXPECT_EQ(lines.size(), 1U);
    }
    EXPECT_EQ(store.address(0, {0, 0}, 1) - store.address(0, {0, 0}, 0), 64U);
}

TEST(SurfaceStore, AKBufferBeginsWithItsProgramsPixel) {
    SurfaceInfo kbuffer{.name = "k-buffer", .width = 4, .height = 4};
    kbuffer.program = models::make_nearest_k(models::EntryKind::z, 4);
    SurfaceStore store(std::vector<SurfaceInfo>{kbuffer});
    std::vector<float> expected(kbuffer.program->floats_per_pixel());
    kbuffer.program->clear(expected.data());
    const auto* pixel = reinterpret_cast<const float*>(store.read(0, {1, 1}));
    EXPECT_EQ(std::vector<float>(pixel, pixel + expected.size()), expected);
    pixel = reinterpret_cast<const float*>(store.written(0, {1, 1}));
    EXPECT_EQ(std::vector<float>(pixel, pixel + expected.size()), expected);
}

} // namespace
} // namespace pipeline
