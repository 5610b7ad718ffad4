// The contract of a shader: what it makes of the four pixels of a quad, and what that costs.
//
// Values and cost come from the same code: shade() reads surfaces through SurfaceAccess and counts its instructions
// there. It is run ahead, for the values, and again by the pipe that executes the quad, for the work; it must be a pure
// function of its input and of the surfaces that it reads.
#pragma once

#include "pipeline/raster_state.hpp"
#include "pipeline/surface_access.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace pipeline {

/// The colour that a material gives a fragment.
enum class FragmentColour : std::uint8_t {
    lit,    ///< base colour x vertex colour x texture x light
    unlit,  ///< without the light
    flat,   ///< the base colour: nothing is interpolated, lit or discarded
    cosine, ///< red, green and blue are |cos| of the angle between the surface normal and the direction to the eye
};

/// What a pass has to provide for a shader.
struct ShaderShape {
    std::uint32_t outputs = 1;              ///< colours, one for each target of the pass
    std::uint32_t reads = 0;                ///< surfaces that earlier passes finished; see Pass::reads
    std::uint32_t registers = 4;            ///< 128-bit registers per fragment; they limit the quads in flight
    std::optional<FragmentColour> colour{}; ///< of the material, that it starts from; draw passes only
    bool normal = false;                    ///< it reads the surface's normal; draw passes only
    bool map_texcoords = false;             ///< ... and coordinates and tangent, for maps of materials
    bool sets_depth = false;
    bool discards = true; ///< it may clear pixels of ShaderOutput::alive
};

/// A quad. Pixel i is (x + i % 2, y + i / 2).
struct ShaderInput {
    std::uint32_t x = 0, y = 0; ///< both even
    unsigned pixels = 15;       ///< mask of those to be shaded
    std::uint32_t draw = 0;     ///< index into Frame::draws
    bool front = true;          ///< the triangle's corners run counter-clockwise on the screen
    Lanes depth{};              ///< window depth in [0,1]; 0 in screen passes
    QuadTexels colour{};        ///< linear RGBA as asked for by the shape, else 0
    QuadTexels normal{};        ///< eye space, of unit length or 0; w is 0
    /// {u, v} of texture coordinates 0, then of 1, as vertices have them; those of pixels outside of the mask are for
    /// derivatives. 0 where the shape does not ask for them and where the material has no maps.
    QuadTexels texcoords{};
    /// Where u of the material's normal map grows over the triangle: eye space, of unit length, with what the cross
    /// product of normal and tangent is to be multiplied by in w; 0 where there is no such direction.
    glm::vec4 tangent{0.0F};
    /// Of draws with a vertex program, else empty. The first is {w of clip space, place in the point from the left,
    /// from the top, 0}; the others are the program's.
    std::span<const QuadTexels> varyings{};
};

/// Where the pixels of a quad are, those outside of the mask, too.
struct QuadPlaces {
    LaneIndices x{}, y{};

    explicit QuadPlaces(const ShaderInput& input) {
        for (std::size_t i = 0; i < 4; ++i) {
            x[i] = static_cast<std::int32_t>(input.x + i % 2);
            y[i] = static_cast<std::int32_t>(input.y + i / 2);
        }
    }
};

struct ShaderOutput {
    std::array<QuadTexels, most_targets_of_pass> colours{};
    unsigned alive = 0; ///< the pixels that were not discarded
    Lanes depth{};      ///< in [0,1], of all samples; counts where the shape says so, and is the input's on entry
};

class Shader {
  public:
    virtual ~Shader() = default;
    virtual ShaderShape shape() const = 0;
    /// Makes the outputs of the input's pixels; what it clears in `output.alive`, which holds these pixels on entry, is
    /// discarded. Colours are 0 on entry. Surfaces are known by their place in Pass::reads.
    virtual void shade(const ShaderInput& input, SurfaceAccess& surfaces, ShaderOutput& output) const = 0;
};

} // namespace pipeline
