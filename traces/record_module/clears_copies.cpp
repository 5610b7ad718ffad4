// What changes surfaces without a draw: clears, and copies from one surface to another.
#include "traces/record_module/context.hpp"
#include "traces/record_module/draws.hpp"
#include "traces/record_module/lists.hpp"
#include "traces/record_module/recorder.hpp"
#include "traces/record_module/state.hpp"
#include "traces/record_module/state_names.hpp"
#include "traces/record_module/surfaces.hpp"

#include <algorithm>

namespace record {

using namespace record_stream;

namespace {

constexpr std::uint32_t all_targets = 0xFF;

double value_of(const State& state, GLenum name, std::size_t i = 0) {
    return state.values.at(place_of(state_names, name) + i);
}

/// Makes a clear out of `fill(clear)` and the state, before the driver does it.
template <class Fill, class Perform>
void clear(const char* call, Fill fill, Perform perform) {
    const Lock lock;
    if (recorder().wanted() && list_is_compiled()) recorder().count(std::string(call) + " in a list");
    if (recorder().wanted() && !list_is_compiled() && context_is_usable(call)) {
        const Quiet quiet;
        Clear record;
        record.call = call;
        record.targets = draw_targets();
        record.state = current_state();
        if (fill(record)) recorder().clear(record);
    }
    perform();
}

/// While it lives, a framebuffer is the one for drawing.
class DrawFramebuffer {
  public:
    explicit DrawFramebuffer(GLuint framebuffer) : before_(integer(GL_DRAW_FRAMEBUFFER_BINDING)) {
        REAL(glBindFramebuffer)(GL_DRAW_FRAMEBUFFER, framebuffer);
    }
    ~DrawFramebuffer() { REAL(glBindFramebuffer)(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(before_)); }
    DrawFramebuffer(const DrawFramebuffer&) = delete;
    DrawFramebuffer& operator=(const DrawFramebuffer&) = delete;

  private:
    GLint before_;
};

bool fill_buffer(Clear& clear, GLenum buffer, GLint drawbuffer, const GLfloat* value) {
    if (buffer == GL_DEPTH) {
        clear.depth = true;
        clear.depth_value = value[0];
        return true;
    }
    if (buffer != GL_COLOR || drawbuffer < 0 || drawbuffer >= static_cast<GLint>(most_targets)) return false;
    clear.colours = 1U << static_cast<unsigned>(drawbuffer);
    std::copy_n(value, 4, clear.colour.begin());
    return true;
}

bool fill_integers(Clear& clear, GLenum buffer, const GLint* value) {
    if (buffer != GL_STENCIL) {
        recorder().count(clear.call + " of whole numbers");
        return false;
    }
    clear.stencil = true;
    clear.stencil_value = value[0];
    return true;
}

bool fill_both(Clear& clear, GLfloat depth, GLint stencil) {
    clear.depth = clear.stencil = true;
    clear.depth_value = depth;
    clear.stencil_value = stencil;
    return true;
}

bool is_whole(const Target& from, const Target& to) { return from.surface >= 0 && to.surface >= 0; }

/// Copies into a texture, once for the recording and once by the driver.
template <class Perform>
void copy_to_texture(const char* call, GLuint texture, std::uint32_t level, std::uint32_t layer, Copy copy,
                     Perform perform) {
    const Lock lock;
    bool recorded = false;
    if (recorder().wanted() && !list_is_compiled() && context_is_usable(call)) {
        const Quiet quiet;
        copy.call = call;
        copy.from = read_target();
        copy.to = drawn_texture(texture, level, layer);
        recorded = is_whole(copy.from, copy.to) && copy.width > 0 && copy.height > 0;
        if (recorded)
            recorder().copy(copy);
        else
            recorder().count(call);
    }
    perform();
    if (!recorded) texture_changed(texture);
}

std::uint32_t face_of(GLenum target) {
    const bool face = target >= GL_TEXTURE_CUBE_MAP_POSITIVE_X && target <= GL_TEXTURE_CUBE_MAP_NEGATIVE_Z;
    return face ? target - GL_TEXTURE_CUBE_MAP_POSITIVE_X : 0;
}

Copy rectangle(GLint x, GLint y, GLsizei width, GLsizei height, GLint to_x, GLint to_y) {
    Copy copy;
    copy.x = x;
    copy.y = y;
    copy.to_x = to_x;
    copy.to_y = to_y;
    copy.width = static_cast<std::uint32_t>(std::max(width, 0));
    copy.height = static_cast<std::uint32_t>(std::max(height, 0));
    return copy;
}

bool has_samples(GLenum framebuffer) {
    const GLint before = integer(GL_READ_FRAMEBUFFER_BINDING);
    if (framebuffer == GL_DRAW_FRAMEBUFFER)
        REAL(glBindFramebuffer)(GL_READ_FRAMEBUFFER, static_cast<GLuint>(integer(GL_DRAW_FRAMEBUFFER_BINDING)));
    const bool several = integer(GL_SAMPLES) > 1;
    REAL(glBindFramebuffer)(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
    return several;
}

GLint extent(const std::array<std::int32_t, 4>& corners, std::size_t axis) {
    return corners.at(axis + 2) - corners.at(axis);
}

bool only_moves(const Blit& blit) {
    const auto same = [&](std::size_t axis) {
        return extent(blit.source, axis) > 0 && extent(blit.source, axis) == extent(blit.destination, axis);
    };
    return !blit.scissor_test && same(0) && same(1);
}

void record_one_blit(Blit blit, const Target& from, const Target& to) {
    if (!is_whole(from, to)) return;
    if (!only_moves(blit)) {
        blit.from = from;
        blit.to = to;
        recorder().blit(blit);
        return;
    }
    Copy copy = rectangle(blit.source[0], blit.source[1], extent(blit.source, 0), extent(blit.source, 1),
                          blit.destination[0], blit.destination[1]);
    copy.call = blit.call;
    copy.from = from;
    copy.to = to;
    recorder().copy(copy);
}

/// Why a blit cannot be recorded; empty: it can.
std::string blit_obstacle(const Targets& to, GLbitfield mask) {
    if ((mask & GL_STENCIL_BUFFER_BIT) != 0 && to.stencil.surface >= 0) return "of stencils";
    if (has_samples(GL_READ_FRAMEBUFFER) || has_samples(GL_DRAW_FRAMEBUFFER)) return "of several samples a pixel";
    return {};
}

bool is_same(const Target& a, const Target& b) {
    return a.surface == b.surface && a.level == b.level && a.layer == b.layer;
}

/// Of colours and depths.
void record_blit(Blit blit, GLbitfield mask) {
    // An error of the program's, of which nothing comes.
    if (blit.linear && (mask & (GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT)) != 0) return;
    const Targets to = draw_targets();
    const bool colours = (mask & GL_COLOR_BUFFER_BIT) != 0, depths = (mask & GL_DEPTH_BUFFER_BIT) != 0;
    const Target from = colours ? read_target() : Target{}, depth = depths ? read_depth_target() : Target{};
    std::string obstacle = blit_obstacle(to, mask);
    for (const Target& target : to.colours)
        if (colours && is_whole(from, target) && is_same(from, target)) obstacle = "within one surface";
    if (depths && is_whole(depth, to.depth) && is_same(depth, to.depth)) obstacle = "within one surface";
    if (!obstacle.empty()) {
        recorder().count(blit.call + " " + obstacle);
        draw_targets_changed();
        return;
    }
    blit.scissor_test = REAL(glIsEnabled)(GL_SCISSOR_TEST) != GL_FALSE;
    REAL(glGetIntegerv)(GL_SCISSOR_BOX, blit.scissor.data());
    if (colours)
        for (const Target& target : to.colours) record_one_blit(blit, from, target);
    if (depths) record_one_blit(blit, depth, to.depth);
}

} // namespace

} // namespace record

EXPORTED void glClear(GLbitfield mask) {
    record::clear(
        "glClear",
        [&](record_stream::Clear& clear) {
            using record::value_of;
            if ((mask & GL_COLOR_BUFFER_BIT) != 0) clear.colours = record::all_targets;
            for (std::size_t i = 0; i < 4; ++i)
                clear.colour.at(i) = static_cast<float>(value_of(clear.state, GL_COLOR_CLEAR_VALUE, i));
            clear.depth = (mask & GL_DEPTH_BUFFER_BIT) != 0;
            clear.depth_value = static_cast<float>(value_of(clear.state, GL_DEPTH_CLEAR_VALUE));
            clear.stencil = (mask & GL_STENCIL_BUFFER_BIT) != 0;
            clear.stencil_value = static_cast<GLint>(value_of(clear.state, GL_STENCIL_CLEAR_VALUE));
            if ((mask & GL_ACCUM_BUFFER_BIT) != 0) record::recorder().count("glClear of the accumulation buffer");
            return clear.colours != 0 || clear.depth || clear.stencil;
        },
        [&] {
            REAL(glClear)
            (mask);
        });
}

EXPORTED void glClearBufferfv(GLenum buffer, GLint drawbuffer, const GLfloat* value) {
    record::clear(
        "glClearBufferfv",
        [&](record_stream::Clear& clear) { return record::fill_buffer(clear, buffer, drawbuffer, value); },
        [&] {
            REAL(glClearBufferfv)
            (buffer, drawbuffer, value);
        });
}
EXPORTED void glClearBufferiv(GLenum buffer, GLint drawbuffer, const GLint* value) {
    record::clear(
        "glClearBufferiv", [&](record_stream::Clear& clear) { return record::fill_integers(clear, buffer, value); },
        [&] {
            REAL(glClearBufferiv)
            (buffer, drawbuffer, value);
        });
}
EXPORTED void glClearBufferuiv(GLenum buffer, GLint drawbuffer, const GLuint* value) {
    record::recorder().count("glClearBufferuiv");
    REAL(glClearBufferuiv)(buffer, drawbuffer, value);
}
EXPORTED void glClearBufferfi(GLenum buffer, GLint drawbuffer, GLfloat depth, GLint stencil) {
    record::clear(
        "glClearBufferfi", [&](record_stream::Clear& clear) { return record::fill_both(clear, depth, stencil); },
        [&] {
            REAL(glClearBufferfi)
            (buffer, drawbuffer, depth, stencil);
        });
}
EXPORTED void glClearNamedFramebufferfv(GLuint framebuffer, GLenum buffer, GLint drawbuffer, const GLfloat* value) {
    const record::DrawFramebuffer bound(framebuffer);
    glClearBufferfv(buffer, drawbuffer, value);
}
EXPORTED void glClearNamedFramebufferiv(GLuint framebuffer, GLenum buffer, GLint drawbuffer, const GLint* value) {
    const record::DrawFramebuffer bound(framebuffer);
    glClearBufferiv(buffer, drawbuffer, value);
}
EXPORTED void glClearNamedFramebufferfi(GLuint framebuffer, GLenum buffer, GLint drawbuffer, GLfloat depth,
                                        GLint stencil) {
    const record::DrawFramebuffer bound(framebuffer);
    glClearBufferfi(buffer, drawbuffer, depth, stencil);
}

EXPORTED void glCopyTexSubImage2D(GLenum target, GLint level, GLint to_x, GLint to_y, GLint x, GLint y, GLsizei width,
                                  GLsizei height) {
    record::copy_to_texture("glCopyTexSubImage2D", record::bound_texture(target), static_cast<std::uint32_t>(level),
                            record::face_of(target), record::rectangle(x, y, width, height, to_x, to_y), [&] {
                                REAL(glCopyTexSubImage2D)(target, level, to_x, to_y, x, y, width, height);
                            });
}
EXPORTED void glCopyTexSubImage3D(GLenum target, GLint level, GLint to_x, GLint to_y, GLint layer, GLint x, GLint y,
                                  GLsizei width, GLsizei height) {
    record::copy_to_texture("glCopyTexSubImage3D", record::bound_texture(target), static_cast<std::uint32_t>(level),
                            static_cast<std::uint32_t>(layer), record::rectangle(x, y, width, height, to_x, to_y), [&] {
                                REAL(glCopyTexSubImage3D)(target, level, to_x, to_y, layer, x, y, width, height);
                            });
}
EXPORTED void glCopyTextureSubImage2D(GLuint texture, GLint level, GLint to_x, GLint to_y, GLint x, GLint y,
                                      GLsizei width, GLsizei height) {
    record::copy_to_texture("glCopyTextureSubImage2D", texture, static_cast<std::uint32_t>(level), 0,
                            record::rectangle(x, y, width, height, to_x, to_y), [&] {
                                REAL(glCopyTextureSubImage2D)(texture, level, to_x, to_y, x, y, width, height);
                            });
}
EXPORTED void glCopyTextureSubImage3D(GLuint texture, GLint level, GLint to_x, GLint to_y, GLint layer, GLint x,
                                      GLint y, GLsizei width, GLsizei height) {
    record::copy_to_texture("glCopyTextureSubImage3D", texture, static_cast<std::uint32_t>(level),
                            static_cast<std::uint32_t>(layer), record::rectangle(x, y, width, height, to_x, to_y), [&] {
                                REAL(glCopyTextureSubImage3D)(texture, level, to_x, to_y, layer, x, y, width, height);
                            });
}
// Makes the texture anew: its texels are read when they are used next.
EXPORTED void glCopyTexImage2D(GLenum target, GLint level, GLenum format, GLint x, GLint y, GLsizei width,
                               GLsizei height, GLint border) {
    REAL(glCopyTexImage2D)(target, level, format, x, y, width, height, border);
    const record::Lock lock;
    record::recorder().count("glCopyTexImage2D (the driver's texels are taken)");
    record::bound_texture_changed(target);
}

EXPORTED void glBlitFramebuffer(GLint x0, GLint y0, GLint x1, GLint y1, GLint to_x0, GLint to_y0, GLint to_x1,
                                GLint to_y1, GLbitfield mask, GLenum filter) {
    {
        const record::Lock lock;
        if (record::recorder().wanted() && record::context_is_usable("glBlitFramebuffer")) {
            const record::Quiet quiet;
            record_stream::Blit blit;
            blit.call = "glBlitFramebuffer";
            blit.source = {x0, y0, x1, y1};
            blit.destination = {to_x0, to_y0, to_x1, to_y1};
            blit.linear = filter == GL_LINEAR;
            record::record_blit(blit, mask);
        }
    }
    REAL(glBlitFramebuffer)(x0, y0, x1, y1, to_x0, to_y0, to_x1, to_y1, mask, filter);
}
ALSO_NAMED(glBlitFramebufferEXT, glBlitFramebuffer);

EXPORTED void glBlitNamedFramebuffer(GLuint from, GLuint to, GLint x0, GLint y0, GLint x1, GLint y1, GLint to_x0,
                                     GLint to_y0, GLint to_x1, GLint to_y1, GLbitfield mask, GLenum filter) {
    const record::DrawFramebuffer bound(to);
    const GLint before = record::integer(GL_READ_FRAMEBUFFER_BINDING);
    REAL(glBindFramebuffer)(GL_READ_FRAMEBUFFER, from);
    glBlitFramebuffer(x0, y0, x1, y1, to_x0, to_y0, to_x1, to_y1, mask, filter);
    REAL(glBindFramebuffer)(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
}

std::span<const record::Hook> record::surface_hooks() {
    static const std::array hooks{HOOK(glClear),
                                  HOOK(glClearBufferfv),
                                  HOOK(glClearBufferiv),
                                  HOOK(glClearBufferuiv),
                                  HOOK(glClearBufferfi),
                                  HOOK(glClearNamedFramebufferfv),
                                  HOOK(glClearNamedFramebufferiv),
                                  HOOK(glClearNamedFramebufferfi),
                                  HOOK(glCopyTexSubImage2D),
                                  HOOK(glCopyTexSubImage3D),
                                  HOOK(glCopyTextureSubImage2D),
                                  HOOK(glCopyTextureSubImage3D),
                                  HOOK(glCopyTexImage2D),
                                  HOOK(glBlitFramebuffer),
                                  HOOK(glBlitFramebufferEXT),
                                  HOOK(glBlitNamedFramebuffer)};
    return hooks;
}
