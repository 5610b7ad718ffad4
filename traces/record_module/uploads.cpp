// Calls that put other texels into a texture or a renderbuffer. Nothing of them is recorded but that they happened:
// what a draw uses is read at the draw.
#include "traces/record_module/recorder.hpp"
#include "traces/record_module/surfaces.hpp"

namespace {

/// The driver does it, then whoever knows the texture learns of it.
template <class Perform>
void changing_bound(GLenum target, Perform perform) {
    perform();
    const record::Lock lock;
    if (record::recorder().active()) record::bound_texture_changed(target);
}

template <class Perform>
void changing(GLuint texture, Perform perform) {
    perform();
    const record::Lock lock;
    record::texture_changed(texture);
}

/// Isotropic recordings: no more than one probe.
template <class Value>
Value anisotropy_of(GLenum name, Value value) {
    return name == GL_TEXTURE_MAX_ANISOTROPY_EXT && record::recorder().isotropic() ? Value{1} : value;
}

template <class Value>
const Value* anisotropy_at(GLenum name, const Value* values) {
    static constexpr Value one{1};
    return name == GL_TEXTURE_MAX_ANISOTROPY_EXT && record::recorder().isotropic() ? &one : values;
}

bool makes_mipmaps(GLenum name) { return name == GL_GENERATE_MIPMAP; }

} // namespace

#define BOUND(function, parameters, arguments)                                                                         \
    EXPORTED void function parameters {                                                                                \
        changing_bound(target, [&] { REAL(function) arguments; });                                                     \
    }
#define NAMED(function, parameters, arguments)                                                                         \
    EXPORTED void function parameters {                                                                                \
        changing(texture, [&] { REAL(function) arguments; });                                                          \
    }

BOUND(glTexImage1D,
      (GLenum target, GLint level, GLint internal, GLsizei width, GLint border, GLenum format, GLenum type,
       const void* data),
      (target, level, internal, width, border, format, type, data))
BOUND(glTexImage2D,
      (GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLint border, GLenum format,
       GLenum type, const void* data),
      (target, level, internal, width, height, border, format, type, data))
BOUND(glTexImage3D,
      (GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLsizei depth, GLint border,
       GLenum format, GLenum type, const void* data),
      (target, level, internal, width, height, depth, border, format, type, data))
BOUND(glTexSubImage1D,
      (GLenum target, GLint level, GLint x, GLsizei width, GLenum format, GLenum type, const void* data),
      (target, level, x, width, format, type, data))
BOUND(glTexSubImage2D,
      (GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
       const void* data),
      (target, level, x, y, width, height, format, type, data))
BOUND(glTexSubImage3D,
      (GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,
       GLenum format, GLenum type, const void* data),
      (target, level, x, y, z, width, height, depth, format, type, data))
BOUND(glCompressedTexImage1D,
      (GLenum target, GLint level, GLenum internal, GLsizei width, GLint border, GLsizei size, const void* data),
      (target, level, internal, width, border, size, data))
BOUND(glCompressedTexImage2D,
      (GLenum target, GLint level, GLenum internal, GLsizei width, GLsizei height, GLint border, GLsizei size,
       const void* data),
      (target, level, internal, width, height, border, size, data))
BOUND(glCompressedTexImage3D,
      (GLenum target, GLint level, GLenum internal, GLsizei width, GLsizei height, GLsizei depth, GLint border,
       GLsizei size, const void* data),
      (target, level, internal, width, height, depth, border, size, data))
BOUND(glCompressedTexSubImage2D,
      (GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLsizei size,
       const void* data),
      (target, level, x, y, width, height, format, size, data))
BOUND(glCompressedTexSubImage3D,
      (GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,
       GLenum format, GLsizei size, const void* data),
      (target, level, x, y, z, width, height, depth, format, size, data))
BOUND(glTexStorage1D, (GLenum target, GLsizei levels, GLenum format, GLsizei width), (target, levels, format, width))
BOUND(glTexStorage2D, (GLenum target, GLsizei levels, GLenum format, GLsizei width, GLsizei height),
      (target, levels, format, width, height))
BOUND(glTexStorage3D, (GLenum target, GLsizei levels, GLenum format, GLsizei width, GLsizei height, GLsizei depth),
      (target, levels, format, width, height, depth))
BOUND(glTexImage2DMultisample,
      (GLenum target, GLsizei samples, GLenum format, GLsizei width, GLsizei height, GLboolean fixed),
      (target, samples, format, width, height, fixed))
BOUND(glTexStorage2DMultisample,
      (GLenum target, GLsizei samples, GLenum format, GLsizei width, GLsizei height, GLboolean fixed),
      (target, samples, format, width, height, fixed))
BOUND(glCopyTexImage1D, (GLenum target, GLint level, GLenum format, GLint x, GLint y, GLsizei width, GLint border),
      (target, level, format, x, y, width, border))
BOUND(glCopyTexSubImage1D, (GLenum target, GLint level, GLint to_x, GLint x, GLint y, GLsizei width),
      (target, level, to_x, x, y, width))
BOUND(glGenerateMipmap, (GLenum target), (target))
ALSO_NAMED(glGenerateMipmapEXT, glGenerateMipmap);

NAMED(glTextureSubImage1D,
      (GLuint texture, GLint level, GLint x, GLsizei width, GLenum format, GLenum type, const void* data),
      (texture, level, x, width, format, type, data))
NAMED(glTextureSubImage2D,
      (GLuint texture, GLint level, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
       const void* data),
      (texture, level, x, y, width, height, format, type, data))
NAMED(glTextureSubImage3D,
      (GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,
       GLenum format, GLenum type, const void* data),
      (texture, level, x, y, z, width, height, depth, format, type, data))
NAMED(glCompressedTextureSubImage2D,
      (GLuint texture, GLint level, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLsizei size,
       const void* data),
      (texture, level, x, y, width, height, format, size, data))
NAMED(glCompressedTextureSubImage3D,
      (GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,
       GLenum format, GLsizei size, const void* data),
      (texture, level, x, y, z, width, height, depth, format, size, data))
NAMED(glTextureStorage1D, (GLuint texture, GLsizei levels, GLenum format, GLsizei width),
      (texture, levels, format, width))
NAMED(glTextureStorage2D, (GLuint texture, GLsizei levels, GLenum format, GLsizei width, GLsizei height),
      (texture, levels, format, width, height))
NAMED(glTextureStorage3D, (GLuint texture, GLsizei levels, GLenum format, GLsizei width, GLsizei height, GLsizei depth),
      (texture, levels, format, width, height, depth))
NAMED(glGenerateTextureMipmap, (GLuint texture), (texture))
NAMED(glClearTexImage, (GLuint texture, GLint level, GLenum format, GLenum type, const void* data),
      (texture, level, format, type, data))
NAMED(glClearTexSubImage,
      (GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,
       GLenum format, GLenum type, const void* data),
      (texture, level, x, y, z, width, height, depth, format, type, data))
NAMED(glInvalidateTexImage, (GLuint texture, GLint level), (texture, level))

EXPORTED void glCopyImageSubData(GLuint from, GLenum from_target, GLint from_level, GLint x, GLint y, GLint z,
                                 GLuint to, GLenum to_target, GLint to_level, GLint to_x, GLint to_y, GLint to_z,
                                 GLsizei width, GLsizei height, GLsizei depth) {
    REAL(glCopyImageSubData)
    (from, from_target, from_level, x, y, z, to, to_target, to_level, to_x, to_y, to_z, width, height, depth);
    const record::Lock lock;
    record::recorder().count("glCopyImageSubData (the driver's texels are taken)");
    if (to_target == GL_RENDERBUFFER)
        record::renderbuffer_changed(to);
    else
        record::texture_changed(to);
}

EXPORTED void glBindTexture(GLenum target, GLuint texture) {
    REAL(glBindTexture)(target, texture);
    const record::Lock lock;
    record::texture_has_target(texture, target);
}
ALSO_NAMED(glBindTextureEXT, glBindTexture);
EXPORTED void glCreateTextures(GLenum target, GLsizei count, GLuint* textures) {
    REAL(glCreateTextures)(target, count, textures);
    const record::Lock lock;
    for (GLsizei i = 0; i < count; ++i) record::texture_has_target(textures[i], target);
}
EXPORTED void glDeleteTextures(GLsizei count, const GLuint* textures) {
    REAL(glDeleteTextures)(count, textures);
    const record::Lock lock;
    for (GLsizei i = 0; i < count; ++i) record::texture_changed(textures[i]);
}
EXPORTED void glDeleteRenderbuffers(GLsizei count, const GLuint* renderbuffers) {
    REAL(glDeleteRenderbuffers)(count, renderbuffers);
    const record::Lock lock;
    for (GLsizei i = 0; i < count; ++i) record::renderbuffer_changed(renderbuffers[i]);
}

// Parameters: of one that makes mipmaps, the texels change with level 0.
EXPORTED void glTexParameteri(GLenum target, GLenum name, GLint value) {
    REAL(glTexParameteri)(target, name, anisotropy_of(name, value));
    if (makes_mipmaps(name)) changing_bound(target, [] {});
}
EXPORTED void glTexParameterf(GLenum target, GLenum name, GLfloat value) {
    REAL(glTexParameterf)(target, name, anisotropy_of(name, value));
}
EXPORTED void glTexParameteriv(GLenum target, GLenum name, const GLint* values) {
    REAL(glTexParameteriv)(target, name, anisotropy_at(name, values));
}
EXPORTED void glTexParameterfv(GLenum target, GLenum name, const GLfloat* values) {
    REAL(glTexParameterfv)(target, name, anisotropy_at(name, values));
}
EXPORTED void glTextureParameteri(GLuint texture, GLenum name, GLint value) {
    REAL(glTextureParameteri)(texture, name, anisotropy_of(name, value));
}
EXPORTED void glTextureParameterf(GLuint texture, GLenum name, GLfloat value) {
    REAL(glTextureParameterf)(texture, name, anisotropy_of(name, value));
}
EXPORTED void glSamplerParameteri(GLuint sampler, GLenum name, GLint value) {
    REAL(glSamplerParameteri)(sampler, name, anisotropy_of(name, value));
}
EXPORTED void glSamplerParameterf(GLuint sampler, GLenum name, GLfloat value) {
    REAL(glSamplerParameterf)(sampler, name, anisotropy_of(name, value));
}
EXPORTED void glSamplerParameteriv(GLuint sampler, GLenum name, const GLint* values) {
    REAL(glSamplerParameteriv)(sampler, name, anisotropy_at(name, values));
}
EXPORTED void glSamplerParameterfv(GLuint sampler, GLenum name, const GLfloat* values) {
    REAL(glSamplerParameterfv)(sampler, name, anisotropy_at(name, values));
}

std::span<const record::Hook> record::upload_hooks() {
    static const std::array hooks{HOOK(glTexImage1D),
                                  HOOK(glTexImage2D),
                                  HOOK(glTexImage3D),
                                  HOOK(glTexSubImage1D),
                                  HOOK(glTexSubImage2D),
                                  HOOK(glTexSubImage3D),
                                  HOOK(glCompressedTexImage1D),
                                  HOOK(glCompressedTexImage2D),
                                  HOOK(glCompressedTexImage3D),
                                  HOOK(glCompressedTexSubImage2D),
                                  HOOK(glCompressedTexSubImage3D),
                                  HOOK(glTexStorage1D),
                                  HOOK(glTexStorage2D),
                                  HOOK(glTexStorage3D),
                                  HOOK(glTexImage2DMultisample),
                                  HOOK(glTexStorage2DMultisample),
                                  HOOK(glCopyTexImage1D),
                                  HOOK(glCopyTexSubImage1D),
                                  HOOK(glGenerateMipmap),
                                  HOOK(glGenerateMipmapEXT),
                                  HOOK(glTextureSubImage1D),
                                  HOOK(glTextureSubImage2D),
                                  HOOK(glTextureSubImage3D),
                                  HOOK(glCompressedTextureSubImage2D),
                                  HOOK(glCompressedTextureSubImage3D),
                                  HOOK(glTextureStorage1D),
                                  HOOK(glTextureStorage2D),
                                  HOOK(glTextureStorage3D),
                                  HOOK(glGenerateTextureMipmap),
                                  HOOK(glClearTexImage),
                                  HOOK(glClearTexSubImage),
                                  HOOK(glInvalidateTexImage),
                                  HOOK(glCopyImageSubData),
                                  HOOK(glBindTexture),
                                  HOOK(glBindTextureEXT),
                                  HOOK(glCreateTextures),
                                  HOOK(glDeleteTextures),
                                  HOOK(glDeleteRenderbuffers),
                                  HOOK(glTexParameteri),
                                  HOOK(glTexParameterf),
                                  HOOK(glTexParameteriv),
                                  HOOK(glTexParameterfv),
                                  HOOK(glTextureParameteri),
                                  HOOK(glTextureParameterf),
                                  HOOK(glSamplerParameteri),
                                  HOOK(glSamplerParameterf),
                                  HOOK(glSamplerParameteriv),
                                  HOOK(glSamplerParameterfv)};
    return hooks;
}
