// Images of a glTF file.
#pragma once

#include "pipeline/draw.hpp"
#include "traces/gltf/document.hpp"

#include <functional>

namespace traces::gltf {

/// An image whose header was read.
struct EncodedImage {
    std::uint32_t width = 0, height = 0;
    std::function<std::vector<std::uint8_t>()> decode; ///< its texels, RGBA8; throws sim::InputError for broken data
};

/// PNG, JPEG or WebP. Throws sim::InputError for a missing file, data of another kind (KTX2 is named), and images of
/// more than 16384 texels along a side.
EncodedImage encoded_image(const Document& document, int image);

/// The same for later, when the document may be gone: what is wrong with the image is thrown then.
std::function<EncodedImage()> late_image(const Document& document, int image);

} // namespace traces::gltf
