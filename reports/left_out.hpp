// What the runs of a comparison did without, each unit and reason once.
#pragma once

#include "reports/comparison_result.hpp"

#include <string>
#include <vector>

namespace reports {

struct LeftOutEntry {
    std::string unit, reason;
    std::vector<std::string> designs; ///< labels of those that lack it
    bool by_all = false;              ///< these are all designs
};

/// What all lack comes first; otherwise in the order in which the runs name it.
std::vector<LeftOutEntry> left_out_entries(const Comparison& comparison);

} // namespace reports
