// Modify program A16, volume rendering (Bavoil 2007, section 6.3.2): sorts samples of a scalar field as A7 does and
// composites the gap between the two nearest, whose colour and extinction come from a pre-integrated table. Both ends
// of a gap must have come, so no sample may be more than k - 1 places from its sorted place.
#pragma once

#include "models/programs/preintegration.hpp"
#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/output/kbuffer.hpp"

#include <cstdint>
#include <memory>

namespace models {

struct VolumeSetup {
    std::uint32_t k = 4;                       ///< samples that are sorted
    TransferFunction transfer;                 ///< colour and extinction of a scalar
    float longest_gap = 1.0F;                  ///< of the table; distance units. Longer gaps get the colour of this one
    std::uint32_t table_scalars = 64;          ///< nodes of the table along each scalar
    std::uint32_t table_lengths = 32;          ///< and along the length
    pipeline::EyeDepth depth{glm::mat4(1.0F)}; ///< of the view's projection
};

/// Entries: distance along the view axis and scalar (the red channel of the fragment). State: red, green, blue and
/// opacity so far, premultiplied. A gap's length is the difference of the distances. Throws sim::InputError when the
/// transfer function or a number is none.
std::shared_ptr<const pipeline::ModifyProgram> make_volume(const VolumeSetup& setup);

} // namespace models
