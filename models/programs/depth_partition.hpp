// Modify program A14, depth partition (Bavoil 2007, section 6.2): entry j keeps the nearest fragment whose window depth
// z lies in its range, r_j <= z < r_(j+1). A fragment outside all ranges is dropped; of equal depths the first wins.
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <memory>
#include <vector>

namespace models {

/// Entries `rgbz`; an empty one has the depth `empty_depth`.
/// @param bounds k + 1 window depths, each greater than the one before. Throws sim::InputError where they are not.
std::shared_ptr<const pipeline::ModifyProgram> make_depth_partition(std::vector<float> bounds);

} // namespace models
