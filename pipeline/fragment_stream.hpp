// The scene after everything that does not depend on order: triangles rasterized into quads, shaded once.
//
// It is computed by functional/ (pure, parallel, the same for any thread count) and replayed by every design. Passes
// that draw the same share what does not depend on their shaders. Quads lie in submission order: by draw, instance,
// primitive, clipped part, 8x8 tile (row by row within the triangle's bounding tiles), 2x2 quad (row by row within the
// tile), sample.
//
// With several samples to a pixel, each quad of pixels is a *group*: a sample quad for every sample that the triangle
// covers in any of its pixels, one behind the other. A group is shaded once: its sample quads have equal colours.
#pragma once

#include "pipeline/output/kbuffer.hpp"
#include "pipeline/sample_planes.hpp"
#include "pipeline/shared_vector.hpp"

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

namespace pipeline {

/// Number of a quad in its stream; the raster index of the specification.
using QuadId = std::uint32_t;

/// A 2x2 block of pixels, or of one sample of each, touched by one triangle. Pixel i of the quad is the place
/// (x + i % 2, y + i / 2), see sample_planes.hpp; row 0 is the top row.
struct Quad {
    std::uint16_t x = 0;        ///< even
    std::uint16_t y = 0;        ///< even; beyond the picture's height for samples but the first
    std::uint32_t triangle = 0; ///< index into FragmentStream::triangles
    std::uint8_t covered = 0;   ///< bit i: the triangle covers the centre of pixel i, or this sample of it
    std::uint8_t alive = 0;     ///< covered and not discarded by the shader (alpha test)
    std::uint8_t sample = 0;
    std::uint8_t more = 0; ///< sample quads of its group that follow
};
static_assert(sizeof(Quad) == 12);

/// A triangle that reached the rasterizer: not culled, clipped parts counted one by one.
struct Triangle {
    std::uint32_t draw = 0;      ///< index into the draw list the stream was made from
    std::uint32_t primitive = 0; ///< index into FragmentStream::primitives
    QuadId first_quad = 0;
    std::uint32_t quads = 0; ///< of all samples; may be 0: covers no pixel centre, or no sample
    std::uint32_t tiles = 0; ///< 8x8 tiles the rasterizer visits, at least 1
    bool front = true;       ///< its corners run counter-clockwise on the screen; see RasterState::front_is_clockwise
};

/// What became of an input primitive.
enum class PrimitiveFate : std::uint8_t { drawn, culled_facing, culled_outside, culled_degenerate };

/// One input primitive (of one instance of one draw), in submission order.
struct Primitive {
    std::uint32_t first_triangle = 0;
    std::uint8_t triangles = 0; ///< rasterized parts: 0 when culled, several when clipped
    PrimitiveFate fate = PrimitiveFate::drawn;
    bool clipped = false;
};

/// The primitives of one instance of one draw, or of a part of it that has a draw call of its own (frame.hpp).
struct DrawRange {
    static constexpr std::uint32_t own_geometry = ~std::uint32_t{0};

    std::uint32_t draw = 0;
    std::uint32_t instance = 0;
    std::uint32_t first_primitive = 0;
    std::uint32_t primitives = 0;
    QuadId first_quad = 0;
    std::uint32_t quads = 0;
    std::uint32_t geometry = own_geometry; ///< of a part: the one that its triangles are listed in,
    std::uint32_t first_triangle = 0;      ///< ... from this one on
    /// That its vertex program takes for a vertex, in the mean, rounded; 0: it has none, or one that does not count.
    std::uint32_t vertex_instructions = 0;

    bool is_part() const { return geometry != own_geometry; }
};

/// Quads in a row that are given as many varyings each, up to the next run.
struct VaryingRun {
    QuadId first_quad = 0;
    std::uint32_t each = 0;  ///< with the one that ShaderInput::varyings begins with; 0: draws without a program
    std::uint64_t first = 0; ///< of the first quad, in FragmentStream::given_varyings
};

struct FragmentStream {
    std::uint32_t width = 0, height = 0; ///< pixels
    std::uint32_t samples = 1;           ///< of a pixel

    SharedVector<DrawRange> draws;
    SharedVector<Primitive> primitives;
    SharedVector<Triangle> triangles;
    SharedVector<Quad> quads;

    // Parallel to `quads`; colours and texture lines are empty when nothing needs them.
    SharedVector<std::array<float, 4>> depths;     ///< window depth in [0,1] at each pixel centre, or sample
    std::vector<std::array<glm::vec4, 4>> colours; ///< shaded linear RGBA, not premultiplied: the first output
    std::vector<std::vector<std::array<glm::vec4, 4>>> more_outputs; ///< of a shader with several: from the second on
    /// What the shader of the pass is given, where it has one of its own; see ShaderInput.
    SharedVector<std::array<glm::vec4, 4>> given_colours, given_normals, given_texcoords;
    SharedVector<glm::vec4> given_tangents;
    SharedVector<std::array<glm::vec4, 4>> given_varyings; ///< of one quad after the other
    SharedVector<VaryingRun> varying_runs;                 ///< of all quads, where there are any varyings
    SharedVector<std::uint32_t> texture_lines;             ///< 64-byte line of the quad's texture fetch, ~0 = no fetch

    std::uint64_t groups = 0;              ///< quads of pixels; as many as `quads` with one sample
    std::uint64_t fragments = 0;           ///< covered pixels over all quads, or samples
    std::uint64_t fragments_discarded = 0; ///< covered but not alive

    /// Rows of the planes of all samples.
    std::uint32_t rows() const { return samples * plane_rows(height, samples); }
    std::uint32_t draw_of(QuadId quad) const { return triangles[quads[quad].triangle].draw; }
    /// The range that a primitive lies in: an index into `draws`.
    std::uint32_t range_of(std::uint32_t primitive) const;
    /// What the shader is given of a quad with ShaderInput::varyings.
    std::span<const std::array<glm::vec4, 4>> varyings_of(QuadId quad) const;
    /// What a modify program may read of pixel `lane` (0 to 3) of a quad.
    Fragment fragment(QuadId quad, std::size_t lane) const {
        return {colours.empty() ? nullptr : &colours[quad][lane].x, depths[quad][lane], draw_of(quad)};
    }

    /// Output `number` of the shader at pixel `lane` of a quad.
    const glm::vec4& output(std::size_t number, QuadId quad, std::size_t lane) const {
        return (number == 0 ? colours : more_outputs[number - 1])[quad][lane];
    }

    std::uint64_t bytes() const; ///< memory held by the vectors
};

} // namespace pipeline
