// The picture that frame.resolve makes of a k-buffer.
#pragma once

#include "pipeline/frame.hpp"

#include <span>
#include <vector>

namespace pipeline {

/// RGBA floats per pixel: drains the pixels of the k-buffer if the program asks for it, and hands them to
/// frame.resolve, which is there.
///
/// With several samples to a pixel, each sample's plane becomes a picture of its own, seen through the pixels' samples
/// instead of their centres; the result is their mean.
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
