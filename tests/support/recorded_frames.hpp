// Recordings that can be drawn, stated by the test: triangles in clip space with a colour at each corner.
#pragma once

#include "traces/recording/recording.hpp"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace tests {

struct RecordedFrames {
    traces::Recording recording;

    /// Target set 0: a surface "window" of rgba8, and one of d24s8, row 0 on top. One frame, which shows it.
    RecordedFrames(std::uint32_t width, std::uint32_t height);

    struct Corner {
        glm::vec4 position{0.0F, 0.0F, 0.0F, 1.0F};
        glm::vec4 colour{1.0F};
    };
    using Triangle = std::array<Corner, 3>;

    /// What the fragment shader of a draw makes of the interpolated colour.
    enum class Shade : std::uint8_t {
        colour,   ///< itself
        places,   ///< FragCoord / 256, with 1 - depth for blue and the share of w for alpha
        textured, ///< times the texel of "image" at its red and green
        facing    ///< white where it shows the front, else black
    };

    /// A surface to draw to and to sample, with its target set of row 0 at the bottom; returns the set's number.
    std::uint32_t add_texture_target(std::uint32_t width, std::uint32_t height);
    /// A texture of rgba8 texels in row order; returns the surface's number.
    std::uint32_t add_texture(std::uint32_t width, std::uint32_t height, const std::vector<std::uint32_t>& rgba_codes);
    std::uint32_t add_state(const pipeline::RasterState& state);
    /// Samples this surface, nearest texel.
    std::uint32_t bind(std::uint32_t surface);

    /// Appends a draw of these triangles to the last frame, which the test may change.
    traces::RecordedDraw& draw(const std::vector<Triangle>& triangles, Shade shade = Shade::colour,
                               std::uint32_t state = 0, std::uint32_t targets = 0);
    traces::RecordedClear& clear(const glm::vec4& colour, std::uint32_t targets = 0);
    void next_frame();

    /// All of clip space at one window depth, of one colour.
    static std::vector<Triangle> everything(const glm::vec4& colour, float depth = 0.5F);
    static std::vector<Triangle> rectangle(const glm::vec2& from, const glm::vec2& to, const glm::vec4& colour,
                                           float depth = 0.5F);
};

} // namespace tests
