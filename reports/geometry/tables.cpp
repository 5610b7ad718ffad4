#include "reports/geometry/tables.hpp"

#include <fmt/format.h>

namespace reports {

namespace {

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::vector<std::string> joined(std::vector<std::string> first, const std::vector<std::string>& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

Table cases_table(const GeometryAdvice& advice) {
    Table table{"cases.csv",
                joined({"case", "cycles [core cycles]", "time [ms]", "frames/s", "limit"},
                       sim::csv_header<traces::MeshMeasure>()),
                {}};
    for (const GeometryCase& one : advice.cases)
        table.rows.push_back(joined({one.name, std::to_string(one.result.cycles), number(one.result.milliseconds),
                                     number(one.result.frames_per_second()), one.result.limit()},
                                    sim::csv_row(one.measure)));
    return table;
}

Table demand_table(const GeometryAdvice& advice) {
    Table table{"demand.csv", {"case", "part", "demand [core cycles]"}, {}};
    for (const GeometryCase& one : advice.cases)
        sim::for_each_field(one.result.demand, [&](const auto& field, const double& cycles) {
            table.rows.push_back({one.name, std::string(field.text), number(cycles)});
        });
    return table;
}

Table draws_table(const GeometryAdvice& advice) {
    Table table{"draws.csv",
                joined(joined({"case", "draw", "ACMR", "index range [vertices]", "slowdown"},
                              sim::csv_header<pipeline::GeometryDrawStats>()),
                       sim::csv_header<pipeline::VertexPathDemand>()),
                {}};
    for (const GeometryCase& one : advice.cases)
        for (std::size_t i = 0; i < one.result.draws.size(); ++i) {
            const pipeline::VertexPathDraw& draw = one.result.draws[i];
            table.rows.push_back(joined(joined({one.name, std::to_string(i), number(draw.counts.acmr()),
                                                std::to_string(draw.terms.span), number(draw.terms.slowdown)},
                                               sim::csv_row(draw.counts)),
                                        sim::csv_row(draw.demand)));
        }
    return table;
}

Table rows_table(const GeometryValidation& validation) {
    Table table{"validation.csv",
                {"table", "row", "GPU", "unit", "published", "published, least", "published, most", "model", "ratio",
                 "status", "origin", "source", "number", "ACMR", "limit", "explanation"},
                {}};
    for (const ValidationRow& row : validation.rows)
        table.rows.push_back({row.table, row.row, row.gpu, row.unit, number(row.published()), number(row.low),
                              number(row.high), number(row.model), number(row.ratio()),
                              std::string(sim::enum_name(row.status)), std::string(sim::enum_name(row.origin)),
                              row.source, row.parameter, row.acmr > 0 ? number(row.acmr) : "", row.limit,
                              row.explanation});
    return table;
}

Table summary_table(const GeometryValidation& validation) {
    Table table{"summary.csv",
                {"GPU", "predicted rows", "median error", "worst error", "worst row", "measured of them",
                 "median error of measured", "worst error of measured", "worst row of measured"},
                {}};
    for (const ErrorSummary& summary : validation.summary)
        table.rows.push_back({summary.gpu, std::to_string(summary.predicted.rows), number(summary.predicted.median),
                              number(summary.predicted.worst), summary.predicted.worst_row,
                              std::to_string(summary.measured.rows), number(summary.measured.median),
                              number(summary.measured.worst), summary.measured.worst_row});
    return table;
}

Table leave_one_out_table(const std::vector<LeftOneOut>& entries) {
    Table table{"leave_one_out.csv",
                {"GPU", "number", "from row", "instead of", "value", "usual value", "median error", "worst error"},
                {}};
    for (const LeftOneOut& entry : entries)
        table.rows.push_back({entry.gpu, entry.parameter, entry.row, entry.instead_of,
                              entry.found ? number(entry.value) : "", number(entry.usual_value),
                              entry.found ? number(entry.with_row.median) : "",
                              entry.found ? number(entry.with_row.worst) : ""});
    return table;
}

} // namespace

std::vector<Table> advice_tables(const GeometryAdvice& advice) {
    return {cases_table(advice), demand_table(advice), draws_table(advice)};
}

std::vector<Table> validation_tables(const GeometryValidation& validation, const std::vector<LeftOneOut>& entries) {
    std::vector<Table> tables{rows_table(validation), summary_table(validation)};
    if (!entries.empty()) tables.push_back(leave_one_out_table(entries));
    return tables;
}

} // namespace reports
