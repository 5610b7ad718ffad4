// A small mesh with every attribute, and states of vertex and fragment processing without shaders, by chance.
#pragma once

#include "sim/random.hpp"
#include "traces/recording/fixed_function.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace tests {

struct FixedFunctionMesh {
    std::vector<glm::vec4> positions, colours;
    std::vector<glm::vec3> normals, secondary_colours;
    std::array<std::vector<glm::vec4>, traces::fixed_function_units> texcoords;
    std::vector<float> fog_coordinates;
    std::vector<std::uint32_t> indices; ///< of triangles that do not overlap; every other one faces away
};

/// A wavy square around the origin, with `side` vertices along each side.
FixedFunctionMesh wavy_square(std::uint32_t side, sim::Random& random);

/// Lit or not, with up to three textures, and one or another of all other features.
traces::FixedFunctionState random_fixed_function(sim::Random& random);

} // namespace tests
