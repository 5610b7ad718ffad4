#include "tests/oracle/mesa_texture_upload.hpp"

#if ROPSIM_HAVE_EGL

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>

namespace tests {

namespace {

using pipeline::SurfaceFormat;

struct GlFormat {
    SurfaceFormat format;
    GLenum internal, channels, type; ///< of compressed ones only the first
};
// The compressed ones are those of EXT_texture_compression_s3tc and EXT_texture_sRGB.
constexpr std::array<GlFormat, 20> gl_formats{{
    {SurfaceFormat::r8, GL_R8, GL_RED, GL_UNSIGNED_BYTE},
    {SurfaceFormat::rg8, GL_RG8, GL_RG, GL_UNSIGNED_BYTE},
    {SurfaceFormat::rgba8, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
    {SurfaceFormat::srgb8a8, GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE},
    {SurfaceFormat::rgb10a2, GL_RGB10_A2, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV},
    {SurfaceFormat::r11g11b10f, GL_R11F_G11F_B10F, GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV},
    {SurfaceFormat::rgba16, GL_RGBA16, GL_RGBA, GL_UNSIGNED_SHORT},
    {SurfaceFormat::rgba8s, GL_RGBA8_SNORM, GL_RGBA, GL_BYTE},
    {SurfaceFormat::rgba16f, GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT},
    {SurfaceFormat::r32f, GL_R32F, GL_RED, GL_FLOAT},
    {SurfaceFormat::rgba32f, GL_RGBA32F, GL_RGBA, GL_FLOAT},
    {SurfaceFormat::d16, GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT},
    {SurfaceFormat::d32f, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT},
    {SurfaceFormat::rgba8u, GL_RGBA8UI, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE},
    {SurfaceFormat::bc1, 0x83F1, 0, 0},
    {SurfaceFormat::bc2, 0x83F2, 0, 0},
    {SurfaceFormat::bc3, 0x83F3, 0, 0},
    {SurfaceFormat::srgb_bc1, 0x8C4D, 0, 0},
    {SurfaceFormat::srgb_bc2, 0x8C4E, 0, 0},
    {SurfaceFormat::srgb_bc3, 0x8C4F, 0, 0},
}};

GLint wrap_of(pipeline::Wrap wrap) {
    constexpr std::array<GLint, 4> wraps{GL_REPEAT, GL_CLAMP_TO_EDGE, GL_MIRRORED_REPEAT, GL_CLAMP_TO_BORDER};
    return wraps[static_cast<std::size_t>(wrap)];
}
GLint filter_of(pipeline::Filter filter) {
    constexpr std::array<GLint, 6> filters{GL_NEAREST,
                                           GL_LINEAR,
                                           GL_NEAREST_MIPMAP_NEAREST,
                                           GL_LINEAR_MIPMAP_NEAREST,
                                           GL_NEAREST_MIPMAP_LINEAR,
                                           GL_LINEAR_MIPMAP_LINEAR};
    return filters[static_cast<std::size_t>(filter)];
}

void upload_level(GLenum target, const traces::RecordedSurface& surface, std::uint32_t level) {
    const auto* found = std::find_if(gl_formats.begin(), gl_formats.end(),
                                     [&](const GlFormat& format) { return format.format == surface.format; });
    if (found == gl_formats.end()) throw std::runtime_error("a format that OpenGL does not have in these bytes");
    const auto size = [level](std::uint32_t texels) { return static_cast<GLsizei>(std::max(1U, texels >> level)); };
    const auto number = static_cast<GLint>(level);
    const GLsizei width = size(surface.width), height = size(surface.height);
    const pipeline::SharedBytes& bytes = surface.levels[level];
    const auto internal = static_cast<GLint>(found->internal);
    if (target == GL_TEXTURE_3D || target == GL_TEXTURE_2D_ARRAY) {
        const GLsizei depth = target == GL_TEXTURE_3D ? size(surface.depth) : static_cast<GLsizei>(surface.depth);
        glTexImage3D(target, number, internal, width, height, depth, 0, found->channels, found->type, bytes.data());
        return;
    }
    const bool cube = target == GL_TEXTURE_CUBE_MAP;
    const std::size_t face_bytes = bytes.size() / (cube ? 6 : 1);
    for (GLenum face = 0; face < (cube ? 6U : 1U); ++face) {
        const GLenum image = cube ? GL_TEXTURE_CUBE_MAP_POSITIVE_X + face : target;
        const std::byte* data = bytes.data() + face * face_bytes;
        if (pipeline::is_compressed(surface.format))
            glCompressedTexImage2D(image, number, found->internal, width, height, 0, static_cast<GLsizei>(face_bytes),
                                   data);
        else
            glTexImage2D(image, number, internal, width, height, 0, found->channels, found->type, data);
    }
}

void set_sampler(GLenum target, const traces::RecordedSampler& sampler) {
    glTexParameteri(target, GL_TEXTURE_WRAP_S, wrap_of(sampler.wrap_u));
    glTexParameteri(target, GL_TEXTURE_WRAP_T, wrap_of(sampler.wrap_v));
    glTexParameteri(target, GL_TEXTURE_WRAP_R, wrap_of(sampler.wrap_w));
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter_of(sampler.min_filter));
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter_of(sampler.mag_filter));
    glTexParameterfv(target, GL_TEXTURE_BORDER_COLOR, glm::value_ptr(sampler.border));
    glTexParameterf(target, GL_TEXTURE_LOD_BIAS, sampler.lod_bias);
    glTexParameterf(target, GL_TEXTURE_MIN_LOD, sampler.least_lod);
    glTexParameterf(target, GL_TEXTURE_MAX_LOD, sampler.most_lod);
    glTexParameteri(target, GL_TEXTURE_COMPARE_MODE, sampler.compares ? GL_COMPARE_REF_TO_TEXTURE : GL_NONE);
    glTexParameteri(target, GL_TEXTURE_COMPARE_FUNC, GL_NEVER + static_cast<GLint>(sampler.compare)); // same order
    if (sampler.seamless)
        glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    else
        glDisable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

} // namespace

unsigned upload_texture(unsigned target, const MesaTexture& texture) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(target, name);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const auto levels = static_cast<std::uint32_t>(texture.surface.levels.size());
    for (std::uint32_t level = 0; level < levels; ++level) upload_level(target, texture.surface, level);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    set_sampler(target, texture.sampler);
    if (pipeline::has_depth(texture.surface.format)) { // else the compatibility profile gives (depth, depth, depth, 1)
        constexpr GLenum depth_texture_mode = 0x884B;
        glTexParameteri(target, depth_texture_mode, GL_RED);
    }
    constexpr std::array<GLint, 6> channels{GL_RED, GL_GREEN, GL_BLUE, GL_ALPHA, GL_ZERO, GL_ONE};
    constexpr std::array<GLenum, 4> places{GL_TEXTURE_SWIZZLE_R, GL_TEXTURE_SWIZZLE_G, GL_TEXTURE_SWIZZLE_B,
                                           GL_TEXTURE_SWIZZLE_A};
    for (std::size_t i = 0; i < 4; ++i)
        glTexParameteri(target, places[i], channels[static_cast<std::size_t>(texture.binding.swizzle[i])]);
    glTexParameteri(target, GL_TEXTURE_BASE_LEVEL, static_cast<GLint>(texture.binding.base_level));
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(std::min(texture.binding.last_level, levels - 1)));
    return name;
}

} // namespace tests

#endif
