// The binary tetrahedral format "TETM", version 1: little-endian, without padding.
//
//   char[4] magic, u32 version, u32 vertices V, u32 tetrahedra T, f32 scalar minimum, f32 scalar maximum,
//   f32[3 V] positions, f32[V] scalars, u32[4 T] vertices of the tetrahedra
#pragma once

#include "traces/tetrahedra/input_bytes.hpp"
#include "traces/tetrahedra/tetrahedral_mesh.hpp"

namespace traces {

/// Throws sim::InputError for anything else, and for lengths, indices and numbers that cannot be.
TetrahedralMesh read_tetm(InputBytes file);

} // namespace traces
