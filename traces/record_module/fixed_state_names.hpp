// State of processing without shaders (OpenGL 2.1, chapters 2 and 3): what is read of it, by whom it is asked for.
#pragma once

#include "traces/record_module/state_names.hpp"

namespace record_stream {

inline constexpr std::size_t lights = 8, texture_units = 8;

/// glGetDoublev; matrices by columns. Clip planes are asked for by glGetClipPlane.
inline constexpr std::array fixed_names{
    StateName{GL_MODELVIEW_MATRIX, 16},
    StateName{GL_PROJECTION_MATRIX, 16},
    StateName{GL_NORMALIZE, 1},
    StateName{GL_RESCALE_NORMAL, 1},
    StateName{GL_LIGHTING, 1},
    StateName{GL_LIGHT_MODEL_AMBIENT, 4},
    StateName{GL_LIGHT_MODEL_LOCAL_VIEWER, 1},
    StateName{GL_LIGHT_MODEL_TWO_SIDE, 1},
    StateName{GL_LIGHT_MODEL_COLOR_CONTROL, 1},
    StateName{GL_COLOR_MATERIAL, 1},
    StateName{GL_COLOR_MATERIAL_FACE, 1},
    StateName{GL_COLOR_MATERIAL_PARAMETER, 1},
    StateName{GL_COLOR_SUM, 1},
    StateName{GL_CLAMP_VERTEX_COLOR, 1},
    StateName{GL_CLAMP_FRAGMENT_COLOR, 1},
    StateName{GL_FOG, 1},
    StateName{GL_FOG_MODE, 1},
    StateName{GL_FOG_COORD_SRC, 1},
    StateName{GL_FOG_COLOR, 4},
    StateName{GL_FOG_DENSITY, 1},
    StateName{GL_FOG_START, 1},
    StateName{GL_FOG_END, 1},
    StateName{GL_POINT_SIZE_MIN, 1},
    StateName{GL_POINT_SIZE_MAX, 1},
    StateName{GL_POINT_FADE_THRESHOLD_SIZE, 1},
    StateName{GL_POINT_DISTANCE_ATTENUATION, 3},
};

/// Stand in for names of glGetClipPlane's planes, one behind the other, behind fixed_names.
inline constexpr std::size_t clip_planes = 8, clip_plane_values = 4;

/// glGetLightfv, behind glIsEnabled.
inline constexpr std::array light_names{
    StateName{GL_AMBIENT, 4},
    StateName{GL_DIFFUSE, 4},
    StateName{GL_SPECULAR, 4},
    StateName{GL_POSITION, 4},
    StateName{GL_SPOT_DIRECTION, 3},
    StateName{GL_SPOT_EXPONENT, 1},
    StateName{GL_SPOT_CUTOFF, 1},
    StateName{GL_CONSTANT_ATTENUATION, 1},
    StateName{GL_LINEAR_ATTENUATION, 1},
    StateName{GL_QUADRATIC_ATTENUATION, 1},
};

/// glGetMaterialfv, of front and back.
inline constexpr std::array material_names{
    StateName{GL_AMBIENT, 4},  StateName{GL_DIFFUSE, 4},   StateName{GL_SPECULAR, 4},
    StateName{GL_EMISSION, 4}, StateName{GL_SHININESS, 1},
};

/// glGetTexEnvfv of GL_TEXTURE_ENV.
inline constexpr std::array environment_names{
    StateName{GL_TEXTURE_ENV_MODE, 1}, StateName{GL_TEXTURE_ENV_COLOR, 4}, StateName{GL_COMBINE_RGB, 1},
    StateName{GL_COMBINE_ALPHA, 1},    StateName{GL_SRC0_RGB, 1},          StateName{GL_SRC1_RGB, 1},
    StateName{GL_SRC2_RGB, 1},         StateName{GL_SRC0_ALPHA, 1},        StateName{GL_SRC1_ALPHA, 1},
    StateName{GL_SRC2_ALPHA, 1},       StateName{GL_OPERAND0_RGB, 1},      StateName{GL_OPERAND1_RGB, 1},
    StateName{GL_OPERAND2_RGB, 1},     StateName{GL_OPERAND0_ALPHA, 1},    StateName{GL_OPERAND1_ALPHA, 1},
    StateName{GL_OPERAND2_ALPHA, 1},   StateName{GL_RGB_SCALE, 1},         StateName{GL_ALPHA_SCALE, 1},
};

/// Behind them of a unit: its target (0: none) and whether sprites replace its coordinates, then by coordinate
/// s, t, r, q: the mode (0: none), the object plane, the eye plane; then the texture matrix.
inline constexpr std::size_t unit_target = values_of(environment_names), unit_sprites = unit_target + 1,
                             unit_generation = unit_sprites + 1, generation_values = 1 + 4 + 4,
                             unit_matrix = unit_generation + 4 * generation_values, unit_values = unit_matrix + 16;

} // namespace record_stream
