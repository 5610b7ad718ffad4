// What the passes of a frame need of the machine, and what they leave out.
#pragma once

#include "pipeline/frame.hpp"

#include <cstdint>

namespace traces {

/// What the draws of a frame's passes offer to be used.
struct Offers {
    bool indices = false;
    bool alpha_test = false;
    bool alpha_in_mask = false; ///< a tested alpha comes from vertex colours, too
    bool textured_mask = false;
    bool normals = false;     ///< of lit materials
    bool any_normals = false; ///< of any material
    bool vertex_colours = false;
    bool textures = false;        ///< with coordinates to read them at
    std::uint32_t attributes = 0; ///< all that the geometries have: bits as in mask_of(Semantic)
};

Offers offers_of(const pipeline::Frame& frame);

/// `colour` is what passes without an own shader ask of materials.
pipeline::Needs needs_of(const pipeline::Frame& frame, const Offers& offers, pipeline::FragmentColour colour);

/// Appends to frame.left_out what frame.needs does not ask for, and why.
void list_left_out(pipeline::Frame& frame, const Offers& offers);

} // namespace traces
