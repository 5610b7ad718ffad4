#include "reports/validation/validation_row.hpp"

namespace reports {

namespace {

using Rows = std::vector<const ValidationRow*>;

ErrorSummary summary_of_gpu(const std::string& gpu, const std::vector<ValidationRow>& rows) {
    Rows predicted, sharp, fitted;
    for (const ValidationRow& row : rows) {
        if (gpu != "all" && row.gpu != gpu) continue;
        if (row.status == RowStatus::predicted) predicted.push_back(&row);
        if (row.status == RowStatus::predicted && row.sharp()) sharp.push_back(&row);
        if (row.status == RowStatus::calibrated && row.origin == PublishedOrigin::measured) fitted.push_back(&row);
    }
    ErrorSummary summary{gpu, error_spread(gpu, predicted), error_spread(gpu, sharp), error_spread(gpu, fitted)};
    summary.fitted.null_rms.reset(); // the null model was fitted to the same rows
    return summary;
}

} // namespace

double median_of(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

std::optional<double> ErrorSpread::skill() const {
    if (!null_rms || *null_rms <= 0) return {};
    return 1 - rms / *null_rms;
}

ErrorSpread error_spread(const std::string& gpu, const std::vector<const ValidationRow*>& rows) {
    ErrorSpread spread;
    spread.rows = rows.size();
    if (rows.empty()) return spread;
    std::vector<double> sizes;
    double sum = 0, squares = 0, null_squares = 0;
    bool null_says_all = true;
    for (const ValidationRow* row : rows) {
        const double error = row->log_error();
        sizes.push_back(std::abs(error));
        sum += error;
        squares += error * error;
        if (row->null_model > 0)
            null_squares += row->null_log_error() * row->null_log_error();
        else
            null_says_all = false;
        if (std::abs(error) < spread.worst) continue;
        spread.worst = std::abs(error);
        spread.worst_row = gpu == "all" ? row->key() + " on " + row->gpu : row->key();
    }
    const auto count = static_cast<double>(rows.size());
    spread.median = median_of(std::move(sizes));
    spread.rms = std::sqrt(squares / count);
    spread.mean = sum / count;
    if (null_says_all) spread.null_rms = std::sqrt(null_squares / count);
    return spread;
}

std::vector<ErrorSummary> summarise(const std::vector<ValidationRow>& rows) {
    std::vector<std::string> gpus;
    for (const ValidationRow& row : rows)
        if (std::find(gpus.begin(), gpus.end(), row.gpu) == gpus.end()) gpus.push_back(row.gpu);
    std::vector<ErrorSummary> list;
    for (const std::string& gpu : gpus) list.push_back(summary_of_gpu(gpu, rows));
    list.push_back(summary_of_gpu("all", rows));
    return list;
}

} // namespace reports
