// The picture of an isosurface program: lit surfaces with silhouettes.
#pragma once

#include "pipeline/resolve.hpp"

#include <memory>

namespace traces {

/// Normals from central differences of the distances, Lambert's law with the lamp at the eye, dark lines along
/// silhouettes (Bavoil 2007, section 6.3.1). Each iso-value has a colour of its own.
std::shared_ptr<const pipeline::Resolve> make_isosurface_picture(bool silhouettes);

} // namespace traces
