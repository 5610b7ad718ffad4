// All numbers of all stages of a run, one row each.
#pragma once

#include "pipeline/run_result.hpp"

#include <string>
#include <vector>

namespace reports {

struct CounterRow {
    std::string stage;
    std::string kind; ///< "units", "params", "counters" or "activity"
    std::string name;
    std::string value;
    std::string unit;    ///< empty where it is not known
    std::string meaning; ///< likewise
};

std::vector<CounterRow> counter_rows(const pipeline::RunResult& run);

} // namespace reports
