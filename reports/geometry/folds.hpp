// Held-out errors of geometry feed.
#pragma once

#include "reports/geometry/validation.hpp"
#include "reports/validation/folds.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace reports {

/// Every number that the plan calibrates of a card, fitted to all of its printed rows but those of a fold. Numbers that
/// are scaled from another card's are those of its file. With estimates of a smaller sample than usual, whatever the
/// options say: a fold takes thousands of runs.
/// @param gpus empty: all that were measured
/// Throws sim::InputError for a GPU without measurements.
std::vector<GpuFolds> fold_geometry(const std::vector<std::string>& gpus, unsigned folds, std::uint64_t seed,
                                    const GeometryRunOptions& options);

} // namespace reports
