#include "traces/record_module/context.hpp"

#include "traces/record_module/recorder.hpp"

#include <map>
#include <string_view>

namespace record {

namespace {

// Constants of GLX 1.4 and EGL 1.5, whose headers ask for more packages than these few functions are worth.
constexpr int egl_draw = 0x3059, egl_width = 0x3057, egl_height = 0x3056;
constexpr int glx_width = 0x801D, glx_height = 0x801E;

constexpr std::array<GLenum, 8> packing{GL_PACK_SWAP_BYTES,  GL_PACK_LSB_FIRST,   GL_PACK_ROW_LENGTH,
                                        GL_PACK_SKIP_ROWS,   GL_PACK_SKIP_PIXELS, GL_PACK_ALIGNMENT,
                                        GL_PACK_SKIP_IMAGES, GL_PACK_IMAGE_HEIGHT};
constexpr std::size_t alignment = 5;

std::map<const void*, ContextFacts>& contexts() {
    static auto* const all = new std::map<const void*, ContextFacts>;
    return *all;
}

std::map<const void*, GLenum>& pending_errors() {
    static auto* const all = new std::map<const void*, GLenum>;
    return *all;
}

struct Sizes {
    std::map<const void*, Size> by_context;
};
Sizes& sizes() {
    static auto* const all = new Sizes;
    return *all;
}

template <class Result, FunctionName name, class... Arguments>
Result call(Arguments... arguments) {
    static const auto found = reinterpret_cast<Result (*)(Arguments...)>(real_function(name.text));
    return found == nullptr ? Result{} : found(arguments...);
}

bool has_egl() {
    static bool found = false;
    if (!found) found = function_of_loaded("libEGL.so.1", "eglGetCurrentContext") != nullptr;
    return found;
}

void* glx_context() { return call<void*, "glXGetCurrentContext">(); }

const void* context_address() {
    if (const void* context = glx_context()) return context;
    return has_egl() ? call<void*, "eglGetCurrentContext">() : nullptr;
}

const char* text(GLenum name) {
    const auto* found = reinterpret_cast<const char*>(REAL(glGetString)(name));
    return found == nullptr ? "" : found;
}

ContextFacts facts_of_current() {
    static std::uint64_t number = 0;
    ContextFacts facts;
    facts.number = ++number;
    facts.version = text(GL_VERSION);
    facts.renderer = text(GL_RENDERER);
    if (facts.version.starts_with("OpenGL ES")) return facts;
    const int major = integer(GL_MAJOR_VERSION), minor = integer(GL_MINOR_VERSION);
    facts.usable = major > 4 || (major == 4 && minor >= 5);
    facts.compatibility = (integer(GL_CONTEXT_PROFILE_MASK) & GL_CONTEXT_CORE_PROFILE_BIT) == 0;
    return facts;
}

int ignore_error(void* /*display*/, void* /*event*/) { return 0; }

/// The window system may know a drawable of GLX under either of two kinds, and asking for the wrong one is an error.
Size size_of_glx() {
    void* const display = call<void*, "glXGetCurrentDisplay">();
    const auto drawable = call<unsigned long, "glXGetCurrentDrawable">();
    using Handler = int (*)(void*, void*);
    const auto set_handler =
        reinterpret_cast<Handler (*)(Handler)>(function_of_loaded("libX11.so.6", "XSetErrorHandler"));
    const auto geometry =
        reinterpret_cast<int (*)(void*, unsigned long, unsigned long*, int*, int*, unsigned*, unsigned*, unsigned*,
                                 unsigned*)>(function_of_loaded("libX11.so.6", "XGetGeometry"));
    if (display == nullptr || drawable == 0 || set_handler == nullptr || geometry == nullptr) return {};
    const Handler before = set_handler(ignore_error);
    unsigned long root = 0;
    int x = 0, y = 0;
    unsigned width = 0, height = 0, border = 0, depth = 0;
    if (geometry(display, drawable, &root, &x, &y, &width, &height, &border, &depth) == 0) {
        width = height = 0;
        const auto query =
            reinterpret_cast<void (*)(void*, unsigned long, int, unsigned*)>(real_function("glXQueryDrawable"));
        query(display, drawable, glx_width, &width);
        query(display, drawable, glx_height, &height);
    }
    set_handler(before);
    return {width, height};
}

Size size_of_egl() {
    int width = 0, height = 0;
    void* const display = call<void*, "eglGetCurrentDisplay">();
    void* const surface = call<void*, "eglGetCurrentSurface">(egl_draw);
    call<unsigned, "eglQuerySurface">(display, surface, egl_width, &width);
    call<unsigned, "eglQuerySurface">(display, surface, egl_height, &height);
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

} // namespace

GLint integer(GLenum name) {
    std::array<GLint, 16> values{};
    REAL(glGetIntegerv)(name, values.data());
    return values[0];
}

GLint integer_at(GLenum name, GLuint index) {
    std::array<GLint, 16> values{};
    REAL(glGetIntegeri_v)(name, index, values.data());
    return values[0];
}

const ContextFacts& current_context() {
    static const ContextFacts none;
    const void* const address = context_address();
    if (address == nullptr) return none;
    const auto found = contexts().find(address);
    return found != contexts().end() ? found->second : contexts().emplace(address, facts_of_current()).first->second;
}

void forget_context(const void* context) {
    contexts().erase(context);
    pending_errors().erase(context);
    sizes().by_context.erase(context);
}

Size drawable_size() {
    Size& size = sizes().by_context[context_address()];
    if (size.width == 0) size = glx_context() != nullptr ? size_of_glx() : size_of_egl();
    if (size.width == 0 || size.height == 0) { // no window system that can be asked
        std::array<GLint, 4> viewport{};
        REAL(glGetIntegerv)(GL_VIEWPORT, viewport.data());
        return {static_cast<std::uint32_t>(viewport[0] + viewport[2]),
                static_cast<std::uint32_t>(viewport[1] + viewport[3])};
    }
    return size;
}

std::uint64_t current_drawable() {
    if (glx_context() != nullptr) return call<unsigned long, "glXGetCurrentDrawable">();
    return reinterpret_cast<std::uintptr_t>(call<void*, "eglGetCurrentSurface">(egl_draw));
}

void forget_drawable_sizes() { sizes().by_context.clear(); }

Quiet::Quiet() {
    const GLenum error = REAL(glGetError)();
    GLenum& pending = pending_errors()[context_address()];
    if (pending == GL_NO_ERROR) pending = error;
}

Quiet::~Quiet() {
    for (int i = 0; i < 8 && REAL(glGetError)() != GL_NO_ERROR; ++i) {
    } // one flag each for several kinds
}

GLenum take_error() {
    const auto pending = pending_errors().find(context_address());
    if (pending == pending_errors().end() || pending->second == GL_NO_ERROR) return REAL(glGetError)();
    const GLenum error = pending->second;
    pending->second = GL_NO_ERROR;
    return error;
}

PlainPacking::PlainPacking() : buffer_(integer(GL_PIXEL_PACK_BUFFER_BINDING)) {
    if (buffer_ != 0) REAL(glBindBuffer)(GL_PIXEL_PACK_BUFFER, 0);
    for (std::size_t i = 0; i < packing.size(); ++i) {
        kept_[i] = integer(packing[i]);
        REAL(glPixelStorei)(packing[i], i == alignment ? 1 : 0);
    }
}

PlainPacking::~PlainPacking() {
    for (std::size_t i = 0; i < packing.size(); ++i) REAL(glPixelStorei)(packing[i], kept_[i]);
    if (buffer_ != 0) REAL(glBindBuffer)(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(buffer_));
}

} // namespace record
