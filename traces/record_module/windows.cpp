// Where frames end, contexts go, and errors are asked for.
#include "traces/record_module/context.hpp"
#include "traces/record_module/draws.hpp"
#include "traces/record_module/recorder.hpp"
#include "traces/record_module/surfaces.hpp"

namespace {

void end_frame(const char* call) {
    const record::Lock lock;
    if (!record::recorder().active()) return;
    record_stream::Targets shown;
    if (record::recorder().wanted() && record::context_is_usable(call)) {
        const record::Quiet quiet;
        shown = record::window_targets();
    }
    record::recorder().end_frame(shown);
    record::forget_drawable_sizes();
}

} // namespace

// GLX 1.4 and EGL 1.5, whose headers are not asked for: pointers and handles as they are passed.
// NOLINTBEGIN(readability-identifier-naming): their names
EXPORTED void glXSwapBuffers(void* display, unsigned long drawable) {
    end_frame("glXSwapBuffers");
    REAL(glXSwapBuffers)(display, drawable);
}
EXPORTED void glXDestroyContext(void* display, void* context) {
    {
        const record::Lock lock;
        record::forget_context(context);
    }
    REAL(glXDestroyContext)(display, context);
}
EXPORTED unsigned eglSwapBuffers(void* display, void* surface) {
    end_frame("eglSwapBuffers");
    return REAL(eglSwapBuffers)(display, surface);
}
EXPORTED unsigned eglSwapBuffersWithDamageKHR(void* display, void* surface, const int* rectangles, int count) {
    end_frame("eglSwapBuffersWithDamageKHR");
    return REAL(eglSwapBuffersWithDamageKHR)(display, surface, rectangles, count);
}
EXPORTED unsigned eglSwapBuffersWithDamageEXT(void* display, void* surface, const int* rectangles, int count) {
    end_frame("eglSwapBuffersWithDamageEXT");
    return REAL(eglSwapBuffersWithDamageEXT)(display, surface, rectangles, count);
}
EXPORTED unsigned eglDestroyContext(void* display, void* context) {
    {
        const record::Lock lock;
        record::forget_context(context);
    }
    return REAL(eglDestroyContext)(display, context);
}
// NOLINTEND(readability-identifier-naming)

EXPORTED GLenum glGetError() {
    const record::Lock lock;
    return record::take_error();
}

std::span<const record::Hook> record::window_hooks() {
    static const std::array hooks{HOOK(glXSwapBuffers),
                                  HOOK(glXDestroyContext),
                                  HOOK(eglSwapBuffers),
                                  HOOK(eglSwapBuffersWithDamageKHR),
                                  HOOK(eglSwapBuffersWithDamageEXT),
                                  HOOK(eglDestroyContext),
                                  HOOK(glGetError)};
    return hooks;
}
