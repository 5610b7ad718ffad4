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

// NOLINTBEGIN(bugprone-macro-parentheses): arguments come with theirs
#define BOUND(function, parameters, arguments)                                                                         \
    EXPORTED void function parameters {                                                                                \
        changing_bound(target, [&] { REAL(function) arguments; });                                                     \
    }
#define NAMED(function, parameters, arguments)                                                                         \
    EXPORTED void function parameters {                                                                                \
        changing(texture, [&] { REAL(function) arguments; });                                                          \
    }
// NOLINTEND(bugprone-macro-parentheses)
#define ROW(function, parameters, arguments) HOOK(function),

/// Calls that change the texture that is bound to a target.
#define BOUND_CALLS(X)                                                                                                 \
    X(glTexImage1D,                                                                                                    \
      (GLenum target, GLint level, GLint internal, GLsizei width, GLint border, GLenum format, GLenum type,            \
       const void* data),                                                                                              \
      (target, level, internal, width, border, format, type, data))                                                    \
    X(glTexImage2D,                                                                                                    \
      (GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLint border, GLenum format,         \
       GLenum type, const void* data),                                                                                 \
      (target, level, internal, width, height, border, format, type, data))                                            \
    X(glTexImage3D,                                                                                                    \
      (GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height, GLsizei depth, GLint border,         \
       GLenum format, GLenum type, const void* data),                                                                  \
      (target, level, internal, width, height, depth, border, format, type, data))                                     \
    X(glTexSubImage1D,                                                                                                 \
      (GLenum target, GLint level, GLint x, GLsizei width, GLenum format, GLenum type, const void* data),              \
      (target, level, x, width, format, type, data))                                                                   \
    X(glTexSubImage2D,                                                                                                 \
      (GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,        \
       const void* data),                                                                                              \
      (target, level, x, y, width, height, format, type, data))                                                        \
    X(glTexSubImage3D,                                                                                                 \
      (GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,            \
       GLenum format, GLenum type, const void* data),                                                                  \
      (target, level, x, y, z, width, height, depth, format, type, data))                                              \
    X(glCompressedTexImage1D,                                                                                          \
      (GLenum target, GLint level, GLenum internal, GLsizei width, GLint border, GLsizei size, const void* data),      \
      (target, level, internal, width, border, size, data))                                                            \
    X(glCompressedTexImage2D,                                                                                          \
      (GLenum target, GLint level, GLenum internal, GLsizei width, GLsizei height, GLint border, GLsizei size,         \
       const void* data),                                                                                              \
      (target, level, internal, width, height, border, size, data))                                                    \
    X(glCompressedTexImage3D,                                                                                          \
      (GLenum target, GLint level, GLenum internal, GLsizei width, GLsizei height, GLsizei depth, GLint border,        \
       GLsizei size, const void* data),                                                                                \
      (target, level, internal, width, height, depth, border, size, data))                                             \
    X(glCompressedTexSubImage2D,                                                                                       \
      (GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLsizei size,       \
       const void* data),                                                                                              \
      (target, level, x, y, width, height, format, size, data))                                                        \
    X(glCompressedTexSubImage3D,                                                                                       \
      (GLenum target, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,            \
       GLenum format, GLsizei size, const void* data),                                                                 \
      (target, level, x, y, z, width, height, depth, format, size, data))                                              \
    X(glTexStorage1D, (GLenum target, GLsizei levels, GLenum format, GLsizei width), (target, levels, format, width))  \
    X(glTexStorage2D, (GLenum target, GLsizei levels, GLenum format, GLsizei width, GLsizei height),                   \
      (target, levels, format, width, height))                                                                         \
    X(glTexStorage3D, (GLenum target, GLsizei levels, GLenum format, GLsizei width, GLsizei height, GLsizei depth),    \
      (target, levels, format, width, height, depth))                                                                  \
    X(glTexImage2DMultisample,                                                                                         \
      (GLenum target, GLsizei samples, GLenum format, GLsizei width, GLsizei height, GLboolean fixed),                 \
      (target, samples, format, width, height, fixed))                                                                 \
    X(glTexStorage2DMultisample,                                                                                       \
      (GLenum target, GLsizei samples, GLenum format, GLsizei width, GLsizei height, GLboolean fixed),                 \
      (target, samples, format, width, height, fixed))                                                                 \
    X(glCopyTexImage1D, (GLenum target, GLint level, GLenum format, GLint x, GLint y, GLsizei width, GLint border),    \
      (target, level, format, x, y, width, border))                                                                    \
    X(glCopyTexSubImage1D, (GLenum target, GLint level, GLint to_x, GLint x, GLint y, GLsizei width),                  \
      (target, level, to_x, x, y, width))                                                                              \
    X(glGenerateMipmap, (GLenum target), (target))

/// Calls that change the texture that they name.
#define NAMED_CALLS(X)                                                                                                 \
    X(glTextureSubImage1D,                                                                                             \
      (GLuint texture, GLint level, GLint x, GLsizei width, GLenum format, GLenum type, const void* data),             \
      (texture, level, x, width, format, type, data))                                                                  \
    X(glTextureSubImage2D,                                                                                             \
      (GLuint texture, GLint level, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,       \
       const void* data),                                                                                              \
      (texture, level, x, y, width, height, format, type, data))                                                       \
    X(glTextureSubImage3D,                                                                                             \
      (GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,           \
       GLenum format, GLenum type, const void* data),                                                                  \
      (texture, level, x, y, z, width, height, depth, format, type, data))                                             \
    X(glCompressedTextureSubImage2D,                                                                                   \
      (GLuint texture, GLint level, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLsizei size,      \
       const void* data),                                                                                              \
      (texture, level, x, y, width, height, format, size, data))                                                       \
    X(glCompressedTextureSubImage3D,                                                                                   \
      (GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,           \
       GLenum format, GLsizei size, const void* data),                                                                 \
      (texture, level, x, y, z, width, height, depth, format, size, data))                                             \
    X(glTextureStorage1D, (GLuint texture, GLsizei levels, GLenum format, GLsizei width),                              \
      (texture, levels, format, width))                                                                                \
    X(glTextureStorage2D, (GLuint texture, GLsizei levels, GLenum format, GLsizei width, GLsizei height),              \
      (texture, levels, format, width, height))                                                                        \
    X(glTextureStorage3D,                                                                                              \
      (GLuint texture, GLsizei levels, GLenum format, GLsizei width, GLsizei height, GLsizei depth),                   \
      (texture, levels, format, width, height, depth))                                                                 \
    X(glGenerateTextureMipmap, (GLuint texture), (texture))                                                            \
    X(glClearTexImage, (GLuint texture, GLint level, GLenum format, GLenum type, const void* data),                    \
      (texture, level, format, type, data))                                                                            \
    X(glClearTexSubImage,                                                                                              \
      (GLuint texture, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height, GLsizei depth,           \
       GLenum format, GLenum type, const void* data),                                                                  \
      (texture, level, x, y, z, width, height, depth, format, type, data))                                             \
    X(glInvalidateTexImage, (GLuint texture, GLint level), (texture, level))

BOUND_CALLS(BOUND)
NAMED_CALLS(NAMED)
ALSO_NAMED(glGenerateMipmapEXT, glGenerateMipmap);

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

#define PARAMETER(function, Object, Value, limited)                                                                    \
    EXPORTED void function(Object object, GLenum name, Value value) {                                                  \
        REAL(function)(object, name, limited(name, value));                                                            \
    }
#define PARAMETER_ROW(function, Object, Value, limited) HOOK(function),
#define PARAMETER_CALLS(X)                                                                                             \
    X(glTexParameterf, GLenum, GLfloat, anisotropy_of)                                                                 \
    X(glTexParameteriv, GLenum, const GLint*, anisotropy_at)                                                           \
    X(glTexParameterfv, GLenum, const GLfloat*, anisotropy_at)                                                         \
    X(glTextureParameteri, GLuint, GLint, anisotropy_of)                                                               \
    X(glTextureParameterf, GLuint, GLfloat, anisotropy_of)                                                             \
    X(glSamplerParameteri, GLuint, GLint, anisotropy_of)                                                               \
    X(glSamplerParameterf, GLuint, GLfloat, anisotropy_of)                                                             \
    X(glSamplerParameteriv, GLuint, const GLint*, anisotropy_at)                                                       \
    X(glSamplerParameterfv, GLuint, const GLfloat*, anisotropy_at)

PARAMETER_CALLS(PARAMETER)

std::span<const record::Hook> record::upload_hooks() {
    static const std::array hooks{BOUND_CALLS(ROW) NAMED_CALLS(ROW) PARAMETER_CALLS(PARAMETER_ROW)
                                      HOOK(glGenerateMipmapEXT),
                                  HOOK(glCopyImageSubData),
                                  HOOK(glBindTexture),
                                  HOOK(glBindTextureEXT),
                                  HOOK(glCreateTextures),
                                  HOOK(glDeleteTextures),
                                  HOOK(glDeleteRenderbuffers),
                                  HOOK(glTexParameteri)};
    return hooks;
}
