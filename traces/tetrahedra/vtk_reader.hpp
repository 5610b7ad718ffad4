// Legacy VTK files: unstructured grids of tetrahedra with a scalar at their points.
//
// Read: ASCII and BINARY (big-endian); POINTS of any numeric type; CELLS as counts and indices (versions 1 to 4) and as
// OFFSETS and CONNECTIVITY (version 5); CELL_TYPES; the first POINT_DATA SCALARS (of several components the first),
// else the first FIELD array of one component. Cells that are no tetrahedra are left out, with a note. Skipped: other
// attributes (colours, normals, texture coordinates, ids), cell data, metadata. Source: "VTK File Formats",
// docs.vtk.org, section "Simple Legacy Formats".
#pragma once

#include "traces/tetrahedra/input_bytes.hpp"
#include "traces/tetrahedra/tetrahedral_mesh.hpp"

namespace traces {

/// Throws sim::InputError for anything else, and for lengths, indices and numbers that cannot be.
TetrahedralMesh read_vtk(InputBytes file);

} // namespace traces
