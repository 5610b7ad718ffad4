// Ray-traced truth of a frame: what its workload would show if a pixel could keep any number of fragments, computed
// without rasterizer, k-buffer and time (specification 004, section 10.4).
//
// One ray through the centre of each pixel finds all its surfaces; the fragment shader of the pipeline gives them their
// colours; the workload makes its picture of them (traces::TruthMethod). Hazards are differences to the frame in
// submission order, never to this alone.
//
// Not modelled: pictures that depend on the order of submission or on what a k-buffer's program kept; workloads that
// make such ones declare no truth.
#pragma once

#include "pipeline/frame.hpp"
#include "reports/truth/light_visibility.hpp"
#include "reports/truth/pixel_rays.hpp"
#include "reports/truth/ray_scene.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace reports {

/// What is asked of the rays.
struct TruthPlan {
    std::uint32_t layers = 8; ///< whose depths are kept for each pixel; pictures are made from all
    std::optional<SquareLight> light;
    LightSampling sampling;
};

struct TruthCounts {
    std::uint64_t pixel_rays = 0, light_rays = 0;
    std::uint64_t surfaces = 0, deepest = 0;
    std::uint64_t pixels_seen = 0, pixels_doubtful = 0, pixels_lit = 0;

    static constexpr auto fields() {
        using P = TruthCounts;
        return std::tuple(
            sim::field<&P::pixel_rays>("rays through pixels").unit("rays"),
            sim::field<&P::light_rays>("rays to the light").unit("rays"),
            sim::field<&P::surfaces>("fragments of all pixels").unit("fragments"),
            sim::field<&P::deepest>("fragments of the pixel that has most").unit("fragments"),
            sim::field<&P::pixels_seen>("pixels with a fragment").unit("pixels"),
            sim::field<&P::pixels_doubtful>("of these, pixels whose ray passes an edge closely or a surface edge-on")
                .unit("pixels"),
            sim::field<&P::pixels_lit>("pixels from whose first surface any of the light is seen").unit("pixels"));
    }
};
static_assert(sim::fully_described<TruthCounts>);

/// The workload's picture, and what every truth knows besides.
struct Truth : traces::TruthPicture {
    std::uint32_t layers = 0;            ///< as asked for
    std::vector<std::uint32_t> surfaces; ///< fragments of each pixel, the opaque one included
    std::vector<float> depths;     ///< `layers` a pixel: distance along the view axis, nearest first; 0 behind the last
    std::vector<float> visibility; ///< with a light: its visible share, 1 where nothing is seen
    std::vector<std::uint8_t> marks; ///< of each pixel
    TruthCounts counts;

    static constexpr std::uint8_t doubtful_mark = 1, opaque_mark = 2;

    /// See PixelSurfaces.
    bool doubtful(std::size_t pixel) const { return (marks[pixel] & doubtful_mark) != 0; }
    /// Fragments for the k-buffer.
    std::uint32_t layers_at(std::size_t pixel) const {
        return surfaces[pixel] - ((marks[pixel] & opaque_mark) != 0 ? 1 : 0);
    }
};

/// `frame` is the method's, where it has one; `scene` has its draws. The same bytes for any number of threads.
Truth trace_truth(const pipeline::Frame& frame, const RayScene& scene, const traces::TruthMethod& method,
                  const TruthPlan& plan = {}, const TracingOptions& options = {});

} // namespace reports
