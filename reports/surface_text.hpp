// The surfaces of a frame and the memory that they take.
#pragma once

#include "reports/comparison_result.hpp"
#include "reports/text_table.hpp"

#include <string>
#include <vector>

namespace reports {

/// Format of a texel; of a k-buffer, its program.
std::string content_text(const pipeline::SurfaceInfo& info);

/// A row for each surface: name, content, size, nominal bytes, the most that any design wrote to.
struct SurfaceRow {
    std::string name, content, size;
    std::uint64_t nominal = 0, high_water = 0;
};
std::vector<SurfaceRow> surface_rows(const Comparison& comparison);

std::string surfaces_text(const Comparison& comparison, TerminalStyle style);

} // namespace reports
