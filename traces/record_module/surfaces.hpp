// What is sampled and drawn to, as surfaces of the recording.
//
// A texture that is only sampled is known by its content: what the program does not change is read once. One that was
// drawn to in a wanted frame is read before the first time and then known by its name, as what is in it follows from
// what was recorded, until the program puts other texels into it.
#pragma once

#include "traces/record_module/functions.hpp"
#include "traces/record_module/stream.hpp"

namespace record {

std::int32_t sampled_texture(GLuint texture, GLenum target);
/// Where draws and copies go; the surface is -1 for a buffer that is not there. `layer` is a cube's face, too.
record_stream::Target drawn_texture(GLuint texture, std::uint32_t level, std::uint32_t layer);

/// Of the framebuffer for drawing.
record_stream::Targets draw_targets();
/// Of the window.
record_stream::Targets window_targets();
/// What the framebuffer for reading reads colours from, and depths.
record_stream::Target read_target();
record_stream::Target read_depth_target();

/// The program says what kind of a texture a name is; drivers tell in core profiles alone.
void texture_has_target(GLuint texture, GLenum target);
/// The program changes the texels of a texture, or of the one bound to a target.
void texture_changed(GLuint texture);
void bound_texture_changed(GLenum target);
void renderbuffer_changed(GLuint renderbuffer);
/// Something that is not recorded changes what is drawn to: it is read again before it is used next.
void draw_targets_changed();
GLuint bound_texture(GLenum target); ///< also of a cube's face; 0: none or not known

} // namespace record
