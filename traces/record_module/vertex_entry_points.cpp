// The entry points that set an attribute of a vertex, or make one. Lists of macros, as each exists in a dozen types.
#include "traces/record_module/immediate.hpp"

#include <limits>
#include <type_traits>

namespace {

using record_stream::slot_colour, record_stream::slot_fog, record_stream::slot_normal, record_stream::slot_secondary,
    record_stream::slot_vertex;

template <class T>
float plain(T value) {
    return static_cast<float>(value);
}

/// Whole numbers stand for 0 to 1 or -1 to 1 (OpenGL 4.5, section 2.3.5).
template <class T>
float normalized(T value) {
    if constexpr (std::is_floating_point_v<T>)
        return static_cast<float>(value);
    else
        return std::max(static_cast<float>(static_cast<double>(value) / std::numeric_limits<T>::max()), -1.0F);
}

std::uint32_t coordinates(GLenum unit) {
    const std::uint32_t number = unit - GL_TEXTURE0;
    return record_stream::slot_texcoord + (number < 8 ? number : 7);
}

/// Number 0 is the vertex itself.
std::uint32_t numbered(GLuint index) {
    return index == 0 ? std::uint32_t{slot_vertex} : record_stream::slot_generic + (index < 16 ? index : 15);
}

} // namespace

// FORM_n: a function of n values, and its twin that takes them from memory.
#define FORM_1(function, type, slot, as)                                                                               \
    EXPORTED void function(type x) {                                                                                   \
        record::attribute(slot, 1, as(x));                                                                             \
        REAL(function)(x);                                                                                             \
    }                                                                                                                  \
    EXPORTED void function##v(const type* v) {                                                                         \
        record::attribute(slot, 1, as(v[0]));                                                                          \
        REAL(function##v)(v);                                                                                          \
    }
#define FORM_2(function, type, slot, as)                                                                               \
    EXPORTED void function(type x, type y) {                                                                           \
        record::attribute(slot, 2, as(x), as(y));                                                                      \
        REAL(function)(x, y);                                                                                          \
    }                                                                                                                  \
    EXPORTED void function##v(const type* v) {                                                                         \
        record::attribute(slot, 2, as(v[0]), as(v[1]));                                                                \
        REAL(function##v)(v);                                                                                          \
    }
#define FORM_3(function, type, slot, as)                                                                               \
    EXPORTED void function(type x, type y, type z) {                                                                   \
        record::attribute(slot, 3, as(x), as(y), as(z));                                                               \
        REAL(function)(x, y, z);                                                                                       \
    }                                                                                                                  \
    EXPORTED void function##v(const type* v) {                                                                         \
        record::attribute(slot, 3, as(v[0]), as(v[1]), as(v[2]));                                                      \
        REAL(function##v)(v);                                                                                          \
    }
#define FORM_4(function, type, slot, as)                                                                               \
    EXPORTED void function(type x, type y, type z, type w) {                                                           \
        record::attribute(slot, 4, as(x), as(y), as(z), as(w));                                                        \
        REAL(function)(x, y, z, w);                                                                                    \
    }                                                                                                                  \
    EXPORTED void function##v(const type* v) {                                                                         \
        record::attribute(slot, 4, as(v[0]), as(v[1]), as(v[2]), as(v[3]));                                            \
        REAL(function##v)(v);                                                                                          \
    }

// INDEXED_n: the same with a unit or a number in front.
#define INDEXED_1(function, index, type, slot, as)                                                                     \
    EXPORTED void function(index i, type x) {                                                                          \
        record::attribute(slot(i), 1, as(x));                                                                          \
        REAL(function)(i, x);                                                                                          \
    }                                                                                                                  \
    EXPORTED void function##v(index i, const type* v) {                                                                \
        record::attribute(slot(i), 1, as(v[0]));                                                                       \
        REAL(function##v)(i, v);                                                                                       \
    }
#define INDEXED_2(function, index, type, slot, as)                                                                     \
    EXPORTED void function(index i, type x, type y) {                                                                  \
        record::attribute(slot(i), 2, as(x), as(y));                                                                   \
        REAL(function)(i, x, y);                                                                                       \
    }                                                                                                                  \
    EXPORTED void function##v(index i, const type* v) {                                                                \
        record::attribute(slot(i), 2, as(v[0]), as(v[1]));                                                             \
        REAL(function##v)(i, v);                                                                                       \
    }
#define INDEXED_3(function, index, type, slot, as)                                                                     \
    EXPORTED void function(index i, type x, type y, type z) {                                                          \
        record::attribute(slot(i), 3, as(x), as(y), as(z));                                                            \
        REAL(function)(i, x, y, z);                                                                                    \
    }                                                                                                                  \
    EXPORTED void function##v(index i, const type* v) {                                                                \
        record::attribute(slot(i), 3, as(v[0]), as(v[1]), as(v[2]));                                                   \
        REAL(function##v)(i, v);                                                                                       \
    }
#define INDEXED_4(function, index, type, slot, as)                                                                     \
    EXPORTED void function(index i, type x, type y, type z, type w) {                                                  \
        record::attribute(slot(i), 4, as(x), as(y), as(z), as(w));                                                     \
        REAL(function)(i, x, y, z, w);                                                                                 \
    }                                                                                                                  \
    EXPORTED void function##v(index i, const type* v) {                                                                \
        record::attribute(slot(i), 4, as(v[0]), as(v[1]), as(v[2]), as(v[3]));                                         \
        REAL(function##v)(i, v);                                                                                       \
    }
#define VECTOR_4(function, type, as)                                                                                   \
    EXPORTED void function(GLuint i, const type* v) {                                                                  \
        record::attribute(numbered(i), 4, as(v[0]), as(v[1]), as(v[2]), as(v[3]));                                     \
        REAL(function)(i, v);                                                                                          \
    }

#define FOUR_TYPES(X, n, name, slot)                                                                                   \
    X(n, name##d, GLdouble, slot, plain)                                                                               \
    X(n, name##f, GLfloat, slot, plain) X(n, name##i, GLint, slot, plain) X(n, name##s, GLshort, slot, plain)
#define SIGNED_TYPES(X, n, name, slot)                                                                                 \
    X(n, name##b, GLbyte, slot, normalized)                                                                            \
    X(n, name##d, GLdouble, slot, normalized)                                                                          \
    X(n, name##f, GLfloat, slot, normalized)                                                                           \
    X(n, name##i, GLint, slot, normalized) X(n, name##s, GLshort, slot, normalized)
#define ALL_TYPES(X, n, name, slot)                                                                                    \
    SIGNED_TYPES(X, n, name, slot)                                                                                     \
    X(n, name##ub, GLubyte, slot, normalized)                                                                          \
    X(n, name##ui, GLuint, slot, normalized) X(n, name##us, GLushort, slot, normalized)

#define PLAIN_FUNCTIONS(X)                                                                                             \
    FOUR_TYPES(X, 2, glVertex2, slot_vertex)                                                                           \
    FOUR_TYPES(X, 3, glVertex3, slot_vertex)                                                                           \
    FOUR_TYPES(X, 4, glVertex4, slot_vertex)                                                                           \
    SIGNED_TYPES(X, 3, glNormal3, slot_normal)                                                                         \
    ALL_TYPES(X, 3, glColor3, slot_colour)                                                                             \
    ALL_TYPES(X, 4, glColor4, slot_colour)                                                                             \
    FOUR_TYPES(X, 1, glTexCoord1, record_stream::slot_texcoord)                                                        \
    FOUR_TYPES(X, 2, glTexCoord2, record_stream::slot_texcoord)                                                        \
    FOUR_TYPES(X, 3, glTexCoord3, record_stream::slot_texcoord)                                                        \
    FOUR_TYPES(X, 4, glTexCoord4, record_stream::slot_texcoord)

// With older twins whose names end in EXT.
#define EXTENDED_FUNCTIONS(X)                                                                                          \
    ALL_TYPES(X, 3, glSecondaryColor3, slot_secondary)                                                                 \
    X(1, glFogCoordf, GLfloat, slot_fog, plain) X(1, glFogCoordd, GLdouble, slot_fog, plain)

// With older twins whose names end in ARB.
#define UNIT_FUNCTIONS(X)                                                                                              \
    FOUR_TYPES(X, 1, glMultiTexCoord1, coordinates)                                                                    \
    FOUR_TYPES(X, 2, glMultiTexCoord2, coordinates)                                                                    \
    FOUR_TYPES(X, 3, glMultiTexCoord3, coordinates)                                                                    \
    FOUR_TYPES(X, 4, glMultiTexCoord4, coordinates)
#define THREE_TYPES(X, n, name)                                                                                        \
    X(n, name##d, GLdouble, numbered, plain)                                                                           \
    X(n, name##f, GLfloat, numbered, plain) X(n, name##s, GLshort, numbered, plain)
#define NUMBERED_FUNCTIONS(X)                                                                                          \
    THREE_TYPES(X, 1, glVertexAttrib1)                                                                                 \
    THREE_TYPES(X, 2, glVertexAttrib2)                                                                                 \
    THREE_TYPES(X, 3, glVertexAttrib3)                                                                                 \
    THREE_TYPES(X, 4, glVertexAttrib4)                                                                                 \
    X(4, glVertexAttrib4Nub, GLubyte, numbered, normalized)
#define VECTOR_FUNCTIONS(X)                                                                                            \
    X(glVertexAttrib4bv, GLbyte, plain)                                                                                \
    X(glVertexAttrib4iv, GLint, plain)                                                                                 \
    X(glVertexAttrib4ubv, GLubyte, plain)                                                                              \
    X(glVertexAttrib4uiv, GLuint, plain)                                                                               \
    X(glVertexAttrib4usv, GLushort, plain)                                                                             \
    X(glVertexAttrib4Nbv, GLbyte, normalized)                                                                          \
    X(glVertexAttrib4Niv, GLint, normalized)                                                                           \
    X(glVertexAttrib4Nsv, GLshort, normalized)                                                                         \
    X(glVertexAttrib4Nuiv, GLuint, normalized)                                                                         \
    X(glVertexAttrib4Nusv, GLushort, normalized)

#define DEFINE(n, function, type, slot, as) FORM_##n(function, type, slot, as)
#define DEFINE_EXTENDED(n, function, type, slot, as)                                                                   \
    FORM_##n(function, type, slot, as) ALSO_NAMED(function##EXT, function);                                            \
    ALSO_NAMED(function##vEXT, function##v);
#define DEFINE_UNIT(n, function, type, slot, as)                                                                       \
    INDEXED_##n(function, GLenum, type, slot, as) ALSO_NAMED(function##ARB, function);                                 \
    ALSO_NAMED(function##vARB, function##v);
#define DEFINE_NUMBERED(n, function, type, slot, as)                                                                   \
    INDEXED_##n(function, GLuint, type, slot, as) ALSO_NAMED(function##ARB, function);                                 \
    ALSO_NAMED(function##vARB, function##v);
#define DEFINE_VECTOR(function, type, as) VECTOR_4(function, type, as) ALSO_NAMED(function##ARB, function);

PLAIN_FUNCTIONS(DEFINE)
EXTENDED_FUNCTIONS(DEFINE_EXTENDED)
UNIT_FUNCTIONS(DEFINE_UNIT)
NUMBERED_FUNCTIONS(DEFINE_NUMBERED)
VECTOR_FUNCTIONS(DEFINE_VECTOR)

#define ROWS(n, function, type, slot, as) HOOK(function), HOOK(function##v),
#define ROWS_EXTENDED(n, function, type, slot, as)                                                                     \
    HOOK(function), HOOK(function##v), HOOK(function##EXT), HOOK(function##vEXT),
#define ROWS_ARB(n, function, type, slot, as)                                                                          \
    HOOK(function), HOOK(function##v), HOOK(function##ARB), HOOK(function##vARB),
#define ROWS_VECTOR(function, type, as) HOOK(function), HOOK(function##ARB),

std::span<const record::Hook> record::vertex_hooks() {
    static const auto hooks = std::to_array<record::Hook>({PLAIN_FUNCTIONS(ROWS) EXTENDED_FUNCTIONS(
        ROWS_EXTENDED) UNIT_FUNCTIONS(ROWS_ARB) NUMBERED_FUNCTIONS(ROWS_ARB) VECTOR_FUNCTIONS(ROWS_VECTOR)});
    return hooks;
}
