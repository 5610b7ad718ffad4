// Meshes of tetrahedra and clouds of points with a scalar at their vertices, and the scenes that draw them.
#pragma once

#include "traces/scene.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace traces {

struct TetrahedralMesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<float> scalars; ///< one per position
    std::vector<std::array<std::uint32_t, 4>> tetrahedra;
    std::vector<std::string> notes;
};

struct PointCloud {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<float> scalars; ///< one per position
    std::vector<std::string> notes;
};

/// Every face once, however many tetrahedra share it, in the order in which the tetrahedra name them: a ray then meets
/// each face between two tetrahedra as one fragment. Faces with two equal corners are left out; those of tetrahedra
/// without volume are not.
std::vector<std::array<std::uint32_t, 3>> faces_of(const std::vector<std::array<std::uint32_t, 4>>& tetrahedra);

/// One draw of all faces, with the scalar as the red of a vertex colour (one float) and an unlit white material that
/// shows both sides. The caller names, counts and finishes the scene.
///
/// The shader bounds colours by 65504, so larger scalars are all divided by a power of two, which a note says.
Scene scene_of(TetrahedralMesh mesh);

/// The same material and layout; every three points in a row are a triangle.
Scene scene_of(PointCloud cloud);

/// For files without scalars: the distance from the middle of the bounding box, 1 at its corners. Adds a note.
void add_computed_scalars(TetrahedralMesh& mesh);

} // namespace traces
