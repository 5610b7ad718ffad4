#include "reports/peeling/validation.hpp"

#include "pipeline/functional/parallel.hpp"
#include "sim/check.hpp"

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

class RowNumbers {
  public:
    RowNumbers(const PublishedPeeling& published, const PeelingMeasurement& row, const std::vector<StandInRun>& runs)
        : published_(published), measured_(row), dataset_(published.dataset(row.dataset)) {
        CHECK(!runs.empty());
        for (std::size_t i = 0; i < peeling_columns; ++i) add_column(static_cast<PeelingColumn>(i), runs);
        add_ratio(PeelingColumn::sp, PeelingColumn::mp);
        add_ratio(PeelingColumn::sp, PeelingColumn::spwh);
        add_ratio(PeelingColumn::mp, PeelingColumn::spwh);
        add_batch_time();
    }
    std::vector<PeelingNumber> take() && { return std::move(numbers_); }

  private:
    PeelingNumber blank(const std::string& name) const {
        PeelingNumber number;
        number.row.table = "T6.1";
        number.row.row = fmt::format("{}, {}, {}", measured_.dataset, measured_.buffer, name);
        number.row.gpu = published_.gpu;
        if (const PeelingNote* note = find_note(published_.explanations, measured_, name))
            number.row.explanation = note->text;
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
        PeelingNumber number = blank(column_name(column));
        const PrintedNumber& printed = measured_.fps[i];
        number.printed = printed.value;
        number.half_digit = printed.half_digit;
        number.row.low = printed.low();
        number.row.high = printed.high();
        number.row.model = 1e3 / whole.value;
        number.uncertainty = whole.error;
        if (const PeelingNote* note = find_note(published_.calibrated, measured_, column_name(column))) {
            number.row.status = RowStatus::calibrated;
            number.row.parameter = note->parameter;
        }
        numbers_.push_back(std::move(number));
    }

    void add_ratio(PeelingColumn over, PeelingColumn under) {
        const PeelingNumber &a = number_of(over), &b = number_of(under);
        PeelingNumber number = blank(fmt::format("{}/{}", column_name(over), column_name(under)));
        number.row.unit = "ratio";
        number.row.origin = PublishedOrigin::derived;
        number.row.source = "quotient of two printed numbers";
        number.printed = a.printed / b.printed;
        number.row.low = a.row.low / b.row.high;
        number.row.high = a.row.high / b.row.low;
        number.row.model = a.row.model / b.row.model;
        number.uncertainty = a.uncertainty + b.uncertainty;
        numbers_.push_back(std::move(number));
    }

    void add_batch_time() {
        const PeelingNumber& frames = number_of(PeelingColumn::spwh);
        const std::uint64_t batches = (dataset_.triangles + batch_triangles - 1) / batch_triangles;
        const double us = 1e6 / static_cast<double>(batches);
        PeelingNumber number = blank("batch");
        number.row.unit = "us";
        number.row.origin = PublishedOrigin::derived;
        number.row.source = "a frame with heuristics over its batches of 32 triangles";
        number.printed = us / frames.printed;
        number.row.low = us / frames.row.high;
        number.row.high = us / frames.row.low;
        number.row.model = us / frames.row.model;
        number.uncertainty = frames.uncertainty;
        numbers_.push_back(std::move(number));
    }

    const PeelingNumber& number_of(PeelingColumn column) const { return numbers_[static_cast<std::size_t>(column)]; }

    const PublishedPeeling& published_;
    const PeelingMeasurement& measured_;
    const PeelingDataset& dataset_;
    std::vector<PeelingNumber> numbers_;
};

struct Job {
    std::size_t row = 0;
    std::uint64_t triangles = 0;
};

std::vector<Job> jobs_of(const PublishedPeeling& published, PeelingFidelity fidelity) {
    std::vector<Job> jobs;
    for (std::size_t row = 0; row < published.rows.size(); ++row) {
        const PeelingDataset& dataset = published.dataset(published.rows[row].dataset);
        if (fidelity == PeelingFidelity::detailed && dataset.detailed)
            jobs.push_back({row, dataset.triangles});
        else
            for (const std::uint64_t size : dataset.sizes) jobs.push_back({row, size});
    }
    return jobs;
}

} // namespace

std::vector<PeelingNumber> peeling_numbers(const PublishedPeeling& published, const PeelingMeasurement& row,
                                           const std::vector<StandInRun>& runs) {
    return RowNumbers(published, row, runs).take();
}

PeelingValidation validate_peeling(const PublishedPeeling& published, const PeelingOptions& options) {
    const std::vector<Job> jobs = jobs_of(published, options.fidelity);
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
    std::vector<ValidationRow> rows;
    for (std::size_t row = 0; row < published.rows.size(); ++row) {
        std::vector<StandInRun> of_row;
        for (std::size_t i = 0; i < jobs.size(); ++i)
            if (jobs[i].row == row) of_row.push_back(runs[i]);
        for (PeelingNumber& number : peeling_numbers(published, published.rows[row], of_row)) {
            rows.push_back(number.row);
            validation.numbers.push_back(std::move(number));
        }
    }
    for (const StandInRun& run : runs) validation.host_seconds += run.host_seconds;
    validation.summary = summarise(rows).back();
    return validation;
}

} // namespace reports
