// The words of pipeline/shader.hpp, for files in which shaders are written.
#pragma once

#include "pipeline/shader.hpp"

namespace traces {

using pipeline::LaneIndices;
using pipeline::QuadPlaces;
using pipeline::QuadTexels;
using pipeline::ShaderInput;
using pipeline::ShaderOutput;
using pipeline::ShaderShape;
using pipeline::SurfaceAccess;

} // namespace traces
