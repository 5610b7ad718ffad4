// Recorded frames for tests: one that has something of everything, and a small one to begin with.
#pragma once

#include "traces/recording/recording.hpp"
#include "traces/trace.hpp"

#include <cstdint>
#include <vector>

namespace support {

/// A vertex shader "gl_Position = transform * position" and a fragment shader "colour = tint * texture(image, place)"
/// with place = vec2(0.5).
std::vector<std::uint32_t> transforming_shader();
std::vector<std::uint32_t> tinting_shader();

/// One frame of 16 x 12 pixels: the window is cleared, then a quad of two triangles is drawn in it with these shaders.
traces::Recording quad_recording();

/// Every value of every enumeration; optional parts that are there and that are not; every kind of surface and every
/// format; equal contents under several names; two frames, the second with a hundred draws.
traces::Recording rich_recording();

/// As a trace.
traces::Trace recorded_trace(traces::Recording recording);

} // namespace support
