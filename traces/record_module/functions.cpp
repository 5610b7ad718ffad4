// Where programs look for OpenGL's functions: dlsym, glXGetProcAddress and eglGetProcAddress give them ours, as the
// dynamic linker does with the exported ones.
#include "traces/record_module/functions.hpp"

#include <array>
#include <cstring>
#include <dlfcn.h>

namespace record {

namespace {

using Lookup = void* (*)(void*, const char*);
using GetProcAddress = void* (*)(const char*);

Lookup real_dlsym() {
    static const Lookup found = [] {
        for (const char* version : {"GLIBC_2.2.5", "GLIBC_2.17", "GLIBC_2.34"}) // x86-64, AArch64, since glibc 2.34
            if (void* address = ::dlvsym(RTLD_NEXT, "dlsym", version)) return reinterpret_cast<Lookup>(address);
        return Lookup{};
    }();
    return found;
}

void* library(const char* name) { return ::dlopen(name, RTLD_LAZY | RTLD_LOCAL); }

template <class Function>
Function function_in(void* handle, const char* name) {
    return handle == nullptr ? Function{} : reinterpret_cast<Function>(real_dlsym()(handle, name));
}

void* hook_of(const char* name) {
    using Table = std::span<const Hook> (*)();
    static constexpr std::array<Table, 9> tables{lookup_hooks, draw_hooks,    surface_hooks,
                                                 upload_hooks, program_hooks, unrecorded_hooks,
                                                 vertex_hooks, list_hooks,    window_hooks};
    if (name[0] != 'g' && name[0] != 'e') return nullptr;
    for (const Table table : tables)
        for (const Hook& hook : table())
            if (std::strcmp(hook.name, name) == 0) return hook.function;
    return nullptr;
}

/// Ours in place of one that exists.
void* replaced(const char* name, void* found) {
    void* const hook = found == nullptr ? nullptr : hook_of(name);
    return hook == nullptr ? found : hook;
}

} // namespace

void* real_function(const char* name) {
    if (name[0] != 'e') {
        static void* const gl = library("libGL.so.1");
        static const auto of_glx = function_in<GetProcAddress>(gl, "glXGetProcAddressARB");
        if (void* found = function_in<void*>(gl, name)) return found;
        if (of_glx != nullptr)
            if (void* found = of_glx(name)) return found;
    }
    static void* const egl = library("libEGL.so.1");
    static const auto of_egl = function_in<GetProcAddress>(egl, "eglGetProcAddress");
    if (void* found = function_in<void*>(egl, name)) return found;
    return of_egl == nullptr ? nullptr : of_egl(name);
}

void* function_of_loaded(const char* name_of_library, const char* name) {
    return function_in<void*>(::dlopen(name_of_library, RTLD_LAZY | RTLD_NOLOAD), name);
}

} // namespace record

// What is none of ours is looked up by a jump, not a call (-O1 on), so that RTLD_NEXT goes on from the program's
// library.
EXPORTED void* dlsym(void* handle, const char* name) noexcept {
    const auto lookup = record::real_dlsym();
    void* const hook = record::hook_of(name);
    if (hook == nullptr) return lookup(handle, name);
    return lookup(handle, name) == nullptr ? nullptr : hook;
}

// NOLINTBEGIN(readability-identifier-naming): names of GLX and EGL
EXPORTED void* glXGetProcAddressARB(const char* name) {
    return record::replaced(
        name, reinterpret_cast<void* (*)(const char*)>(record::real_function("glXGetProcAddressARB"))(name));
}
EXPORTED void* glXGetProcAddress(const char* name) { return glXGetProcAddressARB(name); }

EXPORTED void* eglGetProcAddress(const char* name) {
    return record::replaced(name,
                            reinterpret_cast<void* (*)(const char*)>(record::real_function("eglGetProcAddress"))(name));
}
// NOLINTEND(readability-identifier-naming)

std::span<const record::Hook> record::lookup_hooks() {
    static const std::array hooks{HOOK(glXGetProcAddressARB), HOOK(glXGetProcAddress), HOOK(eglGetProcAddress)};
    return hooks;
}
