// Compressed blocks against Mesa: decoded by the library, and as llvmpipe's sampler reads them.
#include "pipeline/functional/block_compression.hpp"
#include "tests/support/oracle_textures.hpp"
#include "tests/support/texture_pictures.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>

namespace mesa_block_test {

using pipeline::SurfaceFormat;
using tests::MesaShaders;
using tests::MesaTexture;

class MesaBlocks : public testing::Test {
  protected:
    static void SetUpTestSuite() { mesa_ = MesaShaders::create(reason_).release(); }
    static void TearDownTestSuite() {
        delete mesa_;
        mesa_ = nullptr;
    }
    void SetUp() override {
        if (mesa_ == nullptr) GTEST_SKIP() << "no OpenGL to compare with: " << reason_;
    }

    static inline MesaShaders* mesa_ = nullptr;
    static inline std::string reason_;
};

MesaTexture random_blocks(SurfaceFormat format, std::uint32_t size) {
    MesaTexture texture;
    texture.surface.format = format;
    texture.surface.width = texture.surface.height = size;
    std::vector<std::byte> bytes(std::size_t{size / 4} * (size / 4) * pipeline::block_bytes_of(format));
    for (std::uint32_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::byte>(256.0F * tests::random_of("block", i));
    texture.surface.levels[0] = std::move(bytes);
    texture.sampler.min_filter = texture.sampler.mag_filter = pipeline::Filter::nearest;
    return texture;
}

constexpr std::array formats{SurfaceFormat::bc1, SurfaceFormat::bc2, SurfaceFormat::bc3};

// llvmpipe approximates what lies between two colours or alphas.
TEST_F(MesaBlocks, AreDecodedToTheSameBytesWithinItsRounding) {
    constexpr std::uint32_t size = 1024; // 65,536 blocks
    for (const SurfaceFormat format : formats) {
        const MesaTexture texture = random_blocks(format, size);
        const auto theirs = mesa_->decoded(texture);
        std::array<std::array<std::size_t, 4>, 2> counts{}; // of colours and alphas, by how far they are apart
        for (std::uint32_t y = 0; y < size; y += 4)
            for (std::uint32_t x = 0; x < size; x += 4) {
                const std::size_t number = std::size_t{y / 4} * (size / 4) + x / 4;
                const pipeline::DecodedBlock block = pipeline::decode_block(
                    format, texture.surface.levels[0].data() + number * pipeline::block_bytes_of(format));
                for (std::uint32_t i = 0; i < 16; ++i)
                    for (std::size_t c = 0; c < 4; ++c) {
                        const int own = block[i / 4][i % 4][c],
                                  other = theirs[std::size_t{y + i / 4} * size + x + i % 4][c];
                        ++counts[c / 3][static_cast<std::size_t>(std::min(std::abs(own - other), 3))];
                    }
            }
        const auto& [colours, alphas] = counts;
        EXPECT_EQ(colours[2] + colours[3], 0U) << pipeline::info_of(format).name;
        EXPECT_LE(colours[1], colours[0] / 3) << pipeline::info_of(format).name;
        EXPECT_EQ(alphas[3], 0U) << pipeline::info_of(format).name;
        EXPECT_LE(alphas[2], alphas[0] / 500) << pipeline::info_of(format).name;
        EXPECT_TRUE(format == SurfaceFormat::bc3 || alphas[1] + alphas[2] == 0) << pipeline::info_of(format).name;
        std::printf("%s: colours %zu equal, %zu one apart; alphas %zu, %zu, %zu two apart\n",
                    pipeline::info_of(format).name.data(), colours[0], colours[1], alphas[0], alphas[1], alphas[2]);
    }
}

TEST_F(MesaBlocks, AreSampledAsTheyAreDecoded) {
    const tests::LinearPlace place{{0.5F, 0.5F, 0, 0}, {0.5F, 0, 0, 0}, {0, 0.5F, 0, 0}}; // texel by pixel
    for (const SurfaceFormat format : {SurfaceFormat::bc1, SurfaceFormat::bc2, SurfaceFormat::bc3,
                                       SurfaceFormat::srgb_bc1, SurfaceFormat::srgb_bc2, SurfaceFormat::srgb_bc3}) {
        const MesaTexture texture = random_blocks(format, MesaShaders::size);
        const auto own = tests::own_texture_picture(texture, pipeline::TextureKind::plane, false, place);
        const auto theirs = tests::mesa_texture_picture(*mesa_, texture, "sampler2D", "texture(t, place.xy)", place);
        const bool encoded = pipeline::info_of(format).kind == pipeline::ChannelKind::srgb;
        // A code of 8 bits is up to 2.3 codes of linear light.
        const tests::PictureDifference difference = tests::difference_of(own, theirs, encoded ? 3 : 2);
        EXPECT_EQ(difference.pixels, 0) << pipeline::info_of(format).name << ": worst " << difference.worst << "/255";
    }
}

} // namespace mesa_block_test
