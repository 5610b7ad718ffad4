// The contract of the last pass of a frame: how a finished k-buffer becomes the picture (specification 004, workload
// W2, pass 2). A workload whose picture is not the plain composite of functional/composite.hpp implements it; that pass
// is not timed.
#pragma once

#include <span>
#include <vector>

namespace pipeline {

struct Frame;

class Resolve {
  public:
    virtual ~Resolve() = default;

    /// Linear RGBA, four floats per pixel, row 0 first. `kbuffer` holds program->floats_per_pixel() floats per pixel,
    /// as the last fragment and the program's drain left them; `opaque_colour` RGBA floats per pixel, or nothing when
    /// no pass wrote the colour surface. Every float of the picture is finite.
    virtual std::vector<float> picture(const Frame& frame, std::span<const float> kbuffer,
                                       std::span<const float> opaque_colour) const = 0;
};

} // namespace pipeline
