#include "reports/validation/folds_report.hpp"

#include "reports/numbers.hpp"
#include "reports/result.hpp"
#include "reports/text_table.hpp"
#include "reports/validation/error_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

constexpr const char* folds_reading =
    "Least squares of ln(model / published) over the printed rows of a card but those of a fold; then the rows left "
    "out. The null model is the geometric mean of the rows that were fitted. A row is not testable where it depends on "
    "a number that no row of the fit determines.";

std::string undetermined_text(const HeldOutRow& held) {
    return held.testable()
               ? ""
               : fmt::format("not testable: nothing else determines {}", fmt::join(held.undetermined, ", "));
}

std::string folds_sentence(const GpuFolds& card) {
    const ErrorSpread& spread = card.held_out;
    std::string text = fmt::format("{}: {} in {} (seed {}), fitted together to {:.3f} RMS. ", card.gpu,
                                   counted(card.rows.size(), "row"), sim::counted(card.folds.size(), "fold"), card.seed,
                                   card.whole.rms);
    if (spread.rows == 0) {
        text += "No row left out is testable.";
    } else {
        text += fmt::format("Left out, {} testable: error {:.3f} in the median, {:.3f} RMS, {:.3f} at worst ({}).",
                            spread.rows == 1 ? "1 is" : fmt::format("{} are", spread.rows), spread.median, spread.rms,
                            spread.worst, spread.worst_row);
        if (const auto skill = spread.skill())
            text += fmt::format(" Null model: {:.3f} RMS; skill {:+.2f}.", *spread.null_rms, *skill);
    }
    if (!card.held_in.empty())
        text += fmt::format(" Never left out, as something was chosen with them in view: {}.",
                            fmt::join(card.held_in, ", "));
    return text;
}

} // namespace

std::string folds_text(const std::vector<GpuFolds>& cards, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    std::string sentences;
    for (const GpuFolds& card : cards) {
        for (const HeldOutRow& held : card.rows) {
            const ValidationRow& row = held.row;
            rows.push_back({row.gpu, std::to_string(held.fold), row.key(), fmt::format("{:.4g}", row.low),
                            held.testable() ? fmt::format("{:.4g}", row.model) : "",
                            held.testable() ? error_text(row.log_error()) : "",
                            held.testable() ? error_in_sigma_text(row) : "", fmt::format("{:.4g}", row.null_model),
                            undetermined_text(held)});
        }
        sentences += wrap(folds_sentence(card), style.columns, 2);
    }
    return wrap(folds_reading, style.columns, 0) + wrap(std::string(error_reading), style.columns, 0) + "\n" +
           text_table({{"GPU", "", true},
                       {"fold", ""},
                       {"row left out", "", true},
                       {"published", ""},
                       {"model", ""},
                       {"error", "ln"},
                       {"error", "sigma"},
                       {"null", ""},
                       {"", "", true}},
                      rows, style) +
           "\n" + sentences;
}

ordered_json folds_json(const std::vector<GpuFolds>& cards) {
    ordered_json gpus = ordered_json::array();
    for (const GpuFolds& card : cards) {
        ordered_json folds = ordered_json::array(), rows = ordered_json::array(), untestable = ordered_json::array();
        for (const FoldFit& fold : card.folds)
            folds.push_back({{"left_out", fold.left_out}, {"numbers", fold.values}, {"fitted_rms", fold.rms}});
        for (const HeldOutRow& held : card.rows) {
            ordered_json json = validation_row_json(held.row);
            json["fold"] = held.fold;
            json["testable"] = held.testable();
            if (!held.testable()) {
                json["undetermined"] = held.undetermined;
                untestable.push_back(held.row.key());
            }
            rows.push_back(std::move(json));
        }
        const ErrorSpread& spread = card.held_out;
        ordered_json summary = {{"rows", card.rows.size()},
                                {"testable_rows", spread.rows},
                                {"median_held_out_error", spread.median},
                                {"rms_held_out_error", spread.rms},
                                {"worst_held_out_error", spread.worst},
                                {"worst_row", spread.worst_row},
                                {"null_model_rms", nullptr},
                                {"skill", nullptr},
                                {"fitted_rms", card.whole.rms}};
        if (spread.null_rms) summary["null_model_rms"] = *spread.null_rms;
        if (const auto skill = spread.skill()) summary["skill"] = *skill;
        gpus.push_back({{"gpu", card.gpu},
                        {"seed", card.seed},
                        {"numbers", card.whole.values},
                        {"folds", std::move(folds)},
                        {"rows", std::move(rows)},
                        {"not_testable", std::move(untestable)},
                        {"never_left_out", card.held_in},
                        {"summary", std::move(summary)}});
    }
    return {{"ropsim", {{"version", version_text()}, {"build", build_text()}}},
            {"method", folds_reading},
            {"gpus", std::move(gpus)}};
}

std::vector<Table> folds_tables(const std::vector<GpuFolds>& cards) {
    Table held_out{"held_out.csv", validation_columns(), {}};
    held_out.header.insert(held_out.header.end(), {"fold", "testable", "undetermined"});
    Table numbers{"fold_numbers.csv", {"GPU", "fold", "number", "value"}, {}};
    for (const GpuFolds& card : cards) {
        for (const HeldOutRow& held : card.rows) {
            held_out.rows.push_back(validation_cells(held.row));
            held_out.rows.back().insert(held_out.rows.back().end(),
                                        {std::to_string(held.fold), held.testable() ? "yes" : "no",
                                         fmt::format("{}", fmt::join(held.undetermined, " "))});
        }
        for (std::size_t fold = 0; fold < card.folds.size(); ++fold)
            for (const auto& [number, value] : card.folds[fold].values)
                numbers.rows.push_back({card.gpu, std::to_string(fold + 1), number, fmt::format("{:.6g}", value)});
    }
    return {std::move(held_out), std::move(numbers)};
}

} // namespace reports
