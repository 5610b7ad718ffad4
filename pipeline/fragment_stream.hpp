// The scene after everything that does not depend on order: triangles rasterized into quads, shaded once.
//
// It is computed by functional/ (pure, parallel, the same for any thread count) and replayed by every design. Quads lie
// in submission order: by draw, instance, primitive, clipped part, 8x8 tile (row by row within the triangle's bounding
// tiles), 2x2 quad (row by row within the tile).
#pragma once

#include "pipeline/output/kbuffer.hpp"

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

namespace pipeline {

/// Number of a quad in its stream; the raster index of the specification.
using QuadId = std::uint32_t;

/// A 2x2 block of pixels touched by one triangle. Pixel i of the quad is (x + i % 2, y + i / 2), row 0 is the top row.
struct Quad {
    std::uint16_t x = 0;        ///< even
    std::uint16_t y = 0;        ///< even
    std::uint32_t triangle = 0; ///< index into FragmentStream::triangles
    std::uint8_t covered = 0;   ///< bit i: the triangle covers the centre of pixel i
    std::uint8_t alive = 0;     ///< covered and not discarded by the shader (alpha test)
    std::uint16_t reserved = 0;
};
static_assert(sizeof(Quad) == 12);

/// A triangle that reached the rasterizer: not culled, clipped parts counted one by one.
struct Triangle {
    std::uint32_t draw = 0;      ///< index into the draw list the stream was made from
    std::uint32_t primitive = 0; ///< index into FragmentStream::primitives
    QuadId first_quad = 0;
    std::uint32_t quads = 0; ///< may be 0: covers no pixel centre
    std::uint32_t tiles = 0; ///< 8x8 tiles the rasterizer visits, at least 1
};

/// What became of an input primitive.
enum class PrimitiveFate : std::uint8_t { drawn, culled_facing, culled_outside, culled_degenerate };

/// One input primitive (of one instance of one draw), in submission order.
struct Primitive {
    std::uint32_t first_triangle = 0;
    std::uint8_t triangles = 0; ///< rasterized parts: 0 when culled, up to 7 when clipped
    PrimitiveFate fate = PrimitiveFate::drawn;
    bool clipped = false;
};

/// The primitives of one instance of one draw.
struct DrawRange {
    std::uint32_t draw = 0;
    std::uint32_t instance = 0;
    std::uint32_t first_primitive = 0;
    std::uint32_t primitives = 0;
    QuadId first_quad = 0;
    std::uint32_t quads = 0;
};

struct FragmentStream {
    std::uint32_t width = 0, height = 0;

    std::vector<DrawRange> draws;
    std::vector<Primitive> primitives;
    std::vector<Triangle> triangles;
    std::vector<Quad> quads;

    // Parallel to `quads`; colours and texture lines are empty when nothing needs them.
    std::vector<std::array<float, 4>> depths;      ///< window depth in [0,1] at each pixel centre
    std::vector<std::array<glm::vec4, 4>> colours; ///< shaded linear RGBA, not premultiplied
    std::vector<std::uint32_t> texture_lines;      ///< 64-byte line of the quad's texture fetch, ~0 = no fetch

    std::uint64_t fragments = 0;           ///< covered pixels over all quads
    std::uint64_t fragments_discarded = 0; ///< covered but not alive

    std::uint32_t draw_of(QuadId quad) const { return triangles[quads[quad].triangle].draw; }
    /// What a modify program may read of pixel `lane` (0 to 3) of a quad.
    Fragment fragment(QuadId quad, std::size_t lane) const {
        return {colours.empty() ? nullptr : &colours[quad][lane].x, depths[quad][lane], draw_of(quad)};
    }

    std::uint64_t bytes() const; ///< memory held by the vectors
};

} // namespace pipeline
