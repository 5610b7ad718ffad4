// Surfaces as OpenGL describes them, and the bytes in them.
#pragma once

#include "traces/record_module/functions.hpp"
#include "traces/record_module/stream.hpp"

#include <string>

namespace record {

/// With all levels; `levels` stays empty where the texture has none.
record_stream::Surface describe_texture(GLuint texture, GLenum target);

/// An attachment of a framebuffer (0: the window's), read by glReadPixels where it has one sample a pixel.
record_stream::Surface describe_attachment(GLuint framebuffer, GLenum attachment, std::uint32_t width,
                                           std::uint32_t height);

} // namespace record
