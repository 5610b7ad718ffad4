// Where depth peeling cannot tell the layers of a pixel apart: they lie nearer to each other than its depth format, or
// the eps of its rule.
#pragma once

#include "pipeline/fragment_stream.hpp"
#include "pipeline/output/kbuffer_design.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace pipeline {

enum class PeelLoss : std::uint8_t { none, depth_format, eps };

/// For each of `places` (numbers in the stream's surface, ascending) what swaps or loses layers when its fragments are
/// peeled by `site`: by the eps rule, a fragment within eps behind another, or one that eps does not keep from being
/// captured again; else two of different depths and one code of the format.
std::vector<PeelLoss> peel_losses(const PassesSite& site, const FragmentStream& stream,
                                  std::span<const std::size_t> places);

} // namespace pipeline
