// What the scenarios of draws_with_opengl share.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>

#include <GL/glext.h>

#include <array>
#include <map>
#include <string>

namespace scenarios {

inline constexpr int width = 64, height = 48; ///< of the window

/// A program whose attribute "place" has number 3.
GLuint linked(const char* vertex, const char* fragment);
/// Colours and depths of what is drawn to.
void clear();

/// Scenarios by name, each a frame.
std::map<std::string, void (*)()> of_states();

} // namespace scenarios
