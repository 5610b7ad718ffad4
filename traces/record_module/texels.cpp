#include "traces/record_module/texels.hpp"

#include "traces/record_module/context.hpp"
#include "traces/record_module/recorder.hpp"

#include <algorithm>

namespace record {

using namespace record_stream;

namespace {

constexpr GLint most_levels = 16;

/// Asks for the bits and types of channels: of a texture's level, or of an attachment.
struct ChannelNames {
    std::array<GLenum, bits_kinds> bits;
    std::array<GLenum, 6> types; ///< the first that is not GL_NONE counts; 0: there is no such question
};

constexpr ChannelNames texture_channels{{GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE,
                                         GL_TEXTURE_ALPHA_SIZE, GL_TEXTURE_LUMINANCE_SIZE, GL_TEXTURE_INTENSITY_SIZE,
                                         GL_TEXTURE_DEPTH_SIZE, GL_TEXTURE_STENCIL_SIZE},
                                        {GL_TEXTURE_RED_TYPE, GL_TEXTURE_ALPHA_TYPE, GL_TEXTURE_LUMINANCE_TYPE,
                                         GL_TEXTURE_INTENSITY_TYPE, GL_TEXTURE_DEPTH_TYPE, 0}};
constexpr ChannelNames attachment_channels{{GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE, GL_FRAMEBUFFER_ATTACHMENT_GREEN_SIZE,
                                            GL_FRAMEBUFFER_ATTACHMENT_BLUE_SIZE, GL_FRAMEBUFFER_ATTACHMENT_ALPHA_SIZE,
                                            0, 0, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE,
                                            GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE},
                                           {GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE, 0, 0, 0, 0, 0}};

bool is_compatibility_name(GLenum name) {
    return name == GL_TEXTURE_LUMINANCE_SIZE || name == GL_TEXTURE_INTENSITY_SIZE ||
           name == GL_TEXTURE_LUMINANCE_TYPE || name == GL_TEXTURE_INTENSITY_TYPE;
}

template <class Query>
void read_channels(Surface& surface, const ChannelNames& names, Query query) {
    const bool compatibility = current_context().compatibility;
    const auto ask = [&](GLenum name) {
        return name == 0 || (is_compatibility_name(name) && !compatibility) ? 0U
                                                                            : static_cast<std::uint32_t>(query(name));
    };
    for (std::size_t i = 0; i < bits_kinds; ++i) surface.bits.at(i) = ask(names.bits.at(i));
    for (const GLenum name : names.types)
        if (surface.component_type == 0) surface.component_type = ask(name);
}

struct Transfer {
    GLenum format, type;
    std::uint32_t texel; ///< bytes
};

Transfer depth_transfer(const Surface& surface) {
    if (surface.bits[bits_depth] == 0) return {GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, 1};
    if (surface.bits[bits_stencil] != 0) return {GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, 4};
    if (surface.component_type == GL_FLOAT) return {GL_DEPTH_COMPONENT, GL_FLOAT, 4};
    if (surface.bits[bits_depth] <= 16) return {GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, 2};
    return {GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, 4};
}

Transfer colour_channels(const Surface& surface) {
    const auto& bits = surface.bits;
    if (bits[bits_luminance] != 0 && bits[bits_alpha] != 0) return {GL_LUMINANCE_ALPHA, 0, 2};
    if (bits[bits_luminance] != 0) return {GL_LUMINANCE, 0, 1};
    if (bits[bits_intensity] != 0) return {GL_RED, 0, 1};
    if (bits[bits_red] == 0 && bits[bits_alpha] != 0) return {GL_ALPHA, 0, 1};
    if (bits[bits_green] == 0) return {GL_RED, 0, 1};
    if (bits[bits_blue] == 0) return {GL_RG, 0, 2};
    return {GL_RGBA, 0, 4};
}

/// As the surface has it where that is one of the recording's formats, else as floats.
Transfer transfer_of(const Surface& surface) {
    const auto& bits = surface.bits;
    if (bits[bits_depth] != 0 || bits[bits_stencil] != 0) return depth_transfer(surface);
    const std::uint32_t most = *std::max_element(bits.begin(), bits.begin() + bits_depth);
    Transfer transfer = colour_channels(surface);
    const auto with = [&](GLenum type, std::uint32_t size) {
        return Transfer{transfer.format, type, transfer.texel * size};
    };
    switch (surface.component_type) {
    case GL_INT:
    case GL_UNSIGNED_INT:
        transfer.format = transfer.format == GL_RED  ? GL_RED_INTEGER
                          : transfer.format == GL_RG ? GL_RG_INTEGER
                                                     : GL_RGBA_INTEGER;
        return with(surface.component_type, 4);
    case GL_FLOAT:
        if (most == 11) return {GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV, 4};
        return most == 16 ? with(GL_HALF_FLOAT, 2) : with(GL_FLOAT, 4);
    case GL_SIGNED_NORMALIZED:
        return with(GL_FLOAT, 4);
    default:
        break;
    }
    if (most == 10) return {GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, 4};
    return most > 8 ? with(GL_FLOAT, 4) : with(GL_UNSIGNED_BYTE, 1);
}

bool is_srgb(std::uint32_t internal_format) {
    switch (internal_format) {
    case GL_SRGB:
    case GL_SRGB8:
    case GL_SRGB_ALPHA:
    case GL_SRGB8_ALPHA8:
    case GL_SLUMINANCE:
    case GL_SLUMINANCE8:
    case GL_SLUMINANCE_ALPHA:
    case GL_SLUMINANCE8_ALPHA8:
    case GL_COMPRESSED_SRGB_S3TC_DXT1_EXT:
    case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT:
    case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT:
    case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT:
    case GL_COMPRESSED_SRGB_ALPHA_BPTC_UNORM:
        return true;
    default:
        return false;
    }
}

/// Formats that the recording keeps as blocks: BC1 to BC3.
bool keeps_blocks(std::uint32_t internal_format) {
    return (internal_format >= GL_COMPRESSED_RGB_S3TC_DXT1_EXT &&
            internal_format <= GL_COMPRESSED_RGBA_S3TC_DXT5_EXT) ||
           (internal_format >= GL_COMPRESSED_SRGB_S3TC_DXT1_EXT &&
            internal_format <= GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT);
}

std::uint32_t planes_of(GLenum target, std::uint32_t depth) { return target == GL_TEXTURE_CUBE_MAP ? 6 : depth; }

std::int32_t level_bytes(GLuint texture, GLint level, const Surface& surface, const Transfer& transfer,
                         const SurfaceLevel& size) {
    const auto texels = std::size_t{size.width} * size.height * planes_of(surface.target, size.depth);
    std::vector<std::byte> bytes;
    if (surface.type == 0) {
        GLint compressed = 0;
        REAL(glGetTextureLevelParameteriv)(texture, level, GL_TEXTURE_COMPRESSED_IMAGE_SIZE, &compressed);
        bytes.resize(static_cast<std::size_t>(compressed) * (surface.target == GL_TEXTURE_CUBE_MAP ? 6 : 1));
        REAL(glGetCompressedTextureImage)(texture, level, static_cast<GLsizei>(bytes.size()), bytes.data());
    } else {
        bytes.resize(texels * transfer.texel);
        REAL(glGetTextureImage)
        (texture, level, transfer.format, transfer.type, static_cast<GLsizei>(bytes.size()), bytes.data());
    }
    return recorder().blob(bytes);
}

void describe_buffer(Surface& surface, GLuint texture) {
    const auto ask = [&](GLenum name) {
        GLint value = 0;
        REAL(glGetTextureLevelParameteriv)(texture, 0, name, &value);
        return value;
    };
    const auto buffer = static_cast<GLuint>(ask(GL_TEXTURE_BUFFER_DATA_STORE_BINDING));
    const GLint size = ask(GL_TEXTURE_BUFFER_SIZE), offset = ask(GL_TEXTURE_BUFFER_OFFSET);
    if (buffer == 0 || size <= 0) return;
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    REAL(glGetNamedBufferSubData)(buffer, offset, size, bytes.data());
    surface.levels.push_back({static_cast<std::uint32_t>(ask(GL_TEXTURE_WIDTH)), 1, 1, recorder().blob(bytes)});
}

} // namespace

Surface describe_texture(GLuint texture, GLenum target) {
    Surface surface;
    surface.name = "texture " + std::to_string(texture);
    surface.target = target;
    const auto ask = [&](GLint level, GLenum name) {
        GLint value = 0;
        REAL(glGetTextureLevelParameteriv)(texture, level, name, &value);
        return value;
    };
    surface.internal_format = static_cast<std::uint32_t>(ask(0, GL_TEXTURE_INTERNAL_FORMAT));
    surface.srgb = is_srgb(surface.internal_format);
    read_channels(surface, texture_channels, [&](GLenum name) { return ask(0, name); });
    if (surface.target == GL_TEXTURE_BUFFER) {
        describe_buffer(surface, texture);
        return surface;
    }
    surface.samples = static_cast<std::uint32_t>(std::max(ask(0, GL_TEXTURE_SAMPLES), 1));
    const Transfer transfer = transfer_of(surface);
    const bool blocks = ask(0, GL_TEXTURE_COMPRESSED) != GL_FALSE && keeps_blocks(surface.internal_format);
    surface.format = blocks ? surface.internal_format : transfer.format;
    surface.type = blocks ? 0 : transfer.type;
    const PlainPacking packing;
    for (GLint level = 0; level < most_levels; ++level) {
        SurfaceLevel size{static_cast<std::uint32_t>(ask(level, GL_TEXTURE_WIDTH)),
                          static_cast<std::uint32_t>(ask(level, GL_TEXTURE_HEIGHT)),
                          static_cast<std::uint32_t>(std::max(ask(level, GL_TEXTURE_DEPTH), 1)), -1};
        if (size.width == 0 || size.height == 0) break;
        if (level > 0 && size.width != std::max(surface.levels.back().width / 2, 1U)) break; // not of this chain
        if (surface.samples == 1) size.blob = level_bytes(texture, level, surface, transfer, size);
        surface.levels.push_back(size);
        if (size.width == 1 && size.height == 1 && (surface.target != GL_TEXTURE_3D || size.depth == 1)) break;
    }
    return surface;
}

Surface describe_attachment(GLuint framebuffer, GLenum attachment, std::uint32_t width, std::uint32_t height) {
    Surface surface;
    const auto ask = [&](GLenum name) {
        GLint value = 0;
        REAL(glGetNamedFramebufferAttachmentParameteriv)(framebuffer, attachment, name, &value);
        return value;
    };
    surface.target = framebuffer == 0 ? GL_FRAMEBUFFER_DEFAULT : GL_RENDERBUFFER;
    read_channels(surface, attachment_channels, ask);
    const bool colour = surface.bits[bits_depth] == 0 && surface.bits[bits_stencil] == 0;
    // Most windows could be sRGB, and are not unless the program asks for it.
    surface.srgb = colour && ask(GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING) == GL_SRGB &&
                   REAL(glIsEnabled)(GL_FRAMEBUFFER_SRGB) != GL_FALSE;
    const Transfer transfer = transfer_of(surface);
    surface.format = transfer.format;
    surface.type = transfer.type;
    const GLint before = integer(GL_READ_FRAMEBUFFER_BINDING);
    REAL(glBindFramebuffer)(GL_READ_FRAMEBUFFER, framebuffer);
    surface.samples = static_cast<std::uint32_t>(std::max(integer(GL_SAMPLES), 1));
    SurfaceLevel level{width, height, 1, -1};
    if (surface.samples == 1 || framebuffer == 0) { // the window system resolves the window's samples
        const PlainPacking packing;
        const GLint buffer = integer(GL_READ_BUFFER);
        if (colour) REAL(glReadBuffer)(attachment);
        std::vector<std::byte> bytes(std::size_t{width} * height * transfer.texel);
        REAL(glReadPixels)
        (0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height), transfer.format, transfer.type, bytes.data());
        if (colour) REAL(glReadBuffer)(static_cast<GLenum>(buffer));
        level.blob = recorder().blob(bytes);
    }
    REAL(glBindFramebuffer)(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
    surface.levels.push_back(level);
    return surface;
}

} // namespace record
