// State of OpenGL that a draw depends on, whatever its shaders: read by one query, looked up by name.
#pragma once

#include <GL/gl.h>

#include <GL/glext.h>

#include <array>
#include <cstddef>

namespace record_stream {

struct StateName {
    GLenum name;
    std::size_t values;
    bool compatibility = false; ///< of contexts with a compatibility profile alone
};

inline constexpr std::array state_names{
    StateName{GL_DEPTH_TEST, 1},
    StateName{GL_DEPTH_WRITEMASK, 1},
    StateName{GL_DEPTH_FUNC, 1},
    StateName{GL_DEPTH_CLAMP, 1},
    StateName{GL_DEPTH_RANGE, 2},
    StateName{GL_DEPTH_CLEAR_VALUE, 1},
    StateName{GL_POLYGON_OFFSET_FILL, 1},
    StateName{GL_POLYGON_OFFSET_LINE, 1},
    StateName{GL_POLYGON_OFFSET_POINT, 1},
    StateName{GL_POLYGON_OFFSET_FACTOR, 1},
    StateName{GL_POLYGON_OFFSET_UNITS, 1},
    StateName{GL_STENCIL_TEST, 1},
    StateName{GL_STENCIL_FUNC, 1},
    StateName{GL_STENCIL_REF, 1},
    StateName{GL_STENCIL_VALUE_MASK, 1},
    StateName{GL_STENCIL_WRITEMASK, 1},
    StateName{GL_STENCIL_FAIL, 1},
    StateName{GL_STENCIL_PASS_DEPTH_FAIL, 1},
    StateName{GL_STENCIL_PASS_DEPTH_PASS, 1},
    StateName{GL_STENCIL_BACK_FUNC, 1},
    StateName{GL_STENCIL_BACK_REF, 1},
    StateName{GL_STENCIL_BACK_VALUE_MASK, 1},
    StateName{GL_STENCIL_BACK_WRITEMASK, 1},
    StateName{GL_STENCIL_BACK_FAIL, 1},
    StateName{GL_STENCIL_BACK_PASS_DEPTH_FAIL, 1},
    StateName{GL_STENCIL_BACK_PASS_DEPTH_PASS, 1},
    StateName{GL_STENCIL_CLEAR_VALUE, 1},
    StateName{GL_BLEND_COLOR, 4},
    StateName{GL_COLOR_CLEAR_VALUE, 4},
    StateName{GL_VIEWPORT, 4},
    StateName{GL_SCISSOR_TEST, 1},
    StateName{GL_SCISSOR_BOX, 4},
    StateName{GL_CULL_FACE, 1},
    StateName{GL_CULL_FACE_MODE, 1},
    StateName{GL_FRONT_FACE, 1},
    StateName{GL_PROVOKING_VERTEX, 1},
    StateName{GL_PROGRAM_POINT_SIZE, 1},
    StateName{GL_POINT_SIZE, 1},
    StateName{GL_POINT_SPRITE_COORD_ORIGIN, 1},
    StateName{GL_LINE_WIDTH, 1},
    StateName{GL_LINE_SMOOTH, 1},
    StateName{GL_POLYGON_SMOOTH, 1},
    StateName{GL_POLYGON_MODE, 2},
    StateName{GL_COLOR_LOGIC_OP, 1},
    StateName{GL_RASTERIZER_DISCARD, 1},
    StateName{GL_SAMPLE_ALPHA_TO_COVERAGE, 1},
    StateName{GL_SAMPLE_COVERAGE, 1},
    StateName{GL_SAMPLE_MASK, 1},
    StateName{GL_FRAMEBUFFER_SRGB, 1},
    StateName{GL_TEXTURE_CUBE_MAP_SEAMLESS, 1},
    StateName{GL_CLIP_ORIGIN, 1},
    StateName{GL_CLIP_DEPTH_MODE, 1},
    StateName{GL_CLIP_DISTANCE0, 1},
    StateName{GL_CLIP_DISTANCE1, 1},
    StateName{GL_CLIP_DISTANCE2, 1},
    StateName{GL_CLIP_DISTANCE3, 1},
    StateName{GL_CLIP_DISTANCE4, 1},
    StateName{GL_CLIP_DISTANCE5, 1},
    StateName{GL_CLIP_DISTANCE6, 1},
    StateName{GL_CLIP_DISTANCE7, 1},
    StateName{GL_ALPHA_TEST, 1, true},
    StateName{GL_ALPHA_TEST_FUNC, 1, true},
    StateName{GL_ALPHA_TEST_REF, 1, true},
    StateName{GL_POINT_SPRITE, 1, true},
    StateName{GL_POINT_SMOOTH, 1, true},
    StateName{GL_LINE_STIPPLE, 1, true},
    StateName{GL_POLYGON_STIPPLE, 1, true},
    StateName{GL_SHADE_MODEL, 1, true},
    StateName{GL_VERTEX_PROGRAM_ARB, 1, true},
    StateName{GL_FRAGMENT_PROGRAM_ARB, 1, true},
    StateName{GL_RENDER_MODE, 1, true},
};

constexpr std::size_t values_of(const auto& names) {
    std::size_t sum = 0;
    for (const StateName& each : names) sum += each.values;
    return sum;
}

/// Where the values of a name begin; values_of(names) where it is none of them.
constexpr std::size_t place_of(const auto& names, GLenum name) {
    std::size_t place = 0;
    for (const StateName& each : names) {
        if (each.name == name) return place;
        place += each.values;
    }
    return place;
}

} // namespace record_stream
