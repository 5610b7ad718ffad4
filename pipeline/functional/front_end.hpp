// The functional front end: everything up to the shaded fragment, as a pure function of draws and view.
//
// Modelled: vertex fetch and transform (each vertex once per instance), culling, clipping, viewport and scissor,
// rasterization, depth interpolation, bias and clamp, shading, alpha test. Not modelled here: time, and whatever
// depends on other fragments.
#pragma once

#include "pipeline/draw.hpp"
#include "pipeline/fragment_stream.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/raster_state.hpp"

#include <atomic>
#include <functional>
#include <span>
#include <vector>

namespace pipeline {

struct FrontEndOptions {
    bool colours = true;        ///< fill FragmentStream::colours
    bool normals = false;       ///< fill FragmentStream::given_normals
    bool map_texcoords = false; ///< fill FragmentStream::given_texcoords and given_tangents
    FragmentColour fragment_colour = FragmentColour::lit;
    bool textures = true;    ///< read textures; without, materials have their base colour only
    bool both_faces = false; ///< keep triangles that face away, whatever their material says
    bool alpha_test = true;  ///< discard fragments of masked materials
    /// State of the fixed-function units. `state_of_draw` is parallel to the draws, or parts, that are rasterized;
    /// empty: all have states[0]. Without states they have RasterState{}.
    std::span<const RasterState> states;
    std::span<const std::uint32_t> state_of_draw;
    /// The smallest step of the depth format, by which a constant bias counts; 0: that of a 32-bit float at the
    /// greatest depth of each triangle.
    double depth_step = 0x1p-24;
    unsigned threads = 0;                    ///< 0 = all cores; the result is the same for any number
    const std::atomic<bool>* stop = nullptr; ///< when it becomes true, sim::Interrupted is thrown
    std::function<void(double)> progress;    ///< called with the share done, 0 to 1, never by two threads at once
    /// Called when the quads are known, with the bytes that they are about to take together; ends the work by throwing.
    std::function<void(const FragmentStream&, std::uint64_t)> about_to_shade;
};

/// Rasterizes and shades the given draws, in the given order, as seen by `view`.
///
/// `resources` must satisfy Resources::validate(). `which` holds indices into `draws`; Triangle::draw and
/// DrawRange::draw are such indices too. Throws sim::InputError when the view, an index in `which`, a draw
/// or state is unusable, and when the result has more primitives, triangles or quads than 32-bit numbers can count.
FragmentStream rasterize(const Resources& resources, const std::vector<Draw>& draws,
                         std::span<const std::uint32_t> which, const View& view, const FrontEndOptions& options = {});

/// The same of parts of draws. The lists that they are runs of must be in range, and their indices those of vertices of
/// the draws they belong to.
FragmentStream rasterize_parts(const Resources& resources, const std::vector<Draw>& draws,
                               std::span<const DrawPart> parts, const View& view, const FrontEndOptions& options = {});

} // namespace pipeline
