#include "reports/geometry/tables.hpp"

#include "reports/validation/error_report.hpp"

#include <fmt/format.h>

namespace reports {

namespace {

std::string table_number(double value) { return fmt::format("{:.6g}", value); }

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
        table.rows.push_back(joined({one.name, std::to_string(one.result.cycles), table_number(one.result.milliseconds),
                                     table_number(one.result.frames_per_second()), one.result.limit()},
                                    sim::csv_row(one.measure)));
    return table;
}

Table demand_table(const GeometryAdvice& advice) {
    Table table{"demand.csv", {"case", "part", "demand [core cycles]"}, {}};
    for (const GeometryCase& one : advice.cases)
        sim::for_each_field(one.result.demand, [&](const auto& field, const double& cycles) {
            table.rows.push_back({one.name, std::string(field.text), table_number(cycles)});
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
            table.rows.push_back(joined(joined({one.name, std::to_string(i), table_number(draw.counts.acmr()),
                                                std::to_string(draw.terms.span), table_number(draw.terms.slowdown)},
                                               sim::csv_row(draw.counts)),
                                        sim::csv_row(draw.demand)));
        }
    return table;
}

Table rows_table(const GeometryValidation& validation) {
    Table table{"validation.csv", joined(validation_columns(), {"ACMR", "limit"}), {}};
    for (const ValidationRow& row : validation.rows)
        table.rows.push_back(joined(validation_cells(row), {row.acmr > 0 ? table_number(row.acmr) : "", row.limit}));
    return table;
}

Table leave_one_out_table(const std::vector<LeftOneOut>& entries) {
    Table table{"leave_one_out.csv",
                {"GPU", "number", "from row", "instead of", "value", "usual value", "median |ln|", "worst |ln|"},
                {}};
    for (const LeftOneOut& entry : entries)
        table.rows.push_back({entry.gpu, entry.parameter, entry.row, entry.instead_of,
                              entry.found ? table_number(entry.value) : "", table_number(entry.usual_value),
                              entry.found ? table_number(entry.with_row.median) : "",
                              entry.found ? table_number(entry.with_row.worst) : ""});
    return table;
}

} // namespace

std::vector<Table> advice_tables(const GeometryAdvice& advice) {
    return {cases_table(advice), demand_table(advice), draws_table(advice)};
}

std::vector<Table> validation_tables(const GeometryValidation& validation, const std::vector<LeftOneOut>& entries) {
    std::vector<Table> tables{rows_table(validation), error_summary_table(validation.summary)};
    if (!entries.empty()) tables.push_back(leave_one_out_table(entries));
    return tables;
}

Table calibration_table(const std::vector<GpuCalibration>& calibrations) {
    Table table{"numbers.csv",
                {"GPU", "number", "kind", "value", "in file", "row", "published [ms]", "model [ms]", "reason"},
                {}};
    for (const GpuCalibration& calibration : calibrations) {
        for (const CalibratedNumber& one : calibration.numbers)
            table.rows.push_back({calibration.gpu, one.step.parameter,
                                  one.step.kind == CalibrationKind::penalty ? "penalty" : "calibrated",
                                  table_number(one.value), table_number(one.in_file), one.step.row,
                                  table_number(one.published), table_number(one.model), one.step.reason});
        for (const ScaledNumber& one : calibration.scaled)
            table.rows.push_back({calibration.gpu, one.rule.parameter, "scaled", table_number(one.value),
                                  table_number(one.in_file), "", "", "", "that of " + one.rule.from});
    }
    return table;
}

} // namespace reports
