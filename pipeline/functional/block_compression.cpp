#include "pipeline/functional/block_compression.hpp"

#include "sim/check.hpp"

namespace pipeline {

namespace {

using Rgba = std::array<std::uint8_t, 4>;

/// `bytes` bytes, the lowest first.
std::uint64_t code_bits(const std::byte* source, std::size_t bytes) {
    std::uint64_t bits = 0;
    for (std::size_t i = bytes; i-- > 0;) bits = bits << 8U | static_cast<std::uint64_t>(source[i]);
    return bits;
}

/// A colour of 5, 6 and 5 bits; the upper bits of a channel fill its lower ones.
Rgba expanded(std::uint32_t colour) {
    const std::uint32_t red = colour >> 11U, green = colour >> 5U & 63U, blue = colour & 31U;
    return {static_cast<std::uint8_t>(red << 3U | red >> 2U), static_cast<std::uint8_t>(green << 2U | green >> 4U),
            static_cast<std::uint8_t>(blue << 3U | blue >> 2U), 255};
}

/// `a` and `b` in the shares of these weights, to the nearest; halves go up.
std::uint8_t mixed(std::uint32_t a, std::uint32_t b, std::uint32_t weight_a, std::uint32_t weight_b) {
    const std::uint32_t sum = weight_a + weight_b;
    return static_cast<std::uint8_t>((a * weight_a + b * weight_b + sum / 2) / sum);
}
Rgba mixed(const Rgba& a, const Rgba& b, std::uint32_t weight_a, std::uint32_t weight_b) {
    Rgba result{};
    for (std::size_t i = 0; i < 4; ++i) result[i] = mixed(a[i], b[i], weight_a, weight_b);
    return result;
}

/// The colours that the codes 0 to 3 stand for.
std::array<Rgba, 4> colours_of_block(const std::byte* block, bool always_four) {
    const auto first = static_cast<std::uint32_t>(code_bits(block, 2)),
               second = static_cast<std::uint32_t>(code_bits(block + 2, 2));
    const Rgba a = expanded(first), b = expanded(second);
    if (always_four || first > second) return {a, b, mixed(a, b, 2, 1), mixed(a, b, 1, 2)};
    return {a, b, mixed(a, b, 1, 1), Rgba{0, 0, 0, 0}};
}

/// The alphas that the codes 0 to 7 stand for.
std::array<std::uint8_t, 8> alphas_of_block(const std::byte* block) {
    const auto first = static_cast<std::uint8_t>(block[0]), second = static_cast<std::uint8_t>(block[1]);
    std::array<std::uint8_t, 8> alphas{first, second};
    const std::uint32_t steps = first > second ? 7 : 5;
    for (std::uint32_t i = 1; i < steps; ++i) alphas[i + 1] = mixed(first, second, steps - i, i);
    if (steps == 5) alphas[7] = 255; // and code 6 is 0
    return alphas;
}

template <class Use>
void for_each_texel(DecodedBlock& texels, Use use) {
    for (std::uint32_t i = 0; i < 16; ++i) use(texels[i / 4][i % 4], i);
}

} // namespace

DecodedBlock decode_block(SurfaceFormat format, const std::byte* block) {
    CHECK(is_compressed(format));
    const bool bc1 = block_bytes_of(format) == 8;
    const std::byte* colour_part = bc1 ? block : block + 8;
    const std::array<Rgba, 4> colours = colours_of_block(colour_part, !bc1);
    const std::uint64_t codes = code_bits(colour_part + 4, 4);
    DecodedBlock texels;
    for_each_texel(texels, [&](Rgba& texel, std::uint32_t i) { texel = colours[codes >> 2 * i & 3U]; });
    if (format == SurfaceFormat::bc2 || format == SurfaceFormat::srgb_bc2) {
        const std::uint64_t nibbles = code_bits(block, 8);
        for_each_texel(texels, [&](Rgba& texel, std::uint32_t i) {
            texel[3] = static_cast<std::uint8_t>((nibbles >> 4 * i & 15U) * 17);
        });
    } else if (!bc1) {
        const std::array<std::uint8_t, 8> alphas = alphas_of_block(block);
        const std::uint64_t indices = code_bits(block + 2, 6);
        for_each_texel(texels, [&](Rgba& texel, std::uint32_t i) { texel[3] = alphas[indices >> 3 * i & 7U]; });
    }
    return texels;
}

} // namespace pipeline
