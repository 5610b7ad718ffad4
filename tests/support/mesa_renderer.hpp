// An independent OpenGL to compare pictures and counters with: Mesa's llvmpipe, headless, through EGL without a
// surface.
#pragma once

#include "pipeline/raster_state.hpp"
#include "pipeline/topology.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

namespace tests {

/// Primitives under one matrix and one state. Blending, masks, depth test and stencil are MesaMode's.
struct TriangleScene {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices; ///< three per triangle
    glm::mat4 matrix{1.0F};             ///< model space, which is eye space, to clip space, y up
    std::uint32_t width = 512, height = 512;
    pipeline::Topology topology = pipeline::Topology::triangles;
    pipeline::RasterState state{}; ///< culling by_material: none
};

/// What is done with the fragments.
enum class MesaMode {
    count,   ///< no depth test; colour.r counts the fragments of each pixel, id is the last one's
    nearest, ///< depth test LESS with writes; id is the visible triangle's
    blend,   ///< no depth test; source-over blending of the triangles' colours in order
    flat     ///< no depth test, no blending; colour.r is the index of the last fragment's provoking vertex
};

/// Row 0 is the top row.
struct MesaPicture {
    std::vector<glm::vec4> colour;
    std::vector<std::uint32_t> id; ///< 1 + number of the primitive, 0 where there is none
    std::vector<float> depth;      ///< window depth
    std::uint64_t samples_passed = 0;
    std::uint64_t fs_invocations = 0; ///< 16 for each 4x4 block that a triangle touches
    std::uint64_t clipping_input = 0;
    std::uint64_t clipping_output = 0;
};

/// Triangles of a scene that are drawn with one state: blending, write mask, depth and stencil of it count.
struct MesaDraw {
    std::uint32_t first_triangle = 0, triangles = 0;
    pipeline::RasterState state;
};

/// RGBA8 and D24S8 as they are stored; row 0 is the top row.
struct MesaCodes {
    std::vector<glm::u8vec4> colour;
    std::vector<std::uint32_t> depth;
    std::vector<std::uint8_t> stencil;
};

class MesaRenderer {
  public:
    /// Null when there is no such OpenGL here; then `reason` says what is missing.
    static std::unique_ptr<MesaRenderer> create(std::string& reason);
    virtual ~MesaRenderer() = default;

    virtual std::string description() const = 0;

    /// `colours`: one per triangle; used in mode blend. With `cull_back`, triangles that wind clockwise (y up) are
    /// culled.
    virtual MesaPicture render(const TriangleScene& scene, MesaMode mode, const std::vector<glm::vec4>& colours = {},
                               bool cull_back = false) = 0;

    /// Draws of the scene one after the other into RGBA8 and D24S8, cleared to `background`, 1 and 0.
    virtual MesaCodes render_states(const TriangleScene& scene, const std::vector<MesaDraw>& draws,
                                    const std::vector<glm::vec4>& colours, const glm::vec4& background) = 0;
};

} // namespace tests
