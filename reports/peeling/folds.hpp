// Held-out errors of depth peeling.
#pragma once

#include "reports/peeling/calibration.hpp"
#include "reports/validation/folds.hpp"

#include <cstdint>

namespace reports {

/// The numbers that peeling calibrates, fitted to all printed MP and SP but those of a fold, each printed number once.
/// Between half and twice what the GPU file has, a row is run at three values of each number, and ln(time) is the
/// parabola through them over ln(number): a fit needs hundreds of values, and these runs take minutes.
GpuFolds fold_peeling(const PublishedPeeling& published, unsigned folds, std::uint64_t seed,
                      const PeelingOptions& options);

} // namespace reports
