#include "pipeline/functional/composite.hpp"

#include "pipeline/functional/sample_pattern.hpp"
#include "sim/check.hpp"

#include <algorithm>

namespace pipeline {

namespace {

std::vector<float> picture_of_samples(const Frame& frame, const FinishedSurfaces& surfaces) {
    const View planes = frame.view;
    std::vector<float> pictures(planes.places() * 4);
    Frame seen = frame;
    for (std::uint32_t sample = 0; sample < planes.samples; ++sample) {
        const auto plane = [&](std::span<const float> surface, std::size_t floats) {
            return surface.empty() ? surface : plane_of_sample(planes, sample, surface, floats);
        };
        seen.view = view_of_sample(planes, sample);
        const auto picture = frame.resolve->picture(seen, {plane(surfaces.kbuffer, frame.program->floats_per_pixel()),
                                                           plane(surfaces.colour, 4), plane(surfaces.depth, 1)});
        std::copy(picture.begin(), picture.end(), plane_of_sample(planes, sample, std::span(pictures), 4).begin());
    }
    return mean_of_samples(planes, pictures, 4);
}

} // namespace

std::vector<float> composite(const Frame& frame, const FinishedSurfaces& surfaces) {
    CHECK(frame.program != nullptr && frame.resolve != nullptr);
    const std::size_t places = frame.view.places();
    CHECK(surfaces.kbuffer.size() == frame.view_of_kbuffer().places() * frame.program->floats_per_pixel());
    CHECK(surfaces.colour.empty() || surfaces.colour.size() == places * 4);
    CHECK(surfaces.depth.empty() || surfaces.depth.size() == places);
    std::vector<float> drained;
    FinishedSurfaces finished = surfaces;
    if (frame.program->drains()) {
        drained.assign(surfaces.kbuffer.begin(), surfaces.kbuffer.end());
        const std::size_t floats = frame.program->floats_per_pixel();
        for (std::size_t at = 0; at < drained.size(); at += floats) frame.program->drain(drained.data() + at);
        finished.kbuffer = drained;
    }
    return frame.view.samples == 1 ? frame.resolve->picture(frame, finished) : picture_of_samples(frame, finished);
}

} // namespace pipeline
