// Numbers as blobs: matrices of instances, 16 floats each, column by column; words of 32 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace traces::rtrace {

std::vector<std::byte> bytes_of_matrices(std::span<const glm::mat4> matrices);
std::vector<std::byte> bytes_of_words(std::span<const std::uint32_t> words);

/// As many as there are in the bytes.
std::vector<glm::mat4> matrices_of(std::span<const std::byte> bytes);
std::vector<std::uint32_t> words_of(std::span<const std::byte> bytes);

} // namespace traces::rtrace
