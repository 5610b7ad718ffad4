#include "reports/validation/null_models.hpp"

#include "sim/check.hpp"

#include <cmath>
#include <map>
#include <string>

namespace reports {

namespace {

constexpr double null_batch_us = 12.6; // 512x512 pixels at 32 a cycle of 650 MHz: specification 004, section 7.5

/// Of positive numbers; 0 of none.
class GeometricMean {
  public:
    void add(double value) {
        sum_ += std::log(value);
        ++count_;
    }
    double value() const { return count_ == 0 ? 0 : std::exp(sum_ / count_); }

  private:
    double sum_ = 0;
    unsigned count_ = 0;
};

bool printed(const ValidationRow& row) {
    return row.origin == PublishedOrigin::measured && row.unit == "frames/s" && row.low == row.high;
}

bool fits(const ValidationRow& row) { return printed(row) && row.status == RowStatus::calibrated; }

} // namespace

void apply_geometry_null_model(std::vector<ValidationRow>& rows) {
    std::map<std::string, GeometricMean> means;
    for (const ValidationRow& row : rows)
        if (fits(row)) means[row.gpu].add(row.low);
    for (ValidationRow& row : rows)
        if (printed(row)) row.null_model = means[row.gpu].value();
}

void apply_peeling_null_model(std::vector<ValidationRow>& rows, const std::vector<PeelingCell>& cells) {
    CHECK(rows.size() == cells.size());
    std::map<std::string_view, GeometricMean> passes_per_second;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (fits(rows[i]) && cells[i].passes > 0) passes_per_second[cells[i].mesh].add(rows[i].low * cells[i].passes);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (cells[i].passes > 0) rows[i].null_model = passes_per_second[cells[i].mesh].value() / cells[i].passes;
        if (cells[i].batches > 0) rows[i].null_model = 1e6 / (null_batch_us * cells[i].batches);
    }
}

void apply_constant_null_model(std::vector<ValidationRow>& rows, double frames_per_second) {
    for (ValidationRow& row : rows)
        if (printed(row)) row.null_model = frames_per_second;
}

} // namespace reports
