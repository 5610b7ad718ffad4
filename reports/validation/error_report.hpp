// Errors of published numbers for people and for programs; the same for every target of `ropsim validate`.
#pragma once

#include "reports/csv.hpp"
#include "reports/text_table.hpp"
#include "reports/validation/validation_row.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace reports {

/// How errors are to be read.
inline constexpr std::string_view error_reading =
    "Error: ln(model / published), signed: +0.10 is a model 1.105 times the printed number. Sigma is half a unit of "
    "the "
    "last printed digit over the number; the error stands beside it in sigmas.";
/// What the statuses of rows are.
inline constexpr std::string_view status_reading =
    "Calibrated: a number of the GPU was fitted to the row, or a constant or stand-in was chosen with it in view. "
    "Penalty: a driver artefact whose size the row states. Derived: a quotient or repetition of printed numbers, or a "
    "statement in words. Only predicted rows are counted, each printed number once.";

/// "+0.057"
std::string error_text(double logarithm);
/// "+12.3", or "" without a sigma
std::string error_in_sigma_text(const ValidationRow& row);
/// "predicted"
std::string row_status_text(const ValidationRow& row);

/// One or two sentences: how many rows, their errors, the sharp ones, the null model, the skill.
std::string error_sentences(const ErrorSummary& summary);

/// A row for each GPU and kind of rows: counts, errors, null model, skill.
std::string error_summary_text(const std::vector<ErrorSummary>& summaries, TerminalStyle style);
std::string error_summary_html(const std::vector<ErrorSummary>& summaries);
/// summary.csv
Table error_summary_table(const std::vector<ErrorSummary>& summaries);

/// `predicted_rows`, `median_predicted_error` ... of the predicted rows, and `sharp` and `calibrated` with the same.
nlohmann::ordered_json error_summary_json(const ErrorSummary& summary);
/// What every row of a validation says.
nlohmann::ordered_json validation_row_json(const ValidationRow& row);
/// Columns of validation.csv that every target has, and their cells.
std::vector<std::string> validation_columns();
std::vector<std::string> validation_cells(const ValidationRow& row);

} // namespace reports
