// A comparison as comma-separated tables (RFC 4180: quoted where needed, a header line; line feeds), one per question.
#pragma once

#include "reports/comparison_result.hpp"

#include <string>
#include <vector>

namespace reports {

struct Table {
    std::string name;                ///< of the file: "designs.csv"
    std::vector<std::string> header; ///< with units: "cycles [core cycles]"
    std::vector<std::vector<std::string>> rows;
    std::string lines = {}; ///< further rows, written as text

    std::string text() const;
};

/// One row per design; of one that does not fit on chip only its name and what it needs.
Table designs_table(const Comparison& comparison);
/// One row per design, stage and number: counters, and the cycles of each activity.
Table stages_table(const Comparison& comparison);
/// One row per design and draw, over all passes; one column per counter that any draw has.
Table draws_table(const Comparison& comparison);
/// The same of each pass that a design executed, where it added anything; cycles of first and last quads are left out.
Table pass_draws_table(const Comparison& comparison);
/// One row per pass that a design executed.
Table passes_table(const Comparison& comparison);
/// One row per victim with the predecessor whose update it overwrote. Only the first pairs of a run are kept: `listed`
/// and `hazards` are equal in a complete list.
Table hazard_pairs_table(const Comparison& comparison);
/// One row per design and range of distances.
Table hazard_distance_table(const Comparison& comparison);

std::vector<Table> all_tables(const Comparison& comparison);

} // namespace reports
