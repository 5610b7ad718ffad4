// Where the samples of a pixel lie, and a picture from the pictures of its samples.
//
// The patterns are the standard ones of 4 and 8 samples (Vulkan 1.3, section "Multisampling", standard sample
// locations; the same as Direct3D 11's). Their coordinates are sixteenths of a pixel, so they fall on the sub-pixel
// grid. Not modelled: other patterns, patterns that change from pixel to pixel, weighted filters.
#pragma once

#include "pipeline/draw.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace pipeline {

/// From the pixel's centre to the sample, in sub-pixel units, y down.
struct SampleOffset {
    std::int32_t x = 0, y = 0;
};

constexpr bool is_sample_count(std::uint32_t samples) { return samples == 1 || samples == 4 || samples == 8; }

/// The samples of a pixel that has 1, 4 or 8 of them.
std::span<const SampleOffset> sample_pattern(std::uint32_t samples);

/// The view with one sample per pixel whose pixel centres lie where the given view has sample `sample`.
View view_of_sample(const View& view, std::uint32_t sample);

/// Pixels of the plane that holds sample `sample`: `values` per place, one row after the other.
template <class T>
std::span<T> plane_of_sample(const View& view, std::uint32_t sample, std::span<T> places, std::size_t values) {
    const std::size_t row = std::size_t{view.width} * values;
    return places.subspan(std::size_t{sample} * plane_rows(view.height, view.samples) * row, view.height * row);
}

/// The mean over the samples of each pixel. Samples of one value have exactly that mean.
std::vector<float> mean_of_samples(const View& view, std::span<const float> places, std::size_t values);

} // namespace pipeline
