// Elements of vertex and index arrays in OpenGL's types, as both ends of the stream see them.
#pragma once

#include "traces/record_module/stream.hpp"

#include <GL/gl.h>

#include <GL/glext.h>

#include <algorithm>

namespace record_stream {

/// Bytes of a number; 0: of a type that is not known, or whose numbers share a word.
constexpr std::uint32_t type_bytes(std::uint32_t type) {
    switch (type) {
    case GL_BYTE:
    case GL_UNSIGNED_BYTE:
        return 1;
    case GL_SHORT:
    case GL_UNSIGNED_SHORT:
    case GL_HALF_FLOAT:
        return 2;
    case GL_INT:
    case GL_UNSIGNED_INT:
    case GL_FLOAT:
    case GL_FIXED:
        return 4;
    case GL_DOUBLE:
        return 8;
    default:
        return 0;
    }
}

/// x, y and z of 10 bits and w of 2 in a word.
constexpr bool is_packed(std::uint32_t type) {
    return type == GL_INT_2_10_10_10_REV || type == GL_UNSIGNED_INT_2_10_10_10_REV;
}

inline std::uint32_t components_of(const Array& array) {
    return array.components == GL_BGRA ? 4 : std::clamp(array.components, 1U, 4U);
}

/// Of a vertex; 0: its type is not known.
inline std::uint32_t element_bytes(const Array& array) {
    return is_packed(array.type) ? 4 : type_bytes(array.type) * components_of(array);
}

/// Of an index; the driver refuses draws with a type that is none of the three.
constexpr std::uint32_t index_bytes(std::uint32_t type) {
    return type == GL_UNSIGNED_BYTE ? 1 : type == GL_UNSIGNED_SHORT ? 2 : 4;
}

} // namespace record_stream
