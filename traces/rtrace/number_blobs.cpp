#include "traces/rtrace/number_blobs.hpp"

#include "traces/rtrace/little_endian.hpp"

#include <bit>

namespace traces::rtrace {

namespace {

constexpr std::size_t floats_each = 16;

} // namespace

std::vector<std::byte> bytes_of_matrices(std::span<const glm::mat4> matrices) {
    std::vector<std::byte> bytes(matrices.size() * floats_each * 4);
    std::byte* at = bytes.data();
    for (const glm::mat4& matrix : matrices)
        for (int i = 0; i < 16; ++i, at += 4) put_little(at, std::bit_cast<std::uint32_t>(matrix[i / 4][i % 4]));
    return bytes;
}

std::vector<glm::mat4> matrices_of(std::span<const std::byte> bytes) {
    std::vector<glm::mat4> matrices(bytes.size() / (floats_each * 4));
    const std::byte* at = bytes.data();
    for (glm::mat4& matrix : matrices)
        for (int i = 0; i < 16; ++i, at += 4)
            matrix[i / 4][i % 4] = std::bit_cast<float>(get_little<std::uint32_t>(at));
    return matrices;
}

std::vector<std::byte> bytes_of_words(std::span<const std::uint32_t> words) {
    std::vector<std::byte> bytes(words.size() * 4);
    for (std::size_t i = 0; i < words.size(); ++i) put_little(&bytes[4 * i], words[i]);
    return bytes;
}

std::vector<std::uint32_t> words_of(std::span<const std::byte> bytes) {
    std::vector<std::uint32_t> words(bytes.size() / 4);
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = get_little<std::uint32_t>(&bytes[4 * i]);
    return words;
}

} // namespace traces::rtrace
