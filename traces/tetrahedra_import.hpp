// Scenes from files of tetrahedra: legacy VTK (.vtk) and TETM (.tetm).
#pragma once

#include "traces/scene.hpp"

#include <filesystem>

namespace traces {

/// True for the extensions above, in upper or lower case.
bool is_tetrahedra_file(const std::filesystem::path& path);

/// Reads the scene of such a file: one draw of all faces, with the scalar as a colour. Throws sim::InputError with one
/// line that names file, place and what was expected.
Scene import_tetrahedra(const std::filesystem::path& path);

} // namespace traces
