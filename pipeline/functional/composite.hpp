// The picture of a k-buffer: its layers composited front to back (specification 004, A11; workload W2, pass 2).
#pragma once

#include "pipeline/frame.hpp"

#include <span>
#include <vector>

namespace pipeline {

/// The picture of a frame: drains the pixels of the k-buffer if the program asks for it, and hands them to
/// frame.resolve; without one, composites the layers.
///
/// Compositing: RGBA floats per pixel (alpha 1): C += T * a * c_i and T *= 1 - a over the entries in stored order with
/// a = frame.opacity, then C += T * background.
///
/// With several samples to a pixel, each sample's plane becomes a picture of its own, seen through the pixels' samples
/// instead of their centres; the result is their mean.
///
/// The background is the colour surface or, where there is none, frame.background. Entries that
/// still have the depth they were cleared to are empty. Programs with four floats per entry give the layers' colours;
/// depth-only programs get a grey ramp instead: 0.9 at the near plane to 0.1 at the far plane, linear in the logarithm
/// of the distance (perspective) or in the distance (parallel projection).
std::vector<float> composite(const Frame& frame, const FinishedSurfaces& surfaces);

/// Calls `use(surfaces)` with the pixels of the k-buffer drained, as every resolve takes them.
template <class Use>
auto with_drained(const Frame& frame, FinishedSurfaces surfaces, Use use) {
    std::vector<float> finished;
    if (frame.program->drains()) {
        finished.assign(surfaces.kbuffer.begin(), surfaces.kbuffer.end());
        const std::size_t floats = frame.program->floats_per_pixel();
        for (std::size_t at = 0; at < finished.size(); at += floats) frame.program->drain(finished.data() + at);
        surfaces.kbuffer = finished;
    }
    return use(surfaces);
}

} // namespace pipeline
