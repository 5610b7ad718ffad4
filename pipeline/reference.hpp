// SEQ: a frame executed in submission order, one fragment at a time, without time (specification 004, section 7). What
// every design is compared with, made of the same functional routines.
//
// Modelled: stencil and depth test and write in the surface's own format, blended and masked colour writes, k-buffer
// programs, clears, pictures. Not modelled: time, and whatever a design does to protect pixels.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/frame.hpp"

#include <span>
#include <vector>

namespace pipeline {

/// Surfaces after a frame; row 0 first, planes of samples one below the other (sample_planes.hpp). A surface that no
/// pass writes is empty.
struct ReferenceImage {
    Fp16Overflow fp16_overflow = Fp16Overflow::saturate; ///< of the GPUs whose runs it can be compared with

    std::vector<float> kbuffer;        ///< program->floats_per_pixel() floats per place of its view
    std::vector<float> depth;          ///< window depth per place, as the depth format holds it
    std::vector<std::uint8_t> stencil; ///< per place, where the depth format has any
    std::vector<float> colour;         ///< RGBA per place of the "colour" surface, as the colour format holds it
    std::vector<float> picture;        ///< RGBA per pixel of frames with a k-buffer: the output
    SurfaceStore composed;             ///< has what passes without time wrote last, and nothing else
    SurfaceStore shown;                ///< surfaces that reports show, and nothing else

    /// After each pass of the frame, of each surface that it writes: see written_surfaces().
    std::vector<std::vector<std::uint64_t>> digests;

    /// Per place of the k-buffer: alive fragments that reached it; the depth test, in frames without a k-buffer.
    std::vector<std::uint32_t> depth_complexity;
    std::uint64_t accepted_insertions = 0; ///< k-buffer updates that changed their pixel

    // Constant-distance mode (delay > 1) only, else 0.
    std::uint64_t missed_reads = 0;  ///< fragments whose read lacked the update of a predecessor at their pixel
    std::uint64_t missed_pixels = 0; ///< pixels with such a fragment
};

/// Executes the frame. `streams` holds what rasterize_frame() makes of it.
///
/// With `delay` = H > 1, quad i reads a pixel's k-buffer as the quads up to i - H left it, and stores its result in
/// raster order: a later store overwrites what an earlier one it did not see had changed (checks K1 and K4). H = 1 is
/// SEQ. Depth and colour are always in order. The result is the same for any number of threads (0 = all cores).
///
/// Of a GPU it is given what a picture depends on: how colours are stored in 16-bit floats.
ReferenceImage run_reference(const Frame& frame, std::span<const FragmentStream> streams, QuadId delay = 1,
                             unsigned threads = 0, Fp16Overflow fp16_overflow = Fp16Overflow::saturate);

/// The surfaces that a pass writes or clears: targets, depth, k-buffer.
std::vector<SurfaceId> written_surfaces(const Pass& pass);
/// Those whose content it depends on: what it writes, as it need not write all of it, and what its shader reads.
std::vector<SurfaceId> surfaces_behind(const Pass& pass);

/// Executes one pass, which rasterizes, on `surfaces`; `stream` is its stream as rasterize_frame() makes it. Returns
/// how many of its fragments, or samples, passed the stencil and depth tests.
std::uint64_t run_reference_pass(const Frame& frame, const Pass& pass, const FragmentStream& stream,
                                 SurfaceStore& surfaces, unsigned threads = 0);

} // namespace pipeline
