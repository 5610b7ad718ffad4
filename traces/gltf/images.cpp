#include "traces/gltf/images.hpp"

#include "sim/check.hpp"
#include "traces/child_process.hpp"
#include "traces/texture_module/texture_module.h"

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace traces::gltf {

namespace {

using Encoded = std::span<const unsigned char>;

constexpr std::uint32_t largest_image = 16384;

struct Size {
    std::uint32_t width = 0, height = 0;
};

std::uint32_t big_endian(Encoded bytes, std::size_t offset, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8U | bytes[offset + i];
    return value;
}

// The frame header (SOF0 to SOF15, less the three markers that mean something else) of a JPEG file.
Size jpeg_size(Encoded bytes) {
    for (std::size_t offset = 2; offset + 9 < bytes.size() && bytes[offset] == 0xff;) {
        const unsigned marker = bytes[offset + 1];
        if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc)
            return {big_endian(bytes, offset + 7, 2), big_endian(bytes, offset + 5, 2)};
        offset += marker == 0xff ? 1 : 2 + big_endian(bytes, offset + 2, 2);
    }
    return {};
}

std::uint32_t little_endian(Encoded bytes, std::size_t offset, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8U | bytes[offset + i];
    return value;
}

bool begins(Encoded bytes, std::size_t offset, std::string_view text) {
    return bytes.size() >= offset + text.size() && std::memcmp(bytes.data() + offset, text.data(), text.size()) == 0;
}

bool is_webp(Encoded bytes) { return bytes.size() >= 30 && begins(bytes, 0, "RIFF") && begins(bytes, 8, "WEBP"); }

// Of the first chunk: lossy, lossless or extended (developers.google.com/speed/webp/docs/riff_container).
Size webp_size(Encoded bytes) {
    if (begins(bytes, 12, "VP8X")) return {1 + little_endian(bytes, 24, 3), 1 + little_endian(bytes, 27, 3)};
    if (begins(bytes, 12, "VP8 "))
        return {little_endian(bytes, 26, 2) & 0x3fffU, little_endian(bytes, 28, 2) & 0x3fffU};
    if (!begins(bytes, 12, "VP8L")) return {};
    const std::uint32_t packed = little_endian(bytes, 21, 4);
    return {1 + (packed & 0x3fffU), 1 + (packed >> 14U & 0x3fffU)};
}

/// What the header says; 0x0 when it is none of ours. Known before anything is allocated for the texels.
Size size_in_header(Encoded bytes) {
    if (begins(bytes, 0, "\x89PNG\r\n\x1a\n") && bytes.size() >= 24)
        return {big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
    if (bytes.size() >= 4 && bytes[0] == 0xff && bytes[1] == 0xd8) return jpeg_size(bytes);
    return is_webp(bytes) ? webp_size(bytes) : Size{};
}

Encoded encoded_bytes(const Document& document, const tinygltf::Image& image, std::string_view place) {
    if (image.bufferView < 0) {
        document.require(!image.image.empty(), place, "a uri of a readable file, or base64 data in it, got '{}'",
                         image.uri);
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

using Texels = std::vector<std::uint8_t>;

Texels decode_png_or_jpeg(const std::string& place, Encoded bytes, Size size) {
    tinygltf::Image decoded;
    std::string error, warning;
    const bool good = tinygltf::LoadImageData(&decoded, 0, &error, &warning, 0, 0, bytes.data(),
                                              static_cast<int>(bytes.size()), nullptr);
    if (!good || decoded.component != 4 || decoded.width != static_cast<int>(size.width) ||
        decoded.height != static_cast<int>(size.height))
        throw sim::InputError(fmt::format("{}: expected PNG or JPEG data that can be decoded", place));
    return as_rgba8(decoded);
}

Texels decode_webp(const std::string& place, Encoded bytes, Size size) {
    const auto* module = load_module<RopsimTextureModule>("ropsim_textures.so", ROPSIM_TEXTURE_MODULE_FUNCTION,
                                                          "a WebP texture", "libopenimageio2.4");
    if (module == nullptr || module->version != ROPSIM_TEXTURE_MODULE_VERSION)
        throw sim::InputError(fmt::format("{}: ropsim_textures.so is of another version of ropsim", place));
    ChildResult result = in_child_process(std::size_t{size.width} * size.height * 4,
                                          [&](std::span<unsigned char> out, std::span<char> line) {
                                              return module->decode(bytes.data(), bytes.size(), "webp", size.width,
                                                                    size.height, out.data(), line.data(), line.size());
                                          });
    if (!result.failure.empty())
        throw sim::InputError(fmt::format("{}: expected WebP data that can be decoded: {}", place, result.failure));
    return std::move(result.bytes);
}

/// What a file is that is none of ours, where it can be told.
std::string kind_of(Encoded bytes) {
    if (begins(bytes, 0, "\xabKTX 20\xbb"))
        return ", got KTX2 (Basis Universal), which no package of Debian 12 decodes";
    if (begins(bytes, 0, "\xabKTX 11\xbb")) return ", got KTX";
    if (begins(bytes, 0, "DDS ")) return ", got DDS";
    if (begins(bytes, 4, "ftypavif")) return ", got AVIF";
    return {};
}

/// @param where file and place, for errors
EncodedImage image_of(std::vector<unsigned char> bytes, const std::string& where) {
    const Size size = size_in_header(bytes);
    if (size.width < 1 || size.height < 1)
        throw sim::InputError(fmt::format("{}: expected PNG, JPEG or WebP data{}", where, kind_of(bytes)));
    if (size.width > largest_image || size.height > largest_image)
        throw sim::InputError(fmt::format("{0}: expected at most {1}x{1} texels, got {2}x{3}", where, largest_image,
                                          size.width, size.height));
    return {size.width, size.height, [kept = std::move(bytes), size, where] {
                return is_webp(kept) ? decode_webp(where, kept, size) : decode_png_or_jpeg(where, kept, size);
            }};
}

std::vector<unsigned char> bytes_of_image(const Document& document, int index) {
    const tinygltf::Image& source = document.at(document.model().images, index, "textures", "image");
    const Encoded bytes = encoded_bytes(document, source, fmt::format("images[{}]", index));
    return {bytes.begin(), bytes.end()};
}

std::string where_of(const Document& document, int index) {
    return fmt::format("{}: images[{}]", document.name(), index);
}

} // namespace

EncodedImage encoded_image(const Document& document, int index) {
    return image_of(bytes_of_image(document, index), where_of(document, index));
}

std::function<EncodedImage()> late_image(const Document& document, int index) {
    try {
        return [bytes = bytes_of_image(document, index), where = where_of(document, index)] {
            return image_of(bytes, where);
        };
    } catch (const sim::InputError& error) {
        return [fault = std::string(error.what())]() -> EncodedImage { throw sim::InputError(fault); };
    }
}

} // namespace traces::gltf
