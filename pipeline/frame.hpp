// One frame in the form the machine executes: the passes that are left after culling, in order, with their state.
//
// traces/pass_graph turns a workload into a Frame; functional/front_end turns its draw passes into fragment streams;
// machine replays them on a GPU with a k-buffer design; reference executes them in submission order without time.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/kernel.hpp"
#include "pipeline/output/kbuffer.hpp"
#include "pipeline/raster_state.hpp"
#include "pipeline/shader.hpp"
#include "pipeline/surface.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pipeline {

/// How the vertices of a frame come to the GPU.
enum class Submission : std::uint8_t {
    buffers,       ///< they lie in buffers of the GPU
    client_arrays, ///< arrays of the application, handed over with every draw
    immediate,     ///< vertex by vertex
    display_list   ///< recorded before, in a form of the driver's own
};

enum class PassKind : std::uint8_t {
    clear,   ///< sets `clears` to their cleared values
    draw,    ///< rasterizes `draws`
    screen,  ///< runs `shader` on every pixel of its targets
    compose, ///< the same, or `kernel`, without taking time: a picture of what the frame has left
};

/// Triangles of one instance of a draw that are handed over with a draw call of their own: a run of the list that
/// another geometry keeps of them.
struct DrawPart {
    std::uint32_t draw = 0; ///< whose material, vertices and counters they have; index into Frame::draws
    std::uint32_t instance = 0;
    std::uint32_t geometry = 0; ///< triangles, not strips or fans
    std::uint32_t first_triangle = 0;
    std::uint32_t triangles = 0;
};

struct Pass {
    std::string name;
    PassKind kind = PassKind::draw;
    std::uint32_t view = 0;           ///< 0: Frame::view; i: Frame::other_views[i - 1]
    std::vector<SurfaceId> clears;    ///< clear passes only
    std::vector<std::uint32_t> draws; ///< indices into Frame::draws; draw passes only
    std::vector<DrawPart> parts;      ///< of those draws, in this order; empty: each draw whole
    std::vector<RasterState> states = std::vector<RasterState>(1); ///< that its draws have
    std::vector<std::uint32_t> state_of_draw; ///< index into `states`, one for each of `draws`; empty: all the first
    /// Colour surfaces, one for each output of the shader, blended where a state says; no_surface: nobody reads it.
    std::vector<SurfaceId> targets;
    std::shared_ptr<const Shader> shader; ///< null: the colour of the material is the only output
    std::shared_ptr<const Kernel> kernel; ///< in place of the shader; compose passes only
    std::vector<SurfaceId> reads;         ///< what the shader or kernel knows by its place in this list
    SurfaceId depth = no_surface;         ///< tested and written as the states say, with its stencil
    SurfaceId kbuffer = no_surface;       ///< fragments go through its modify program
    bool both_faces = false;              ///< draws triangles that face away, too
    bool cold = false;                    ///< texture and vertex caches are empty when it begins
    /// Attributes that the vertex shader reads beside what shading needs: bits as in mask_of(Semantic).
    std::uint32_t attributes = 0;

    bool tests_depth() const {
        return any_state([](const RasterState& state) { return state.depth.test; });
    }
    bool writes_depth() const {
        return any_state([](const RasterState& state) { return state.depth.write; });
    }
    bool tests_stencil() const {
        return any_state([](const RasterState& state) { return state.stencil.test; });
    }
    bool uses_depth() const { return tests_depth() || writes_depth() || tests_stencil(); }
    bool writes_colour() const { return first_target() != no_surface; }
    SurfaceId first_target() const {
        const auto target = std::find_if(targets.begin(), targets.end(), [](SurfaceId id) { return id != no_surface; });
        return target == targets.end() ? no_surface : *target;
    }
    /// Sends fragments.
    bool rasterizes() const { return kind == PassKind::draw || kind == PassKind::screen; }
    bool writes_targets() const { return rasterizes() || kind == PassKind::compose; }
    /// Its shader has to wait for what earlier passes finish.
    bool reads_surfaces() const { return !reads.empty(); }
    bool runs_program() const { return kbuffer != no_surface; }

  private:
    template <class Predicate>
    bool any_state(Predicate predicate) const {
        return std::any_of(states.begin(), states.end(), predicate);
    }
};

/// What the passes of a frame use. Units, attributes and surfaces that nothing here asks for are not built, fetched or
/// allocated; see machine.hpp.
struct Needs {
    bool index_buffer = false;
    bool normals = false;
    bool vertex_colours = false;
    bool texcoords = false;
    bool textures = false;
    bool alpha_test = false;
    bool colours = false;          ///< fragments carry a colour
    bool fragment_normals = false; ///< fragments carry a normal
    bool map_texcoords = false;    ///< ... and the coordinates of their material's maps, where it has some
    FragmentColour fragment_colour = FragmentColour::lit;
    bool depth = false; ///< depth surface and its tile cache
    bool early_depth = false;
    bool colour_surface = false;
    bool kbuffer = false;
    std::uint32_t attributes = 0; ///< union of Pass::attributes
};

/// Something the frame, or this GPU, could have had and does not, and why.
struct LeftOut {
    std::string unit;
    std::string reason;
};

struct Frame {
    std::string workload;
    std::shared_ptr<const Resources> resources;
    std::vector<Draw> draws;
    View view;                         ///< of the eye
    std::vector<View> other_views;     ///< of passes that see the scene from elsewhere
    std::vector<SurfaceInfo> surfaces; ///< that passes write
    SurfaceId output = no_surface;     ///< a colour surface that the frame is for; no_surface: the first of the passes
    bool output_is_encoded = false;    ///< its numbers are sRGB codes over 255, as screens take them, and not linear
    /// Index into `draws` of the triangle that covers the screen in screen passes.
    std::optional<std::uint32_t> screen_draw;
    Submission submission = Submission::buffers;
    std::vector<Pass> passes;
    Needs needs;
    std::vector<std::string> notes;               ///< what was not done as asked for, one line each
    std::vector<LeftOut> left_out;                ///< by the pass graph: culled passes, unread attributes
    std::shared_ptr<const ModifyProgram> program; ///< null when no pass has a k-buffer
    SurfaceFormat depth_format = SurfaceFormat::d24;
    SurfaceFormat colour_format = SurfaceFormat::rgba8;
    glm::vec4 background{1.0F};

    const View& view_of(const Pass& pass) const { return pass.view == 0 ? view : other_views.at(pass.view - 1); }
    /// Of the first pass that fills the k-buffer, as large as those of the others; that of the eye where there is none.
    const View& view_of_kbuffer() const {
        const auto pass = std::find_if(passes.begin(), passes.end(), [](const Pass& of) { return of.runs_program(); });
        return pass == passes.end() ? view : view_of(*pass);
    }
    /// The k-buffer does not show what the picture shows.
    bool kbuffer_seen_from_elsewhere() const { return &view_of_kbuffer() != &view; }
    /// The surface that passes test depth against, write colours to or run the program on; no_surface: none. Depth and
    /// colours are those of the eye's picture.
    SurfaceId main_depth() const {
        return first([this](const Pass& pass) { return of_eye(pass.depth); });
    }
    SurfaceId main_colour() const {
        if (output != no_surface) return output;
        return first([this](const Pass& pass) { return of_eye(pass.first_target()); });
    }
    SurfaceId main_kbuffer() const {
        return first([](const Pass& pass) { return pass.kbuffer; });
    }
    /// `needs` without what this pass does not read.
    Needs needs_of(const Pass& pass) const;
    /// Throws the sim::InputError that names a surface which cannot be written and the pass that would.
    void check_targets() const;

  private:
    SurfaceId of_eye(SurfaceId surface) const {
        if (surface == no_surface) return no_surface;
        const SurfaceInfo& info = surfaces[surface];
        return info.width == view.width && info.height == view.height ? surface : no_surface;
    }
    template <class Of>
    SurfaceId first(Of of) const {
        for (const Pass& pass : passes)
            if (const SurfaceId surface = of(pass); surface != no_surface) return surface;
        return no_surface;
    }
};

/// Declared cost of a fragment shader for one quad.
struct ShaderCost {
    std::uint32_t alu = 0;         ///< instructions, each issued once per quad, up to the read of its pixel's state
    std::uint32_t textures = 0;    ///< filtered texture reads
    std::uint32_t registers = 4;   ///< 128-bit registers per fragment; they limit the quads in flight
    std::uint32_t behind_read = 0; ///< instructions that depend on the state read
};

} // namespace pipeline
