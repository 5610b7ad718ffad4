// A small comparison made by hand, for tests of reports.
#pragma once

#include "reports/comparison_result.hpp"

namespace ropsim_test {

/// 8 x 4 pixels, k = 2 entries of red, green, blue and depth. Design "racy": fragment stacks overlap at x = 2..5 and it
/// loses the far entry of pixel (2, 1) (H1) and of (5, 2) (H3). Design "safe": equals the reference.
reports::Comparison sample_comparison();

/// The same with entries of depth only (no colours).
reports::Comparison sample_depth_comparison();

} // namespace ropsim_test
