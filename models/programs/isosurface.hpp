// Modify program A15, isosurfaces (Bavoil 2007, section 6.3.1): sorts samples of a scalar field as A7 does and looks
// for iso-values between the two nearest; what it finds is tested against the nearest hit so far. Both ends of a
// segment must have come, so no sample may be more than k - 1 places from its sorted place.
//
// A segment from s1 to s2 hits the iso-value v when one of them lies below v and the other does not. A value that is
// exactly v belongs to what lies above, so a crossing at a sample is counted once, in one of its two segments.
#pragma once

#include "pipeline/functional/eye_depth.hpp"
#include "pipeline/output/kbuffer.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace models {

struct IsosurfaceSetup {
    std::uint32_t k = 4;                       ///< samples that are sorted
    std::vector<float> iso_values = {0.5F};    ///< any number of them, at least one
    pipeline::EyeDepth depth{glm::mat4(1.0F)}; ///< of the view's projection
};

/// Floats of the pixel's state, in this order, behind k entries of two floats: distance and scalar.
struct IsosurfaceState {
    float distance = 0; ///< of the nearest hit, along the view axis; empty_depth where there is none
    float iso = -1;     ///< index of its iso-value; -1 where there is none
    float hits = 0;     ///< crossings so far, of all iso-values
    float slope = 0;    ///< 1 where the scalar grows with the distance at the nearest hit, -1 where it falls
};

/// The scalar of a fragment is its red channel. An entry without a sample has the distance `sentinel_depth`.
/// Throws sim::InputError for iso-values that are none.
std::shared_ptr<const pipeline::ModifyProgram> make_isosurface(const IsosurfaceSetup& setup);

/// The state of a pixel of such a program.
IsosurfaceState isosurface_state(const pipeline::ModifyProgram& program, const float* pixel);

} // namespace models
