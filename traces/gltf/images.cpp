#include "traces/gltf/images.hpp"

#include <cstdint>
#include <cstring>
#include <span>

namespace traces::gltf {

namespace {

using Bytes = std::span<const unsigned char>;

constexpr std::uint32_t largest_image = 16384;

struct Size {
    std::uint32_t width = 0, height = 0;
};

std::uint32_t big_endian(Bytes bytes, std::size_t offset, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8U | bytes[offset + i];
    return value;
}

// The frame header (SOF0 to SOF15, less the three markers that mean something else) of a JPEG file.
Size jpeg_size(Bytes bytes) {
    for (std::size_t offset = 2; offset + 9 < bytes.size() && bytes[offset] == 0xff;) {
        const unsigned marker = bytes[offset + 1];
        if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc)
            return {big_endian(bytes, offset + 7, 2), big_endian(bytes, offset + 5, 2)};
        offset += marker == 0xff ? 1 : 2 + big_endian(bytes, offset + 2, 2);
    }
    return {};
}

/// What the header says; 0x0 when it is neither PNG nor JPEG. Known before anything is allocated for the texels.
Size size_in_header(Bytes bytes) {
    static constexpr unsigned char png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (bytes.size() >= 24 && std::memcmp(bytes.data(), png, sizeof png) == 0)
        return {big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
    if (bytes.size() >= 4 && bytes[0] == 0xff && bytes[1] == 0xd8) return jpeg_size(bytes);
    return {};
}

Bytes encoded_bytes(const Document& document, const tinygltf::Image& image, std::string_view place) {
    if (image.bufferView < 0) {
        document.require(!image.image.empty(), place, "a readable file '{}'", image.uri);
        return image.image;
    }
    return document.view_bytes(image.bufferView, place);
}

std::vector<std::uint8_t> as_rgba8(const tinygltf::Image& decoded) {
    if (decoded.bits == 8) return decoded.image;
    std::vector<std::uint8_t> rgba(decoded.image.size() / 2);
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        std::uint16_t value = 0;
        std::memcpy(&value, decoded.image.data() + 2 * i, sizeof value);
        rgba[i] = static_cast<std::uint8_t>((value * 255U + 32767U) / 65535U);
    }
    return rgba;
}

} // namespace

pipeline::Texture::Level decode_image(const Document& document, int index) {
    const tinygltf::Image& source = document.at(document.model().images, index, "textures", "image");
    const std::string place = place_of("image", static_cast<std::size_t>(index), source.name);
    const Bytes bytes = encoded_bytes(document, source, place);
    const Size size = size_in_header(bytes);
    document.require(size.width >= 1 && size.height >= 1, place, "PNG or JPEG data");
    document.require(size.width <= largest_image && size.height <= largest_image, place,
                     "at most {0}x{0} texels, got {1}x{2}", largest_image, size.width, size.height);

    tinygltf::Image decoded;
    std::string error, warning;
    const bool good = tinygltf::LoadImageData(&decoded, index, &error, &warning, 0, 0, bytes.data(),
                                              static_cast<int>(bytes.size()), nullptr);
    document.require(good && decoded.component == 4, place, "PNG or JPEG data that can be decoded");
    pipeline::Texture::Level level;
    level.width = static_cast<std::uint32_t>(decoded.width);
    level.height = static_cast<std::uint32_t>(decoded.height);
    level.rgba = as_rgba8(decoded);
    return level;
}

} // namespace traces::gltf
