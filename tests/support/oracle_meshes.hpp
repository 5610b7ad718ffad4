// Index lists that two counts of vertex reuse are compared on.
#pragma once

#include "tests/support/geometry_scene.hpp"

#include <vector>

namespace tests {

/// Grid, shuffled grid, sphere, random triangles, grass; with the further scenes on hand also their largest geometries:
/// bunny, dragon, Suzanne.
std::vector<IndexedMesh> oracle_meshes();

} // namespace tests
