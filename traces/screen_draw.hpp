// The draw that stands for a full-screen pass.
#pragma once

#include "pipeline/frame.hpp"

namespace traces {

/// A draw without content: three vertices in one point. What covers the screen behind it is up to who draws it; its
/// vertices cost what three vertices cost. Appends a buffer and a material to `resources`; the geometry is not yet part
/// of them.
struct BlankDraw {
    pipeline::Geometry geometry;
    pipeline::Draw draw; ///< its `geometry` is not set
};
BlankDraw add_blank_draw(pipeline::Resources& resources, const char* name);

/// Gives the frame resources of its own with such a draw, and makes it frame.screen_draw.
void add_screen_draw(pipeline::Frame& frame);

} // namespace traces
