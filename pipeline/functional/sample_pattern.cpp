#include "pipeline/functional/sample_pattern.hpp"

#include "pipeline/functional/vertex_transform.hpp"
#include "sim/check.hpp"

#include <array>

namespace pipeline {

namespace {

constexpr std::int32_t sixteenth = subpixel_one / 16;

constexpr std::array<SampleOffset, 1> centre{};
constexpr std::array<SampleOffset, 4> four{{{-2 * sixteenth, -6 * sixteenth},
                                            {6 * sixteenth, -2 * sixteenth},
                                            {-6 * sixteenth, 2 * sixteenth},
                                            {2 * sixteenth, 6 * sixteenth}}};
constexpr std::array<SampleOffset, 8> eight{{{1 * sixteenth, -3 * sixteenth},
                                             {-1 * sixteenth, 3 * sixteenth},
                                             {5 * sixteenth, 1 * sixteenth},
                                             {-3 * sixteenth, -5 * sixteenth},
                                             {-5 * sixteenth, 5 * sixteenth},
                                             {-7 * sixteenth, -1 * sixteenth},
                                             {3 * sixteenth, 7 * sixteenth},
                                             {7 * sixteenth, -7 * sixteenth}}};

} // namespace

std::span<const SampleOffset> sample_pattern(std::uint32_t samples) {
    CHECK(is_sample_count(samples));
    if (samples == 1) return centre;
    if (samples == 4) return four;
    return eight;
}

// Moves everything the other way: x_clip - w_clip * offset, with the offset in normalised device coordinates, y up.
View view_of_sample(const View& view, std::uint32_t sample) {
    const SampleOffset offset = sample_pattern(view.samples)[sample];
    View moved = view;
    moved.samples = 1;
    const float x = 2.0F * static_cast<float>(offset.x) / (subpixel_one * static_cast<float>(view.width));
    const float y = 2.0F * static_cast<float>(offset.y) / (subpixel_one * static_cast<float>(view.height));
    for (int column = 0; column < 4; ++column) {
        moved.projection[column][0] -= x * view.projection[column][3];
        moved.projection[column][1] += y * view.projection[column][3];
    }
    return moved;
}

std::vector<float> mean_of_samples(const View& view, std::span<const float> places, std::size_t values) {
    CHECK(places.size() == view.places() * values);
    std::vector<double> sums(std::size_t{view.width} * view.height * values);
    for (std::uint32_t sample = 0; sample < view.samples; ++sample) {
        const std::span<const float> plane = plane_of_sample(view, sample, places, values);
        for (std::size_t at = 0; at < sums.size(); ++at) sums[at] += static_cast<double>(plane[at]);
    }
    std::vector<float> means(sums.size());
    for (std::size_t at = 0; at < sums.size(); ++at) means[at] = static_cast<float>(sums[at] / view.samples);
    return means;
}

} // namespace pipeline
