// Frames as an application drew them: surfaces, and what was done to them one after the other, with all of its state.
//
// Whoever records (`traces/record_module`) fills this, a draw trace keeps it (FORMAT.md), lower() makes frames of it.
// No word of a graphics API: names are those of the pipeline and of the shaders.
//
// Conventions: clip space has -w <= z <= w; a surface's row 0 comes first in its bytes. Rectangles count rows from row
// 0. Whether row 0 is the top (y of clip space = 1) or the bottom of what is drawn is a matter of the targets. Texture
// coordinate v = 0 is at row 0. FragCoord.y of shaders counts upwards in clip space, so from the last row where row 0
// is the top. Fronts and winding are those of clip space with y up. A vertex program's clip distances take the place of
// RasterState::clip_plane; its mask says which of them cut.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/raster_state.hpp"
#include "pipeline/shared_bytes.hpp"
#include "pipeline/surface_format.hpp"
#include "pipeline/texture_lookup.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace traces {

enum class SurfaceKind : std::uint8_t {
    plane,  ///< width x height
    layers, ///< `depth` planes of it
    cube,   ///< 6 planes: +x, -x, +y, -y, +z, -z
    volume, ///< `depth` slices; levels halve it, too
    buffer  ///< one row of any length
};

/// What is sampled, drawn to, or both. One whose content the application replaced is another surface.
struct RecordedSurface {
    std::string name;
    SurfaceKind kind = SurfaceKind::plane;
    pipeline::SurfaceFormat format = pipeline::SurfaceFormat::rgba8;
    std::uint32_t width = 1, height = 1, depth = 1;
    std::uint32_t samples = 1;
    /// The bytes that it holds when the first frame begins, by level: planes, rows, texels, without gaps; of
    /// block-compressed formats 4x4 blocks in their place. A level without bytes holds 0.
    std::vector<pipeline::SharedBytes> levels = std::vector<pipeline::SharedBytes>(1);

    bool operator==(const RecordedSurface&) const = default;
};

struct LevelSize {
    std::uint32_t width = 1, height = 1;
    std::uint32_t planes = 1; ///< of a volume its slices
};
LevelSize level_size(const RecordedSurface& surface, std::uint32_t level);

/// Of a level that has any.
std::uint64_t level_bytes(const RecordedSurface& surface, std::uint32_t level);

using pipeline::Swizzle;
using RecordedSampler = pipeline::SamplerState;

/// A texture variable of a shader, with what it reads.
struct TextureBinding {
    std::string variable;      ///< its name in the shader
    std::uint32_t element = 0; ///< of an array
    std::uint32_t surface = 0, sampler = 0;
    std::array<Swizzle, 4> swizzle{Swizzle::red, Swizzle::green, Swizzle::blue, Swizzle::alpha};
    std::uint32_t base_level = 0, last_level = 1000;

    bool operator==(const TextureBinding&) const = default;
};

/// Where a shader's vertex input comes from; a matrix or an array takes several attributes.
struct ShaderInputSource {
    std::string variable;
    std::uint32_t first = 0; ///< pipeline::Semantic of its first column; the others follow

    bool operator==(const ShaderInputSource&) const = default;
};

/// A vertex and a fragment shader as SPIR-V, and how they are fed.
struct RecordedProgram {
    std::string name;
    std::vector<std::uint32_t> vertex, fragment; ///< modules; no fragment shader: depth and stencil alone are drawn
    std::vector<ShaderInputSource> inputs;

    bool operator==(const RecordedProgram&) const = default;
};

/// A uniform by the name that GLSL gives it ("lights[2].position"), in 32-bit words as a scalar, vector or matrix by
/// columns, arrays one element after the other; truths are 0 and 1. Of a block ("Block"): its bytes as they lie in
/// memory.
struct UniformValue {
    std::string name;
    std::vector<std::uint32_t> words;

    bool operator==(const UniformValue&) const = default;
};

/// Where pixels go.
struct TargetSet {
    struct Target {
        std::uint32_t surface = 0, level = 0, plane = 0;
        bool operator==(const Target&) const = default;
    };
    std::vector<std::optional<Target>> colours; ///< by output of the fragment shader
    std::optional<Target> depth;                ///< with its stencil
    std::uint32_t width = 0, height = 0;
    /// y of clip space grows towards row 0, as on screens; else away from it, as in textures that are drawn to.
    bool top_row_first = true;

    bool operator==(const TargetSet&) const = default;
};

/// A vertex input that no array feeds.
struct ConstantInput {
    std::string variable;
    glm::vec4 value{0.0F, 0.0F, 0.0F, 1.0F};

    bool operator==(const ConstantInput&) const = default;
};

struct RecordedDraw {
    std::string name;           ///< for people: what the application called, and where
    std::uint32_t targets = 0;  ///< of Recording::targets
    std::uint32_t geometry = 0; ///< of Recording::resources; attributes by semantic, see ShaderInputSource
    std::uint32_t instances = 1;
    /// What the shader is told; they were added to indices, and to the elements of attributes with a divisor, already.
    std::uint32_t first_instance = 0;
    std::int32_t base_vertex = 0;
    std::uint32_t program = 0;
    std::uint32_t vertex_values = 0, fragment_values = 0; ///< of Recording::values
    std::uint32_t bindings = 0;                           ///< of Recording::bindings
    std::uint32_t state = 0;                              ///< of Recording::states
    std::vector<ConstantInput> constants;
    pipeline::Compare alpha_test = pipeline::Compare::always; ///< of output 0's alpha; what fails is discarded
    float alpha_reference = 0.0F;

    bool operator==(const RecordedDraw&) const = default;
};

/// Sets pixels of targets, all of which are there, without a draw.
struct RecordedClear {
    std::string name;
    std::uint32_t targets = 0;
    std::uint8_t colours = 0; ///< bit i: target i
    glm::vec4 colour{0.0F};
    std::array<std::uint8_t, pipeline::most_targets_of_pass> write_mask{15, 15, 15, 15, 15, 15, 15, 15};
    std::optional<float> depth;
    std::optional<std::uint8_t> stencil;
    std::uint8_t stencil_mask = 0xFF;
    std::optional<pipeline::PixelRectangle> scissor;

    bool operator==(const RecordedClear&) const = default;
};

/// Copies a rectangle of texels; formats convert as a draw would.
struct RecordedCopy {
    std::string name;
    TargetSet::Target from, to;
    pipeline::PixelRectangle rectangle; ///< of the source
    std::int32_t to_x = 0, to_y = 0;
    bool mirrored = false; ///< the first row of the source becomes the last one

    bool operator==(const RecordedCopy&) const = default;
};

/// A copy that scales: rectangles have any sizes, up to limits::largest_blit. What would come from beyond the source's
/// surface, or go beyond the destination's, is left out.
struct RecordedBlit {
    std::string name;
    TargetSet::Target from, to;
    pipeline::PixelRectangle source, destination;
    bool mirrored_x = false, mirrored_y = false;       ///< the first column, or row, of the source becomes the last one
    bool linear = false;                               ///< filtered within the level of colours; else the nearest texel
    std::optional<pipeline::PixelRectangle> scissor{}; ///< of the destination

    bool operator==(const RecordedBlit&) const = default;
};

using RecordedCommand = std::variant<RecordedDraw, RecordedClear, RecordedCopy, RecordedBlit>;

struct RecordedFrame {
    std::uint32_t number = 0; ///< of the application's frames, from 0; they grow
    std::uint32_t shown = 0;  ///< of Recording::targets: whose first colour the frame is for
    std::vector<RecordedCommand> commands;

    bool operator==(const RecordedFrame&) const = default;
};

/// What was called and is not in the recording, or only in part.
struct NotRecorded {
    std::string call;
    std::uint64_t times = 0;

    bool operator==(const NotRecorded&) const = default;
};

struct Recording {
    std::shared_ptr<pipeline::Resources> resources; ///< buffers and geometries alone
    std::vector<RecordedSurface> surfaces;
    std::vector<RecordedSampler> samplers;
    std::vector<RecordedProgram> programs;
    std::vector<std::vector<UniformValue>> values;
    std::vector<std::vector<TextureBinding>> bindings;
    std::vector<pipeline::RasterState> states;
    std::vector<TargetSet> targets;
    std::vector<RecordedFrame> frames;
    std::vector<NotRecorded> not_recorded;
};

} // namespace traces
