// Hazards by class and kind, as every file and table names them.
#pragma once

#include "pipeline/run_result.hpp"
#include "reports/terminal_table.hpp"

#include <array>
#include <string>
#include <string_view>

namespace reports {

inline constexpr std::array<std::string_view, pipeline::hazard_classes> hazard_class_names{"h1", "h2", "h3", "h4"};
inline constexpr std::array<std::string_view, pipeline::hazard_kinds> hazard_kind_names{"concurrency", "incoherence"};

std::string_view hazard_name(pipeline::HazardClass cause);
std::string_view hazard_name(pipeline::HazardKind kind);

/// calls visit("h1_concurrency", fragments) for each cell of the table.
template <class Visit>
void for_each_hazard_cell(const pipeline::HazardCounts& counts, Visit&& visit) {
    for (std::size_t cause = 0; cause < pipeline::hazard_classes; ++cause)
        for (std::size_t kind = 0; kind < pipeline::hazard_kinds; ++kind)
            visit(std::string(hazard_class_names[cause]) + "_" + std::string(hazard_kind_names[kind]),
                  counts.by[cause][kind]);
}

/// What "concurrency" and "incoherence" mean, and the classes; one line each.
inline constexpr std::string_view hazard_kinds_explained =
    "Concurrency: coherent reads at the same instants would have missed the store, too, because it had not happened. "
    "Incoherence: the store had happened, and the value read was an older copy.";
inline constexpr std::string_view hazard_classes_explained =
    "H1: the predecessor was still in flight. H2: it was in the write path. H3: the texture cache line was older. H4: "
    "the render targets of one read held different versions.";

/// Classes by kinds of every run that has hazards; empty when none has.
std::string hazards_text(const Comparison& comparison, TerminalStyle style);

} // namespace reports
