// A rasterized frame beside its truth, by the rules of specification 004, section 10.4.
//
// Where a ray passes an edge closely or meets a surface edge-on, a rasterizer, whose corners lie on a sub-pixel grid,
// may see something else: such pixels are left out, and counted; of those that differ, so are pixels with a silhouette
// that the ray just misses and with coplanar surfaces (silhouettes.hpp). The rules say whether rasterizer and formulas
// are right. They are for frames without hazards; what hazards do is told by the difference to the frame in submission
// order, whose every pixel counts.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/reference.hpp"
#include "reports/truth/truth.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace reports {

inline constexpr double depth_tolerance = 1e-4;         ///< |dz| / z of a layer
inline constexpr double colour_tolerance = 2.0 / 255.0; ///< of red, green and blue
inline constexpr double share_expected = 0.999;         ///< of the pixels

struct TruthError {
    std::string what;                    ///< "layer 0", "colour"
    std::uint64_t compared = 0;          ///< pixels where either has something to show
    std::uint64_t doubtful = 0;          ///< left out as above
    std::uint64_t overflown = 0;         ///< left out as they have more fragments than k
    std::uint64_t wrong = 0;             ///< of `compared`, beyond the tolerance
    std::vector<std::uint32_t> wrong_at; ///< the wrong pixels
    double worst = 0.0;                  ///< largest error; infinite where only one has a surface
    double tolerance = 0.0;

    double share_right() const {
        return compared == 0 ? 1.0 : 1.0 - static_cast<double>(wrong) / static_cast<double>(compared);
    }
    /// Of nothing nothing holds.
    bool holds() const { return compared != 0 && share_right() >= share_expected; }
};

/// Layer i of a k-buffer whose program keeps the nearest fragments; i below the k of both.
TruthError layer_error(const Truth& truth, const pipeline::Frame& frame, std::span<const float> kbuffer,
                       std::uint32_t layer);

/// `picture`: RGBA floats per pixel. Pixels that overflow the frame's k are left out.
TruthError colour_error(const Truth& truth, const pipeline::Frame& frame, std::span<const float> picture);

/// Of the method's first channel, which holds distances: relative error.
TruthError distance_error(const Truth& truth, const traces::TruthMethod& method, const pipeline::Frame& frame,
                          const pipeline::ReferenceImage& reference);

/// The layers that the frame keeps, and distances or colours as the method says, for the frame in submission order.
std::vector<TruthError> errors_of_reference(const Truth& truth, const traces::TruthMethod& method,
                                            const pipeline::Frame& frame, const pipeline::ReferenceImage& reference);

} // namespace reports
