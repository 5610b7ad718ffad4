// Textures of recordings as OpenGL's own.
#pragma once

#include "tests/support/mesa_shaders.hpp"

namespace tests {

/// In the current context; leaves it bound to its target (GL_TEXTURE_2D and so on; no buffers). For formats that
/// OpenGL stores in the same bytes. Returns its name.
unsigned upload_texture(unsigned target, const MesaTexture& texture);

} // namespace tests
