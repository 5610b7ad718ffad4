// The driver's functions, and ours in their place.
#pragma once

#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#endif
#include <GL/gl.h>

#include <GL/glext.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace record {

/// Of the driver, also where the program that is recorded sees one of ours under this name. Null: there is none.
void* real_function(const char* name);

/// The same of libraries other than OpenGL's, when the program has loaded them.
void* function_of_loaded(const char* library, const char* name);

template <std::size_t size>
struct FunctionName {
    char text[size]{};
    consteval FunctionName(const char (&source)[size]) { std::copy_n(source, size, text); }
};

template <class Function, FunctionName name>
Function real() {
    static const auto function = reinterpret_cast<Function>(real_function(name.text));
    return function;
}

/// One of ours.
struct Hook {
    const char* name;
    void* function;
};
std::span<const Hook> lookup_hooks();
std::span<const Hook> draw_hooks();
std::span<const Hook> surface_hooks();
std::span<const Hook> upload_hooks();
std::span<const Hook> program_hooks();
std::span<const Hook> unrecorded_hooks();
std::span<const Hook> vertex_hooks();
std::span<const Hook> list_hooks();
std::span<const Hook> window_hooks();

} // namespace record

/// The driver's function of this name.
#define REAL(function) (::record::real<decltype(&::function), #function>())

/// In front of the definition of one of ours.
#define EXPORTED extern "C" __attribute__((visibility("default")))

/// A row of a table of hooks.
#define HOOK(function)                                                                                                 \
    ::record::Hook { #function, reinterpret_cast < void*>(&::function) }

/// Another name of one of ours, of the same type.
#define ALSO_NAMED(other, function) EXPORTED __attribute__((alias(#function))) decltype(::function) other
