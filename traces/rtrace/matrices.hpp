// Matrices of instances as a blob: 16 floats each, column by column.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace traces::rtrace {

std::vector<std::byte> bytes_of_matrices(std::span<const glm::mat4> matrices);

/// As many as there are in the bytes.
std::vector<glm::mat4> matrices_of(std::span<const std::byte> bytes);

} // namespace traces::rtrace
