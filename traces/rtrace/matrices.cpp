#include "traces/rtrace/matrices.hpp"

#include "traces/rtrace/little_endian.hpp"

#include <bit>
#include <cstdint>

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

} // namespace traces::rtrace
