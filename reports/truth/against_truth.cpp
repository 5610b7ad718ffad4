#include "reports/truth/against_truth.hpp"

#include "pipeline/functional/eye_depth.hpp"
#include "reports/kbuffer_layout.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace reports {

namespace {

void add(TruthError& error, std::size_t pixel, double difference) {
    ++error.compared;
    error.worst = std::max(error.worst, difference);
    if (difference <= error.tolerance) return;
    ++error.wrong;
    error.wrong_at.push_back(static_cast<std::uint32_t>(pixel));
}

using Distance = std::optional<double>;

double depth_difference(const Distance& truth, const Distance& other) {
    if (!truth || !other) return std::numeric_limits<double>::infinity();
    return *truth == *other ? 0.0 : std::fabs(*other - *truth) / std::fabs(*truth);
}

/// Both give the Distance at a pixel.
template <class TruthDepth, class OtherDepth>
void compare_depths(const Truth& truth, TruthError& error, TruthDepth truth_depth, OtherDepth other_depth) {
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel) {
        const Distance here = truth_depth(pixel), there = other_depth(pixel);
        if (!here && !there) continue;
        if (truth.doubtful(pixel))
            ++error.doubtful;
        else
            add(error, pixel, depth_difference(here, there));
    }
}

} // namespace

TruthError layer_error(const Truth& truth, const pipeline::Frame& frame, std::span<const float> kbuffer,
                       std::uint32_t layer) {
    const KBufferLayout layout(*frame.program);
    CHECK(layer < truth.layers && layer < layout.layers());
    const pipeline::EyeDepth eye(frame.view.projection);
    TruthError error;
    error.what = fmt::format("layer {}", layer);
    error.tolerance = depth_tolerance;
    compare_depths(
        truth, error,
        [&](std::size_t pixel) -> Distance {
            if (layer >= truth.layers_at(pixel)) return std::nullopt;
            return truth.depths[pixel * truth.layers + layer];
        },
        [&](std::size_t pixel) -> Distance {
            if (layout.is_empty(kbuffer, pixel, layer)) return std::nullopt;
            return eye.distance(layout.depth(kbuffer, pixel, layer));
        });
    return error;
}

TruthError colour_error(const Truth& truth, const pipeline::Frame& frame, std::span<const float> picture) {
    CHECK(picture.size() == truth.colours.size());
    const std::uint32_t k = frame.program ? frame.program->k() : std::numeric_limits<std::uint32_t>::max();
    TruthError error;
    error.what = "colour";
    error.tolerance = colour_tolerance;
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel) {
        if (truth.surfaces[pixel] == 0) continue;
        if (truth.layers_at(pixel) > k) {
            ++error.overflown;
            continue;
        }
        if (truth.doubtful(pixel)) {
            ++error.doubtful;
            continue;
        }
        double difference = 0.0;
        for (std::size_t i = pixel * 4; i < pixel * 4 + 3; ++i)
            difference = std::max(difference,
                                  std::fabs(static_cast<double>(picture[i]) - static_cast<double>(truth.colours[i])));
        add(error, pixel, difference);
    }
    return error;
}

TruthError distance_error(const Truth& truth, const traces::TruthMethod& method, const pipeline::Frame& frame,
                          const pipeline::ReferenceImage& reference) {
    CHECK(method.rasterized && !truth.channels.empty());
    const traces::TruthChannel& channel = truth.channels.front();
    const std::vector<Distance> rasterized = method.rasterized(frame, reference);
    CHECK(rasterized.size() == truth.pixels());
    TruthError error;
    error.what = channel.name;
    error.tolerance = depth_tolerance;
    compare_depths(
        truth, error,
        [&](std::size_t pixel) -> Distance {
            if (!channel.has(pixel)) return std::nullopt;
            return channel.values[pixel];
        },
        [&](std::size_t pixel) { return rasterized[pixel]; });
    return error;
}

std::vector<TruthError> errors_of_reference(const Truth& truth, const traces::TruthMethod& method,
                                            const pipeline::Frame& frame, const pipeline::ReferenceImage& reference) {
    std::vector<TruthError> errors;
    const bool nearest = frame.program != nullptr && frame.program->peeling() == pipeline::Peeling::nearest;
    if (nearest)
        for (std::uint32_t layer = 0; layer < std::min(truth.layers, frame.program->k()); ++layer)
            errors.push_back(layer_error(truth, frame, reference.kbuffer, layer));
    errors.push_back(
        method.rasterized
            ? distance_error(truth, method, frame, reference)
            : colour_error(truth, frame, reference.picture.empty() ? reference.colour : reference.picture));
    return errors;
}

} // namespace reports
