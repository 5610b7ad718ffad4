// Positions in clip space as the driver's vertex processing makes them, by transform feedback of a draw that is
// repeated without being rasterized.
#pragma once

#include "tests/replay_oracle/measure_mesa/measurement.hpp"

namespace measure {

/// Those of all primitives of this kind (GL_POINTS, GL_LINES, GL_TRIANGLES) that `draw` makes, at most `most` vertices.
/// Vertex processing without a program is that of ftransform(). Empty: not measured, as with programs that were linked
/// without this library, or that capture something of their own.
Positions captured_positions(GLenum primitives, std::uint64_t most, const std::function<void()>& draw);

/// Links the program so that it gives its positions away, where that can be.
void link_with_positions(GLuint program);
/// The program captures what it wants.
void captures_its_own(GLuint program);

} // namespace measure
