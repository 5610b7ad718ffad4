// Compressed blocks by hand.
#include "pipeline/functional/block_compression.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <initializer_list>
#include <vector>

namespace block_compression_test {

using namespace pipeline;

using Rgba = std::array<std::uint8_t, 4>;

std::vector<std::byte> bytes_of_block(std::initializer_list<unsigned> values) {
    std::vector<std::byte> bytes;
    for (const unsigned value : values) bytes.push_back(static_cast<std::byte>(value));
    return bytes;
}

/// Red 0xF800 before blue 0x001F; the columns of each row have the codes 0, 1, 2, 3.
const std::initializer_list<unsigned> red_then_blue{0x00, 0xF8, 0x1F, 0x00, 0xE4, 0xE4, 0xE4, 0xE4};

TEST(BlockCompression, FourColoursWhereTheFirstIsGreater) {
    const DecodedBlock texels = decode_block(SurfaceFormat::bc1, bytes_of_block(red_then_blue).data());
    for (const auto& row : texels) {
        EXPECT_EQ(row[0], (Rgba{255, 0, 0, 255}));
        EXPECT_EQ(row[1], (Rgba{0, 0, 255, 255}));
        EXPECT_EQ(row[2], (Rgba{170, 0, 85, 255}));
        EXPECT_EQ(row[3], (Rgba{85, 0, 170, 255}));
    }
}

TEST(BlockCompression, ThreeColoursAndNothingWhereItIsNot) {
    // Blue before red; and two equal colours.
    for (const unsigned second : {0xF8U, 0x00U}) {
        const std::vector<std::byte> block =
            bytes_of_block({0x1F, 0x00, second == 0 ? 0x1FU : 0U, second, 0xE4, 0xE4, 0xE4, 0xE4});
        const DecodedBlock texels = decode_block(SurfaceFormat::bc1, block.data());
        EXPECT_EQ(texels[3][0], (Rgba{0, 0, 255, 255}));
        EXPECT_EQ(texels[3][2], second == 0 ? (Rgba{0, 0, 255, 255}) : (Rgba{128, 0, 128, 255}));
        EXPECT_EQ(texels[3][3], (Rgba{0, 0, 0, 0}));
    }
}

TEST(BlockCompression, UpperBitsFillLowerOnes) {
    // Red 10101, green 010110, blue 00001.
    const DecodedBlock texels = decode_block(SurfaceFormat::bc1, bytes_of_block({0xC1, 0xAA, 0, 0, 0, 0, 0, 0}).data());
    EXPECT_EQ(texels[0][0], (Rgba{0b10101101, 0b01011001, 0b00001000, 255}));
}

TEST(BlockCompression, CodesGoAlongRowsFromTheFirst) {
    // Code 1 at column 1 of row 0 and column 2 of row 3.
    const DecodedBlock texels =
        decode_block(SurfaceFormat::srgb_bc1, bytes_of_block({0x00, 0xF8, 0x1F, 0x00, 0x04, 0x00, 0x00, 0x10}).data());
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column) {
            const bool blue = (row == 0 && column == 1) || (row == 3 && column == 2);
            EXPECT_EQ(texels[row][column][2], blue ? 255 : 0);
        }
}

TEST(BlockCompression, ExplicitAlphasHaveFourBits) {
    std::vector<std::byte> block = bytes_of_block({0x10, 0x32, 0x54, 0x76, 0x98, 0xBA, 0xDC, 0xFE});
    // Blue before red: four colours all the same.
    const auto colours = bytes_of_block({0x1F, 0x00, 0x00, 0xF8, 0xFF, 0xFF, 0xFF, 0xFF});
    block.insert(block.end(), colours.begin(), colours.end());
    for (const SurfaceFormat format : {SurfaceFormat::bc2, SurfaceFormat::srgb_bc2}) {
        const DecodedBlock texels = decode_block(format, block.data());
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_EQ(texels[i / 4][i % 4], (Rgba{170, 0, 85, static_cast<std::uint8_t>(17 * i)}));
    }
}

TEST(BlockCompression, InterpolatedAlphasHaveSevenOrFiveSteps) {
    // Codes 0 to 7, then 0 to 7 again: three bits each, the lowest first.
    const auto alphas_of = [](unsigned first, unsigned second) {
        std::vector<std::byte> block =
            bytes_of_block({first, second, 0x88, 0xC6, 0xFA, 0x88, 0xC6, 0xFA, 0, 0, 0, 0, 0, 0, 0, 0});
        const DecodedBlock texels = decode_block(SurfaceFormat::bc3, block.data());
        std::vector<int> alphas;
        for (std::size_t i = 0; i < 16; ++i) alphas.push_back(texels[i / 4][i % 4][3]);
        EXPECT_TRUE(std::equal(alphas.begin(), alphas.begin() + 8, alphas.begin() + 8));
        alphas.resize(8);
        return alphas;
    };
    EXPECT_EQ(alphas_of(210, 70), (std::vector<int>{210, 70, 190, 170, 150, 130, 110, 90}));
    EXPECT_EQ(alphas_of(50, 150), (std::vector<int>{50, 150, 70, 90, 110, 130, 0, 255}));
    EXPECT_EQ(alphas_of(9, 9), (std::vector<int>{9, 9, 9, 9, 9, 9, 0, 255}));
}

} // namespace block_compression_test
