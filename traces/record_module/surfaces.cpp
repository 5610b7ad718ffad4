#include "traces/record_module/surfaces.hpp"

#include "traces/record_module/context.hpp"
#include "traces/record_module/recorder.hpp"
#include "traces/record_module/texels.hpp"
#include "traces/record_module/writer.hpp"

#include <map>
#include <tuple>

namespace record {

using namespace record_stream;

namespace {

enum class Kind : std::uint8_t { texture, renderbuffer, window };

constexpr GLuint window_back = 0, window_front = 1, window_depth = 2; ///< in place of names

/// Context (of windows: drawable), kind, name.
using Key = std::tuple<std::uint64_t, Kind, GLuint>;

struct Known {
    std::int32_t surface = -1;
    bool drawn = false;
    std::uint64_t changes = 0; ///< by the program, before it was read
    Size size;
};

struct Tables {
    std::map<Key, Known> known;
    std::map<std::pair<Kind, GLuint>, std::uint64_t> changes;  ///< whatever the context: contexts share objects
    std::map<std::vector<std::byte>, std::int32_t> by_content; ///< of what is sampled
    std::map<GLuint, GLenum> targets;                          ///< of textures
};
Tables& tables() {
    static auto* const all = new Tables;
    return *all;
}

Key key_of(Kind kind, GLuint name) {
    return {kind == Kind::window ? current_drawable() : current_context().number, kind, name};
}
std::uint64_t changes_of(Kind kind, GLuint name) { return tables().changes[{kind, name}]; }

Size level_size(GLuint texture, GLint level) {
    GLint width = 0, height = 0;
    REAL(glGetTextureLevelParameteriv)(texture, level, GL_TEXTURE_WIDTH, &width);
    REAL(glGetTextureLevelParameteriv)(texture, level, GL_TEXTURE_HEIGHT, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

std::int32_t drawn_attachment(Kind kind, GLuint name, const std::string& text, GLuint framebuffer, GLenum attachment,
                              Size size) {
    Known& known = tables().known[key_of(kind, name)];
    const std::uint64_t changes = changes_of(kind, name);
    if (known.surface >= 0 && known.changes == changes && known.size == size) return known.surface;
    Surface surface = describe_attachment(framebuffer, attachment, size.width, size.height);
    surface.name = text;
    known = {recorder().surface(surface), true, changes, size};
    return known.surface;
}

GLint of_attachment(GLuint framebuffer, GLenum attachment, GLenum name) {
    GLint value = 0;
    REAL(glGetNamedFramebufferAttachmentParameteriv)(framebuffer, attachment, name, &value);
    return value;
}

bool has_bits(GLenum attachment, GLenum bits) { return of_attachment(0, attachment, bits) > 0; }

Target window_colour(GLenum buffer, Size size) {
    // A window with one buffer has it under either name.
    const bool back = has_bits(GL_BACK_LEFT, GL_FRAMEBUFFER_ATTACHMENT_RED_SIZE);
    const bool front = (buffer == GL_FRONT || buffer == GL_FRONT_LEFT) && integer(GL_DOUBLEBUFFER) != GL_FALSE;
    return {drawn_attachment(Kind::window, front ? window_front : window_back, front ? "window, front" : "window", 0,
                             front || !back ? GL_FRONT_LEFT : GL_BACK_LEFT, size),
            0, 0};
}

void add_window_depth(Targets& targets, Size size) {
    const bool depth = has_bits(GL_DEPTH, GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE);
    const bool stencil = has_bits(GL_STENCIL, GL_FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE);
    if (!depth && !stencil) return;
    // Both lie in one surface; asked for either, drivers say the bits of both.
    const std::int32_t surface = drawn_attachment(Kind::window, window_depth,
                                                  depth && stencil ? "window, depth and stencil"
                                                  : depth          ? "window, depth"
                                                                   : "window, stencil",
                                                  0, depth ? GL_DEPTH : GL_STENCIL, size);
    if (depth) targets.depth.surface = surface;
    if (stencil) targets.stencil.surface = surface;
}

/// `size` becomes the smallest.
Target framebuffer_target(GLuint framebuffer, GLenum attachment, Size& size) {
    const auto ask = [&](GLenum name) { return of_attachment(framebuffer, attachment, name); };
    const GLint type = ask(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
    const auto name = static_cast<GLuint>(type == GL_NONE ? 0 : ask(GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
    if (name == 0) return {};
    const auto smaller = [&](Size other) {
        if (size.width == 0 || other.width < size.width) size.width = other.width;
        if (size.height == 0 || other.height < size.height) size.height = other.height;
    };
    if (type == GL_TEXTURE) {
        if (ask(GL_FRAMEBUFFER_ATTACHMENT_LAYERED) != GL_FALSE) recorder().count("layered framebuffers");
        const GLint level = ask(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL);
        const GLint face = ask(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_CUBE_MAP_FACE);
        const GLint layer =
            face != 0 ? face - GL_TEXTURE_CUBE_MAP_POSITIVE_X : ask(GL_FRAMEBUFFER_ATTACHMENT_TEXTURE_LAYER);
        smaller(level_size(name, level));
        return drawn_texture(name, static_cast<std::uint32_t>(level), static_cast<std::uint32_t>(layer));
    }
    GLint width = 0, height = 0;
    REAL(glGetNamedRenderbufferParameteriv)(name, GL_RENDERBUFFER_WIDTH, &width);
    REAL(glGetNamedRenderbufferParameteriv)(name, GL_RENDERBUFFER_HEIGHT, &height);
    const Size own{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    smaller(own);
    return {drawn_attachment(Kind::renderbuffer, name, "renderbuffer " + std::to_string(name), framebuffer, attachment,
                             own),
            0, 0};
}

Targets framebuffer_targets(GLuint framebuffer) {
    Targets targets;
    Size size;
    for (std::size_t i = 0; i < most_targets; ++i) {
        const auto buffer = static_cast<GLenum>(integer(static_cast<GLenum>(GL_DRAW_BUFFER0 + i)));
        if (buffer != GL_NONE) targets.colours.at(i) = framebuffer_target(framebuffer, buffer, size);
    }
    targets.depth = framebuffer_target(framebuffer, GL_DEPTH_ATTACHMENT, size);
    targets.stencil = framebuffer_target(framebuffer, GL_STENCIL_ATTACHMENT, size);
    targets.width = size.width;
    targets.height = size.height;
    return targets;
}

} // namespace

std::int32_t sampled_texture(GLuint texture, GLenum target) {
    Known& known = tables().known[key_of(Kind::texture, texture)];
    const std::uint64_t changes = changes_of(Kind::texture, texture);
    if (known.surface >= 0 && known.changes == changes) return known.surface;
    const Surface surface = describe_texture(texture, target);
    if (surface.levels.empty()) return -1;
    Surface nameless = surface;
    nameless.name.clear();
    const auto [place, is_new] = tables().by_content.try_emplace(Writer::record(Tag::surface, nameless), -1);
    if (is_new) place->second = recorder().surface(surface);
    // Those of buffers change with the buffer, of which nobody tells.
    if (surface.target != GL_TEXTURE_BUFFER) known = {place->second, false, changes, {}};
    return place->second;
}

Target drawn_texture(GLuint texture, std::uint32_t level, std::uint32_t layer) {
    Known& known = tables().known[key_of(Kind::texture, texture)];
    const std::uint64_t changes = changes_of(Kind::texture, texture);
    if (known.surface < 0 || !known.drawn || known.changes != changes) {
        const Surface surface = describe_texture(texture, tables().targets[texture]);
        if (surface.levels.empty()) return {};
        known = {recorder().surface(surface), true, changes, {}};
    }
    return {known.surface, level, layer};
}

Targets draw_targets() {
    const auto framebuffer = static_cast<GLuint>(integer(GL_DRAW_FRAMEBUFFER_BINDING));
    if (framebuffer != 0) return framebuffer_targets(framebuffer);
    Targets targets;
    targets.window = true;
    const Size size = drawable_size();
    targets.width = size.width;
    targets.height = size.height;
    for (std::size_t i = 0; i < most_targets; ++i) {
        const auto buffer = static_cast<GLenum>(integer(static_cast<GLenum>(GL_DRAW_BUFFER0 + i)));
        if (buffer != GL_NONE) targets.colours.at(i) = window_colour(buffer, size);
    }
    add_window_depth(targets, size);
    return targets;
}

Targets window_targets() {
    Targets targets;
    targets.window = true;
    const Size size = drawable_size();
    targets.width = size.width;
    targets.height = size.height;
    targets.colours[0] = window_colour(GL_BACK, size);
    return targets;
}

Target read_target() {
    const auto framebuffer = static_cast<GLuint>(integer(GL_READ_FRAMEBUFFER_BINDING));
    const auto buffer = static_cast<GLenum>(integer(GL_READ_BUFFER));
    if (buffer == GL_NONE) return {};
    Size size;
    return framebuffer == 0 ? window_colour(buffer, drawable_size()) : framebuffer_target(framebuffer, buffer, size);
}

Target read_depth_target() {
    const auto framebuffer = static_cast<GLuint>(integer(GL_READ_FRAMEBUFFER_BINDING));
    Size size;
    if (framebuffer != 0) return framebuffer_target(framebuffer, GL_DEPTH_ATTACHMENT, size);
    Targets targets;
    add_window_depth(targets, drawable_size());
    return targets.depth;
}

void texture_has_target(GLuint texture, GLenum target) { tables().targets[texture] = target; }
void texture_changed(GLuint texture) { ++tables().changes[{Kind::texture, texture}]; }
void renderbuffer_changed(GLuint renderbuffer) { ++tables().changes[{Kind::renderbuffer, renderbuffer}]; }

void draw_targets_changed() {
    const auto framebuffer = static_cast<GLuint>(integer(GL_DRAW_FRAMEBUFFER_BINDING));
    if (framebuffer == 0) {
        for (const GLuint buffer : {window_back, window_front, window_depth})
            ++tables().changes[{Kind::window, buffer}];
        return;
    }
    const auto change = [&](GLenum attachment) {
        const GLint type = of_attachment(framebuffer, attachment, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE);
        if (type == GL_NONE) return;
        const auto name =
            static_cast<GLuint>(of_attachment(framebuffer, attachment, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME));
        ++tables().changes[{type == GL_TEXTURE ? Kind::texture : Kind::renderbuffer, name}];
    };
    for (std::size_t i = 0; i < most_targets; ++i)
        if (const auto buffer = static_cast<GLenum>(integer(static_cast<GLenum>(GL_DRAW_BUFFER0 + i)));
            buffer != GL_NONE)
            change(buffer);
    change(GL_DEPTH_ATTACHMENT);
    change(GL_STENCIL_ATTACHMENT);
}

GLuint bound_texture(GLenum target) {
    struct Place {
        GLenum target, binding;
    };
    constexpr std::array<Place, 11> places{
        {{GL_TEXTURE_1D, GL_TEXTURE_BINDING_1D},
         {GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
         {GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D},
         {GL_TEXTURE_RECTANGLE, GL_TEXTURE_BINDING_RECTANGLE},
         {GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP},
         {GL_TEXTURE_1D_ARRAY, GL_TEXTURE_BINDING_1D_ARRAY},
         {GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY},
         {GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY},
         {GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER},
         {GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE},
         {GL_TEXTURE_2D_MULTISAMPLE_ARRAY, GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY}}};
    if (target >= GL_TEXTURE_CUBE_MAP_POSITIVE_X && target <= GL_TEXTURE_CUBE_MAP_NEGATIVE_Z)
        target = GL_TEXTURE_CUBE_MAP;
    for (const Place& place : places)
        if (place.target == target) return static_cast<GLuint>(integer(place.binding));
    return 0; // a proxy has no texels
}

void bound_texture_changed(GLenum target) {
    if (const GLuint texture = bound_texture(target); texture != 0) texture_changed(texture);
}

} // namespace record
