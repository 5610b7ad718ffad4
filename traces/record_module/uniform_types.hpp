// Types of uniforms.
#pragma once

#include "traces/record_module/functions.hpp"

#include <array>
#include <cstdint>

namespace record {

enum class UniformKind : std::uint8_t { number, integer, whole, truth, sampler, unknown };

struct UniformType {
    GLenum type;
    UniformKind kind;
    std::uint32_t words = 1;
    GLenum target = 0; ///< of a sampler
};

inline constexpr std::array uniform_types{
    UniformType{GL_FLOAT, UniformKind::number, 1},
    UniformType{GL_FLOAT_VEC2, UniformKind::number, 2},
    UniformType{GL_FLOAT_VEC3, UniformKind::number, 3},
    UniformType{GL_FLOAT_VEC4, UniformKind::number, 4},
    UniformType{GL_FLOAT_MAT2, UniformKind::number, 4},
    UniformType{GL_FLOAT_MAT3, UniformKind::number, 9},
    UniformType{GL_FLOAT_MAT4, UniformKind::number, 16},
    UniformType{GL_FLOAT_MAT2x3, UniformKind::number, 6},
    UniformType{GL_FLOAT_MAT2x4, UniformKind::number, 8},
    UniformType{GL_FLOAT_MAT3x2, UniformKind::number, 6},
    UniformType{GL_FLOAT_MAT3x4, UniformKind::number, 12},
    UniformType{GL_FLOAT_MAT4x2, UniformKind::number, 8},
    UniformType{GL_FLOAT_MAT4x3, UniformKind::number, 12},
    UniformType{GL_INT, UniformKind::integer, 1},
    UniformType{GL_INT_VEC2, UniformKind::integer, 2},
    UniformType{GL_INT_VEC3, UniformKind::integer, 3},
    UniformType{GL_INT_VEC4, UniformKind::integer, 4},
    UniformType{GL_UNSIGNED_INT, UniformKind::whole, 1},
    UniformType{GL_UNSIGNED_INT_VEC2, UniformKind::whole, 2},
    UniformType{GL_UNSIGNED_INT_VEC3, UniformKind::whole, 3},
    UniformType{GL_UNSIGNED_INT_VEC4, UniformKind::whole, 4},
    UniformType{GL_BOOL, UniformKind::truth, 1},
    UniformType{GL_BOOL_VEC2, UniformKind::truth, 2},
    UniformType{GL_BOOL_VEC3, UniformKind::truth, 3},
    UniformType{GL_BOOL_VEC4, UniformKind::truth, 4},
    UniformType{GL_SAMPLER_1D, UniformKind::sampler, 1, GL_TEXTURE_1D},
    UniformType{GL_SAMPLER_2D, UniformKind::sampler, 1, GL_TEXTURE_2D},
    UniformType{GL_SAMPLER_3D, UniformKind::sampler, 1, GL_TEXTURE_3D},
    UniformType{GL_SAMPLER_CUBE, UniformKind::sampler, 1, GL_TEXTURE_CUBE_MAP},
    UniformType{GL_SAMPLER_1D_SHADOW, UniformKind::sampler, 1, GL_TEXTURE_1D},
    UniformType{GL_SAMPLER_2D_SHADOW, UniformKind::sampler, 1, GL_TEXTURE_2D},
    UniformType{GL_SAMPLER_CUBE_SHADOW, UniformKind::sampler, 1, GL_TEXTURE_CUBE_MAP},
    UniformType{GL_SAMPLER_1D_ARRAY, UniformKind::sampler, 1, GL_TEXTURE_1D_ARRAY},
    UniformType{GL_SAMPLER_2D_ARRAY, UniformKind::sampler, 1, GL_TEXTURE_2D_ARRAY},
    UniformType{GL_SAMPLER_1D_ARRAY_SHADOW, UniformKind::sampler, 1, GL_TEXTURE_1D_ARRAY},
    UniformType{GL_SAMPLER_2D_ARRAY_SHADOW, UniformKind::sampler, 1, GL_TEXTURE_2D_ARRAY},
    UniformType{GL_SAMPLER_2D_RECT, UniformKind::sampler, 1, GL_TEXTURE_RECTANGLE},
    UniformType{GL_SAMPLER_2D_RECT_SHADOW, UniformKind::sampler, 1, GL_TEXTURE_RECTANGLE},
    UniformType{GL_SAMPLER_CUBE_MAP_ARRAY, UniformKind::sampler, 1, GL_TEXTURE_CUBE_MAP_ARRAY},
    UniformType{GL_SAMPLER_BUFFER, UniformKind::sampler, 1, GL_TEXTURE_BUFFER},
    UniformType{GL_SAMPLER_2D_MULTISAMPLE, UniformKind::sampler, 1, GL_TEXTURE_2D_MULTISAMPLE},
    UniformType{GL_INT_SAMPLER_2D, UniformKind::sampler, 1, GL_TEXTURE_2D},
    UniformType{GL_INT_SAMPLER_3D, UniformKind::sampler, 1, GL_TEXTURE_3D},
    UniformType{GL_INT_SAMPLER_CUBE, UniformKind::sampler, 1, GL_TEXTURE_CUBE_MAP},
    UniformType{GL_INT_SAMPLER_2D_ARRAY, UniformKind::sampler, 1, GL_TEXTURE_2D_ARRAY},
    UniformType{GL_INT_SAMPLER_BUFFER, UniformKind::sampler, 1, GL_TEXTURE_BUFFER},
    UniformType{GL_UNSIGNED_INT_SAMPLER_2D, UniformKind::sampler, 1, GL_TEXTURE_2D},
    UniformType{GL_UNSIGNED_INT_SAMPLER_3D, UniformKind::sampler, 1, GL_TEXTURE_3D},
    UniformType{GL_UNSIGNED_INT_SAMPLER_CUBE, UniformKind::sampler, 1, GL_TEXTURE_CUBE_MAP},
    UniformType{GL_UNSIGNED_INT_SAMPLER_2D_ARRAY, UniformKind::sampler, 1, GL_TEXTURE_2D_ARRAY},
    UniformType{GL_UNSIGNED_INT_SAMPLER_BUFFER, UniformKind::sampler, 1, GL_TEXTURE_BUFFER},
};

constexpr UniformType type_of(GLenum type) {
    for (const UniformType& each : uniform_types)
        if (each.type == type) return each;
    return {type, UniformKind::unknown};
}

} // namespace record
