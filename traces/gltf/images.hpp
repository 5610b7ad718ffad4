// Images of a glTF file.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/gltf/document.hpp"

namespace traces::gltf {

/// Decodes an image (PNG or JPEG) to RGBA8. Throws sim::InputError for a missing file, data that is no image, and
/// images of more than 16384 texels along a side.
pipeline::Texture::Level decode_image(const Document& document, int image);

} // namespace traces::gltf
