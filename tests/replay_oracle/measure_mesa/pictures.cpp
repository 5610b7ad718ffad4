#include "tests/replay_oracle/measure_mesa/pictures.hpp"

#include "traces/record_module/context.hpp"

namespace measure {

namespace {

constexpr GLenum draw_buffers = 8;

record::Size size_of_attachment(GLenum attachment) {
    const auto asked = [attachment](GLenum name) {
        GLint value = 0;
        REAL(glGetFramebufferAttachmentParameteriv)(GL_DRAW_FRAMEBUFFER, attachment, name, &value);
        return value;
    };
    const auto kind = static_cast<GLenum>(asked(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE));
    GLint width = 0, height = 0;
    if (kind == GL_RENDERBUFFER) {
        const auto name = static_cast<GLuint>(asked(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
        REAL(glGetNamedRenderbufferParameteriv)(name, GL_RENDERBUFFER_WIDTH, &width);
        REAL(glGetNamedRenderbufferParameteriv)(name, GL_RENDERBUFFER_HEIGHT, &height);
    } else if (kind == GL_TEXTURE) {
        const auto name = static_cast<GLuint>(asked(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
        const GLint level = asked(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL);
        REAL(glGetTextureLevelParameteriv)(name, level, GL_TEXTURE_WIDTH, &width);
        REAL(glGetTextureLevelParameteriv)(name, level, GL_TEXTURE_HEIGHT, &height);
    }
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

Picture read(GLuint framebuffer, GLenum buffer, const record::Size& size) {
    const auto bound = static_cast<GLuint>(record::integer(GL_READ_FRAMEBUFFER_BINDING));
    REAL(glBindFramebuffer)(GL_READ_FRAMEBUFFER, framebuffer);
    const auto kept = static_cast<GLenum>(record::integer(GL_READ_BUFFER));
    REAL(glReadBuffer)(buffer);
    Picture picture{size.width, size.height, {}};
    picture.rgba.resize(std::size_t{size.width} * size.height * 4);
    {
        const record::PlainPacking packing;
        REAL(glReadPixels)
        (0, 0, static_cast<GLsizei>(size.width), static_cast<GLsizei>(size.height), GL_RGBA, GL_UNSIGNED_BYTE,
         picture.rgba.data());
    }
    REAL(glReadBuffer)(kept);
    REAL(glBindFramebuffer)(GL_READ_FRAMEBUFFER, bound);
    return picture;
}

} // namespace

Picture picture_of_draw_buffer() {
    const auto framebuffer = static_cast<GLuint>(record::integer(GL_DRAW_FRAMEBUFFER_BINDING));
    if (framebuffer != 0 && record::integer(GL_SAMPLE_BUFFERS) != 0) return {};
    for (GLenum i = 0; i < draw_buffers; ++i) {
        const auto buffer = static_cast<GLenum>(record::integer(GL_DRAW_BUFFER0 + i));
        if (buffer == GL_NONE) continue;
        const record::Size size = framebuffer == 0 ? record::drawable_size() : size_of_attachment(buffer);
        if (size.width != 0 && size.height != 0) return read(framebuffer, buffer, size);
    }
    return {};
}

Picture picture_of_window() {
    GLboolean two = GL_FALSE;
    REAL(glGetBooleanv)(GL_DOUBLEBUFFER, &two);
    return read(0, two == GL_FALSE ? GL_FRONT : GL_BACK, record::drawable_size());
}

} // namespace measure
