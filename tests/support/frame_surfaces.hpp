// Surfaces of a replayed frame that are not its picture.
#pragma once

#include "tests/support/replay.hpp"

#include <string>
#include <vector>

namespace support {

/// As the reference leaves them after the last pass.
pipeline::SurfaceStore surfaces_of(const Replay& replay);

/// RGBA of the surface of that name, four floats a place in row order; none, with a failed test, where there is none.
std::vector<float> colours_named(const Replay& replay, const pipeline::SurfaceStore& surfaces, const std::string& name);

} // namespace support
