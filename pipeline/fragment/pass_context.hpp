// What every unit may read about the pass that is running. It changes only between runs of the event core.
#pragma once

#include "pipeline/draw_states.hpp"
#include "pipeline/fragment_stream.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/functional/surface_texel.hpp"
#include "pipeline/output/kbuffer_design.hpp"
#include "pipeline/output/surface_layout.hpp"
#include "pipeline/screen_pass.hpp"

#include <optional>
#include <vector>

namespace pipeline {

/// How the fragments of a pass end.
enum class FragmentEnd : std::uint8_t {
    depth_colour,  ///< fixed function: depth test, colour write
    kbuffer_store, ///< the shader computed all entries; the ROP stores them
    kbuffer_blend, ///< a unit of the ROP modifies the pixel
    kbuffer_list,  ///< the ROP adds the fragment to the list of its pixel
};

/// A layer that an earlier peeling pass captured, per pixel in row order.
struct PeeledLayer {
    std::vector<DepthCode> depth;     ///< farthest where the layer is empty
    std::vector<std::uint32_t> order; ///< quad that wrote it, ~0 where the layer is empty
};

/// Where the pixels of a surface lie in GPU memory: tiles of 4x4 pixels in row order, 2x2 blocks within. A pixel of
/// more than 16 bytes has several render targets; a block holds the four pixels of one after the other.
struct SurfaceBytes {
    std::uint64_t address = 0;
    std::uint32_t pixel_bytes = 0;
};

struct PassContext {
    const FragmentStream* stream = nullptr;
    FragmentStream* late = nullptr; ///< the same where the pipes fill in what the shader makes, see shades_late()
    const ModifyProgram* program = nullptr;
    const Pass* pass = nullptr;
    const SurfaceStore* surfaces = nullptr; ///< of the frame, for shaders and early tests that read them
    SurfaceLayout layout;
    FragmentEnd end = FragmentEnd::depth_colour;
    DrawStates states; ///< of the fixed-function units behind the shader
    /// Formats of the colour targets, nothing for those that are not written.
    std::vector<std::optional<SurfaceFormat>> targets;
    std::vector<SurfaceBytes> colours;   ///< of the targets that are written
    SurfaceBytes depth{0, 4};            ///< that the pass tests and writes
    std::uint64_t kbuffer_address = 0;   ///< of the k-buffer, or of the heads of lists
    std::uint64_t behind_address = 0;    ///< of the copy of `behind` that shaders read, with pixels as in `depth`
    const PeeledLayer* behind = nullptr; ///< reject what is not behind this layer
    const PeeledLayer* before = nullptr; ///< and what is not before this one
    std::optional<DepthInterval> range;  ///< and what lies outside of it
    bool farthest = false;               ///< capture the farthest fragment, too
    std::uint32_t first_kept = 0;        ///< lists: fragments of a pixel that earlier passes have dealt with
    PassesSite peel;
    SurfaceId read_only_depth = no_surface;          ///< finished, for the early depth test
    DrawStates read_only_states;                     ///< whose depth compares that test makes
    SurfaceFormat depth_format = SurfaceFormat::d24; ///< of the surface that the pass tests and writes
    std::vector<ShaderCost> shader_costs;            ///< by draw
    const ScreenPass* screen = nullptr;              ///< a full-screen pass, whose shader counts for every quad
    std::uint32_t atomic_latency = 0;                ///< cycles that each shader waits for an atomic before it is done
    bool textures = false;
    /// A task is a group of sample quads: shaded once, taken apart in the ROP. Else each sample quad is a task.
    bool multisampled = false;

    bool writes_colour() const { return !colours.empty(); }
    std::uint32_t colour_bytes() const { ///< per pixel of all colour targets
        std::uint32_t bytes = 0;
        for (const SurfaceBytes& colour : colours) bytes += colour.pixel_bytes;
        return bytes;
    }
    /// Its shader is run for every quad, for what it executes and fetches.
    bool runs_shader() const { return pass != nullptr && pass->shader != nullptr; }
    /// Sample quads of the task that begins with this one.
    std::uint32_t sample_quads(QuadId first) const { return multisampled ? stream->quads[first].more + 1U : 1U; }
    /// Index of a pixel's place in surfaces that lie in row order.
    std::size_t place(const Quad& quad, std::uint32_t pixel) const {
        return (quad.y + std::size_t{pixel / 2}) * layout.width + quad.x + pixel % 2;
    }
    std::uint32_t draw_of(QuadId quad) const { return stream->draw_of(quad); }
    /// Number of the draw call that a triangle belongs to; grows along the pass. Parts of a draw are calls of their
    /// own.
    std::uint32_t call_of(std::uint32_t triangle) const {
        const Triangle& of = stream->triangles[triangle];
        const bool parts = !stream->draws.empty() && stream->draws.front().is_part();
        return parts ? stream->range_of(of.primitive) : of.draw;
    }
};

} // namespace pipeline
