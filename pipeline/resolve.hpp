// The contract of the last pass of a frame: how finished surfaces become the picture (specification 004, workload W2,
// pass 2). A workload whose picture no shader of a pass makes implements it. The picture is a pure function, and takes
// no time.
#pragma once

#include <span>
#include <vector>

namespace pipeline {

struct Frame;

/// What the passes before left behind, row 0 first.
struct FinishedSurfaces {
    /// program->floats_per_pixel() floats per pixel of the k-buffer's view, as the last fragment and the program's
    /// drain left them.
    std::span<const float> kbuffer;
    std::span<const float> colour; ///< RGBA floats per pixel, or nothing when no pass wrote the colour surface
    std::span<const float> depth;  ///< window depth per pixel, likewise
};

class Resolve {
  public:
    virtual ~Resolve() = default;

    /// Linear RGBA, four floats per pixel of frame.view, row 0 first. Every float of the picture is finite.
    virtual std::vector<float> picture(const Frame& frame, const FinishedSurfaces& surfaces) const = 0;
};

} // namespace pipeline
