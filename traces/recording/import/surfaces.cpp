#include "traces/recording/import/surfaces.hpp"

#include "pipeline/functional/sample_pattern.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <string_view>

namespace traces::recorded {

using pipeline::SurfaceFormat;

namespace {

constexpr std::uint32_t compressed = 0; ///< in place of a type, and of textures of buffers

struct Layout {
    std::uint32_t format, type;
    std::string_view linear, srgb; ///< names of formats
};

constexpr std::array layouts{
    Layout{GL_RED, GL_UNSIGNED_BYTE, "r8", "r8"},
    Layout{GL_ALPHA, GL_UNSIGNED_BYTE, "r8", "r8"},
    Layout{GL_LUMINANCE, GL_UNSIGNED_BYTE, "r8", "r8"},
    Layout{GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, "rg8", "rg8"},
    Layout{GL_RG, GL_UNSIGNED_BYTE, "rg8", "rg8"},
    Layout{GL_RGBA, GL_UNSIGNED_BYTE, "rgba8", "srgb8a8"},
    Layout{GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, "rgb10a2", "rgb10a2"},
    Layout{GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV, "r11g11b10f", "r11g11b10f"},
    Layout{GL_RED, GL_HALF_FLOAT, "r16f", "r16f"},
    Layout{GL_ALPHA, GL_HALF_FLOAT, "r16f", "r16f"},
    Layout{GL_LUMINANCE, GL_HALF_FLOAT, "r16f", "r16f"},
    Layout{GL_LUMINANCE_ALPHA, GL_HALF_FLOAT, "rg16f", "rg16f"},
    Layout{GL_RG, GL_HALF_FLOAT, "rg16f", "rg16f"},
    Layout{GL_RGBA, GL_HALF_FLOAT, "rgba16f", "rgba16f"},
    Layout{GL_RED, GL_FLOAT, "r32f", "r32f"},
    Layout{GL_ALPHA, GL_FLOAT, "r32f", "r32f"},
    Layout{GL_LUMINANCE, GL_FLOAT, "r32f", "r32f"},
    Layout{GL_LUMINANCE_ALPHA, GL_FLOAT, "rg32f", "rg32f"},
    Layout{GL_RG, GL_FLOAT, "rg32f", "rg32f"},
    Layout{GL_RGBA, GL_FLOAT, "rgba32f", "rgba32f"},
    Layout{GL_RED_INTEGER, GL_UNSIGNED_INT, "r32u", "r32u"},
    Layout{GL_RG_INTEGER, GL_UNSIGNED_INT, "rg32u", "rg32u"},
    Layout{GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, "d16", "d16"},
    Layout{GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, "d24", "d24"},
    Layout{GL_DEPTH_COMPONENT, GL_FLOAT, "d32f", "d32f"},
    Layout{GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, "d24s8", "d24s8"},
    Layout{GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, "s8", "s8"},
    Layout{GL_RGBA_INTEGER, GL_UNSIGNED_INT, "rgba32u", "rgba32u"},
    Layout{GL_RED_INTEGER, GL_INT, "r32i", "r32i"},
    Layout{GL_RG_INTEGER, GL_INT, "rg32i", "rg32i"},
    Layout{GL_RGBA_INTEGER, GL_INT, "rgba32i", "rgba32i"},
    Layout{GL_COMPRESSED_RGB_S3TC_DXT1_EXT, compressed, "bc1", "bc1"},
    Layout{GL_COMPRESSED_RGBA_S3TC_DXT1_EXT, compressed, "bc1", "bc1"},
    Layout{GL_COMPRESSED_RGBA_S3TC_DXT3_EXT, compressed, "bc2", "bc2"},
    Layout{GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, compressed, "bc3", "bc3"},
    Layout{GL_COMPRESSED_SRGB_S3TC_DXT1_EXT, compressed, "srgb_bc1", "srgb_bc1"},
    Layout{GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT, compressed, "srgb_bc1", "srgb_bc1"},
    Layout{GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT, compressed, "srgb_bc2", "srgb_bc2"},
    Layout{GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT, compressed, "srgb_bc3", "srgb_bc3"},
    // Textures of buffers, whose bytes are those of the internal format.
    Layout{GL_R8, compressed, "r8", "r8"},
    Layout{GL_RG8, compressed, "rg8", "rg8"},
    Layout{GL_RGBA8, compressed, "rgba8", "rgba8"},
    Layout{GL_R16F, compressed, "r16f", "r16f"},
    Layout{GL_RG16F, compressed, "rg16f", "rg16f"},
    Layout{GL_RGBA16F, compressed, "rgba16f", "rgba16f"},
    Layout{GL_R32F, compressed, "r32f", "r32f"},
    Layout{GL_RG32F, compressed, "rg32f", "rg32f"},
    Layout{GL_RGBA32F, compressed, "rgba32f", "rgba32f"},
    Layout{GL_R32UI, compressed, "r32u", "r32u"},
    Layout{GL_RG32UI, compressed, "rg32u", "rg32u"},
};

/// Nothing for one that there is not.
std::optional<SurfaceFormat> format_named(std::string_view name) {
    const auto found = std::find_if(pipeline::surface_formats.begin(), pipeline::surface_formats.end(),
                                    [&](const pipeline::SurfaceFormatInfo& info) { return info.name == name; });
    if (found == pipeline::surface_formats.end()) return std::nullopt;
    return static_cast<SurfaceFormat>(found - pipeline::surface_formats.begin());
}

std::optional<SurfaceFormat> format_of(const record_stream::Surface& surface) {
    const std::uint32_t format = surface.type == compressed ? surface.internal_format : surface.format;
    for (const Layout& layout : layouts)
        if (layout.format == format && layout.type == surface.type)
            return format_named(surface.srgb ? layout.srgb : layout.linear);
    return std::nullopt;
}

std::optional<SurfaceKind> kind_of(std::uint32_t target) {
    switch (target) {
    case GL_TEXTURE_1D:
    case GL_TEXTURE_2D:
    case GL_TEXTURE_RECTANGLE:
    case GL_TEXTURE_2D_MULTISAMPLE:
    case GL_RENDERBUFFER:
    case GL_FRAMEBUFFER_DEFAULT:
        return SurfaceKind::plane;
    case GL_TEXTURE_1D_ARRAY:
    case GL_TEXTURE_2D_ARRAY:
    case GL_TEXTURE_2D_MULTISAMPLE_ARRAY:
        return SurfaceKind::layers;
    case GL_TEXTURE_CUBE_MAP:
        return SurfaceKind::cube;
    case GL_TEXTURE_3D:
        return SurfaceKind::volume;
    case GL_TEXTURE_BUFFER:
        return SurfaceKind::buffer;
    default:
        return std::nullopt;
    }
}

/// Depths of 24 bits lie in the low ones, stencils above them.
void turn_depths(std::vector<std::byte>& bytes, SurfaceFormat format) {
    if (format != SurfaceFormat::d24 && format != SurfaceFormat::d24s8) return;
    for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) {
        std::uint32_t value = 0;
        std::memcpy(&value, &bytes[i], 4);
        value = format == SurfaceFormat::d24s8 ? std::rotr(value, 8) : value >> 8U;
        std::memcpy(&bytes[i], &value, 4);
    }
}

void turn_rows_over(std::vector<std::byte>& bytes, std::size_t row) {
    const std::size_t rows = row == 0 ? 0 : bytes.size() / row;
    for (std::size_t i = 0; i < rows / 2; ++i)
        std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(i * row),
                         bytes.begin() + static_cast<std::ptrdiff_t>((i + 1) * row),
                         bytes.begin() + static_cast<std::ptrdiff_t>((rows - 1 - i) * row));
}

std::array<Swizzle, 4> channels_of(const record_stream::Surface& surface) {
    using enum Swizzle;
    const auto& bits = surface.bits;
    if (bits[record_stream::bits_luminance] != 0)
        return {red, red, red, bits[record_stream::bits_alpha] != 0 ? green : one};
    if (bits[record_stream::bits_intensity] != 0) return {red, red, red, red};
    if (bits[record_stream::bits_red] == 0 && bits[record_stream::bits_alpha] != 0) return {zero, zero, zero, red};
    if (bits[record_stream::bits_green] == 0) return {red, zero, zero, one};
    if (bits[record_stream::bits_blue] == 0) return {red, green, zero, one};
    return {red, green, blue, bits[record_stream::bits_alpha] != 0 ? alpha : one};
}

/// Of a depth texture: what its depths are read as (OpenGL 2.1, section 3.8.14).
std::array<Swizzle, 4> depth_channels(std::uint32_t mode) {
    using enum Swizzle;
    switch (mode) {
    case GL_LUMINANCE:
        return {red, red, red, one};
    case GL_INTENSITY:
        return {red, red, red, red};
    case GL_ALPHA:
        return {zero, zero, zero, red};
    default:
        return {red, zero, zero, one};
    }
}

} // namespace

std::optional<ImportedSurface> import_surface(const record_stream::Surface& surface, const Blobs& blobs,
                                              bool top_row_first, const Count& count) {
    const auto kind = kind_of(surface.target);
    const auto format = format_of(surface);
    if (!kind || !format || surface.levels.empty()) {
        count(fmt::format("{} of target 0x{:x} and format 0x{:x}", surface.name, surface.target,
                          surface.internal_format));
        return std::nullopt;
    }
    ImportedSurface imported;
    RecordedSurface& result = imported.surface;
    imported.window = surface.target == GL_FRAMEBUFFER_DEFAULT;
    imported.channels = channels_of(surface);
    imported.has_alpha = surface.bits[record_stream::bits_alpha] != 0 || !pipeline::is_colour(*format);
    result.name = surface.name;
    result.kind = *kind;
    result.format = *format;
    result.width = surface.levels[0].width;
    result.height = surface.levels[0].height;
    result.depth = *kind == SurfaceKind::layers || *kind == SurfaceKind::volume ? surface.levels[0].depth : 1;
    if (surface.target == GL_TEXTURE_1D_ARRAY) {
        result.depth = result.height;
        result.height = 1;
    }
    result.samples = surface.samples;
    if (!pipeline::is_sample_count(result.samples)) {
        count(fmt::format("{} samples a pixel", result.samples));
        result.samples = 1;
    }
    result.levels.clear();
    for (const record_stream::SurfaceLevel& level : surface.levels) {
        pipeline::SharedBytes& held = result.levels.emplace_back();
        if (level.blob < 0 || result.samples > 1) continue;
        std::vector<std::byte> bytes = blobs.at(static_cast<std::size_t>(level.blob));
        turn_depths(bytes, *format);
        if (top_row_first && imported.window)
            turn_rows_over(bytes, std::size_t{level.width} * pipeline::bytes_of(*format));
        const std::uint64_t expected = level_bytes(result, static_cast<std::uint32_t>(result.levels.size() - 1));
        if (bytes.size() < expected) continue;
        bytes.resize(expected); // a buffer may end within a texel
        held = std::move(bytes);
    }
    return imported;
}

std::array<Swizzle, 4> swizzle_of(const record_stream::Binding& binding, const ImportedSurface& surface) {
    const bool depth = pipeline::has_depth(surface.surface.format);
    const std::array<Swizzle, 4> base = depth ? depth_channels(binding.depth_mode) : surface.channels;
    std::array<Swizzle, 4> result = base;
    for (std::size_t i = 0; i < 4; ++i) switch (binding.swizzle.at(i)) {
        case GL_RED:
            result.at(i) = base[0];
            break;
        case GL_GREEN:
            result.at(i) = base[1];
            break;
        case GL_BLUE:
            result.at(i) = base[2];
            break;
        case GL_ALPHA:
            result.at(i) = base[3];
            break;
        case GL_ZERO:
            result.at(i) = Swizzle::zero;
            break;
        case GL_ONE:
            result.at(i) = Swizzle::one;
            break;
        default: // of buffers: as they are
            break;
        }
    return result;
}

} // namespace traces::recorded
