#include "reports/peeling/validation.hpp"

#include "pipeline/functional/parallel.hpp"
#include "reports/validation/null_models.hpp"
#include "sim/check.hpp"

#include <cmath>
#include <fmt/format.h>
#include <mutex>

namespace reports {

namespace {

constexpr std::uint64_t batch_triangles = 32; // specification 004, section 2.5

std::string column_name(PeelingColumn column) { return std::string(sim::enum_name(column)); }

const PeelingNote* find_note(const std::vector<PeelingNote>& notes, const PeelingMeasurement& row,
                             const std::string& column) {
    for (const PeelingNote& note : notes)
        if (note.dataset == row.dataset && note.buffer == row.buffer && note.column == column) return &note;
    return nullptr;
}

ValidationRow named_row(const PublishedPeeling& published, const PeelingMeasurement& measured,
                        const std::string& name) {
    ValidationRow row;
    row.table = "T6.1";
    row.row = fmt::format("{}, {}, {}", measured.dataset, measured.buffer, name);
    row.gpu = published.gpu;
    if (const PeelingNote* note = find_note(published.explanations, measured, name)) row.explanation = note->text;
    return row;
}

class RowNumbers {
  public:
    RowNumbers(const PublishedPeeling& published, const PeelingMeasurement& row, const std::vector<StandInRun>& runs)
        : published_(published), measured_(row), dataset_(published.dataset(row.dataset)) {
        CHECK(!runs.empty());
        for (std::size_t i = 0; i < peeling_columns; ++i) add_column(static_cast<PeelingColumn>(i), runs);
        add_quotient(PeelingColumn::sp, PeelingColumn::mp);
        add_quotient(PeelingColumn::sp, PeelingColumn::spwh);
        add_quotient(PeelingColumn::mp, PeelingColumn::spwh);
        add_batch_time();
    }
    std::vector<PeelingNumber> take() && { return std::move(numbers_); }

  private:
    PeelingNumber derived(const std::string& name) const {
        PeelingNumber number;
        number.mesh = dataset_.name;
        number.row = named_row(published_, measured_, name);
        number.row.origin = PublishedOrigin::derived;
        return number;
    }

    void add_column(PeelingColumn column, const std::vector<StandInRun>& runs) {
        const auto i = static_cast<std::size_t>(column);
        std::vector<double> triangles, milliseconds;
        for (const StandInRun& run : runs) {
            triangles.push_back(static_cast<double>(run.triangles));
            milliseconds.push_back(run.milliseconds[i]);
        }
        const LineValue whole = line_value(triangles, milliseconds, static_cast<double>(dataset_.triangles));
        PeelingNumber number;
        number.mesh = dataset_.name;
        number.row = published_peeling_row(published_, measured_, column);
        number.row.model = 1e3 / whole.value;
        number.uncertainty = whole.error;
        if (column == PeelingColumn::spwh)
            number.batches = static_cast<double>(batches());
        else
            number.passes = column == PeelingColumn::mp ? measured_.k : 1;
        numbers_.push_back(std::move(number));
    }

    void add_quotient(PeelingColumn over, PeelingColumn under) {
        const PeelingNumber &a = number_of(over), &b = number_of(under);
        PeelingNumber number = derived(fmt::format("{}/{}", column_name(over), column_name(under)));
        number.row.unit = "ratio";
        number.row.source = "quotient of two printed numbers";
        number.row.low = number.row.high = a.row.low / b.row.low;
        number.row.sigma = std::hypot(a.row.sigma, b.row.sigma);
        number.row.model = a.row.model / b.row.model;
        number.uncertainty = a.uncertainty + b.uncertainty;
        add_derived(std::move(number));
    }

    void add_batch_time() {
        const PeelingNumber& frames = number_of(PeelingColumn::spwh);
        const double us = 1e6 / static_cast<double>(batches());
        PeelingNumber number = derived("batch");
        number.row.unit = "us";
        number.row.source = "a frame with heuristics over its batches of 32 triangles";
        number.row.low = number.row.high = us / frames.row.low;
        number.row.sigma = frames.row.sigma;
        number.row.model = us / frames.row.model;
        number.uncertainty = frames.uncertainty;
        add_derived(std::move(number));
    }

    void add_derived(PeelingNumber number) {
        number.row.status = RowStatus::derived;
        apply_choices(number.row, published_.choices);
        numbers_.push_back(std::move(number));
    }

    std::uint64_t batches() const { return (dataset_.triangles + batch_triangles - 1) / batch_triangles; }

    const PeelingNumber& number_of(PeelingColumn column) const { return numbers_[static_cast<std::size_t>(column)]; }

    const PublishedPeeling& published_;
    const PeelingMeasurement& measured_;
    const PeelingDataset& dataset_;
    std::vector<PeelingNumber> numbers_;
};

struct PeelingJob {
    std::size_t row = 0;
    std::uint64_t triangles = 0;
};

std::vector<PeelingJob> jobs_of(const PublishedPeeling& published, PeelingFidelity fidelity) {
    std::vector<PeelingJob> jobs;
    for (std::size_t row = 0; row < published.rows.size(); ++row) {
        const PeelingDataset& dataset = published.dataset(published.rows[row].dataset);
        for (const std::uint64_t size : peeling_sizes(dataset, fidelity)) jobs.push_back({row, size});
    }
    return jobs;
}

} // namespace

ValidationRow published_peeling_row(const PublishedPeeling& published, const PeelingMeasurement& measured,
                                    PeelingColumn column) {
    ValidationRow row = named_row(published, measured, column_name(column));
    const PrintedNumber& printed = measured.fps[static_cast<std::size_t>(column)];
    row.low = row.high = printed.value;
    row.sigma = printed.sigma();
    for (const PeelingStep& step : published.calibrated)
        if (step.dataset == measured.dataset && step.buffer == measured.buffer && step.column == column) {
            row.status = RowStatus::calibrated;
            row.parameter = step.parameter;
        }
    if (const PeelingNote* note = find_note(published.repeats, measured, column_name(column))) {
        row.status = RowStatus::derived;
        row.source = note->text;
    }
    apply_choices(row, published.choices);
    return row;
}

std::vector<std::uint64_t> peeling_sizes(const PeelingDataset& dataset, PeelingFidelity fidelity) {
    if (fidelity == PeelingFidelity::detailed && dataset.detailed) return {dataset.triangles};
    return dataset.sizes;
}

std::vector<PeelingNumber> peeling_numbers(const PublishedPeeling& published, const PeelingMeasurement& row,
                                           const std::vector<StandInRun>& runs) {
    return RowNumbers(published, row, runs).take();
}

ErrorSummary summarise_peeling(std::vector<PeelingNumber>& numbers) {
    std::vector<ValidationRow> rows;
    std::vector<PeelingCell> cells;
    for (const PeelingNumber& number : numbers) {
        rows.push_back(number.row);
        cells.push_back({number.mesh, number.passes, number.batches});
    }
    apply_peeling_null_model(rows, cells);
    for (std::size_t i = 0; i < rows.size(); ++i) numbers[i].row.null_model = rows[i].null_model;
    return summarise(rows).front();
}

PeelingValidation validate_peeling(const PublishedPeeling& published, const PeelingOptions& options) {
    const std::vector<PeelingJob> jobs = jobs_of(published, options.fidelity);
    std::vector<StandInRun> runs(jobs.size());
    std::size_t done = 0;
    std::mutex mutex;
    pipeline::parallel_for(options.threads, jobs.size(), [&](std::size_t i) {
        runs[i] = run_stand_in(published, published.rows[jobs[i].row], jobs[i].triangles, {}, options.stop);
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(jobs.size()));
    });
    PeelingValidation validation;
    validation.source = published.source;
    validation.gpu = published.gpu;
    validation.fidelity = options.fidelity;
    for (std::size_t row = 0; row < published.rows.size(); ++row) {
        std::vector<StandInRun> of_row;
        for (std::size_t i = 0; i < jobs.size(); ++i)
            if (jobs[i].row == row) of_row.push_back(runs[i]);
        for (PeelingNumber& number : peeling_numbers(published, published.rows[row], of_row))
            validation.numbers.push_back(std::move(number));
    }
    for (const StandInRun& run : runs) validation.host_seconds += run.host_seconds;
    validation.summary = summarise_peeling(validation.numbers);
    return validation;
}

} // namespace reports
