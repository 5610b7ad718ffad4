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

} // namespace pipeline
