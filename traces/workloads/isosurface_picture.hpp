// The picture of an isosurface program: lit surfaces with silhouettes.
#pragma once

#include "models/programs/picture_shader.hpp"

namespace traces {

/// Normals from central differences of the distances, Lambert's law with the lamp at the eye, dark lines along
/// silhouettes (Bavoil 2007, section 6.3.1). Each iso-value has a colour of its own.
models::MakePicture isosurface_picture(bool silhouettes);

} // namespace traces
