#include "reports/truth/against_truth.hpp"

#include "pipeline/functional/eye_depth.hpp"
#include "reports/kbuffer_layout.hpp"
#include "sim/check.hpp"
#include "traces/workloads/csg_picture.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace reports {

namespace {

void add(TruthError& error, double difference) {
    ++error.compared;
    error.worst = std::max(error.worst, difference);
    error.wrong += difference <= error.tolerance ? 0 : 1;
}

/// Of two distances, 0 for none.
double depth_difference(double truth, double other) {
    if ((truth == 0.0) != (other == 0.0)) return std::numeric_limits<double>::infinity();
    return truth == other ? 0.0 : std::fabs(other - truth) / std::fabs(truth);
}

/// other(pixel): the distance to compare with truth(pixel), 0 for none.
template <class TruthDepth, class OtherDepth>
void compare_depths(const Truth& truth, TruthError& error, TruthDepth truth_depth, OtherDepth other_depth) {
    for (std::size_t pixel = 0; pixel < truth.pixels(); ++pixel) {
        const double here = static_cast<double>(truth_depth(pixel)), there = other_depth(pixel);
        if (here == 0.0 && there == 0.0) continue;
        if (truth.doubtful(pixel))
            ++error.doubtful;
        else
            add(error, depth_difference(here, there));
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
        truth, error, [&](std::size_t pixel) { return truth.depths[pixel * truth.layers + layer]; },
        [&](std::size_t pixel) {
            return layout.is_empty(kbuffer, pixel, layer) ? 0.0 : eye.distance(layout.depth(kbuffer, pixel, layer));
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
        add(error, difference);
    }
    return error;
}

TruthError solid_error(const Truth& truth, const pipeline::Frame& frame, std::span<const float> kbuffer) {
    const auto* csg = dynamic_cast<const traces::CsgPicture*>(frame.resolve.get());
    CHECK(csg != nullptr && !truth.solid.empty());
    const traces::CsgSurface surface = traces::csg_surface(frame, kbuffer, csg->expression());
    TruthError error;
    error.what = "solid";
    error.tolerance = depth_tolerance;
    compare_depths(
        truth, error, [&](std::size_t pixel) { return truth.solid[pixel]; },
        [&](std::size_t pixel) {
            const auto x = static_cast<std::uint32_t>(pixel % truth.width);
            const auto y = static_cast<std::uint32_t>(pixel / truth.width);
            return surface.image.sees(x, y) ? surface.image.distance(x, y) : 0.0;
        });
    return error;
}

std::vector<TruthError> errors_of_reference(const Truth& truth, const pipeline::Frame& frame,
                                            const pipeline::ReferenceImage& reference) {
    std::vector<TruthError> errors;
    const bool nearest = frame.program != nullptr && frame.program->peeling() == pipeline::Peeling::nearest;
    if (nearest)
        for (std::uint32_t layer = 0; layer < std::min(truth.layers, frame.program->k()); ++layer)
            errors.push_back(layer_error(truth, frame, reference.kbuffer, layer));
    if (!truth.solid.empty()) {
        errors.push_back(solid_error(truth, frame, reference.kbuffer));
        return errors; // its colours are differences of depths, which differ at every edge
    }
    errors.push_back(colour_error(truth, frame, reference.picture.empty() ? reference.colour : reference.picture));
    return errors;
}

} // namespace reports
