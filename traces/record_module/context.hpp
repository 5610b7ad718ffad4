// The context that a call goes to, and reading from it without a trace.
#pragma once

#include "traces/record_module/functions.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace record {

struct ContextFacts {
    std::uint64_t number = 0; ///< another one for each context that was ever there; 0: none is current
    bool usable = false;      ///< state can be read as below: desktop OpenGL 4.5 or later
    bool compatibility = false;
    std::string version, renderer;
};

/// Of the calling thread.
const ContextFacts& current_context();
/// The next context at this address is another one.
void forget_context(const void* context);

struct Size {
    std::uint32_t width = 0, height = 0;
    bool operator==(const Size&) const = default;
};
/// The window or other drawable that is current, as the window system names it; contexts may share it.
std::uint64_t current_drawable();
/// Its size. Asked of the window system once a frame.
Size drawable_size();
void forget_drawable_sizes();

/// While it lives, errors of ours are not the program's, and its own one is kept for it.
class Quiet {
  public:
    Quiet();
    ~Quiet();
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
};
/// What glGetError says to the program.
GLenum take_error();

/// While it lives, pixels are read without gaps into the memory of the process.
class PlainPacking {
  public:
    PlainPacking();
    ~PlainPacking();
    PlainPacking(const PlainPacking&) = delete;
    PlainPacking& operator=(const PlainPacking&) = delete;

  private:
    GLint buffer_ = 0;
    std::array<GLint, 8> kept_{};
};

GLint integer(GLenum name);
GLint integer_at(GLenum name, GLuint index);

} // namespace record
