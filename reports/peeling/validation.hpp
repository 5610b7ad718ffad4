// The model of depth peeling beside what was published, number by number.
#pragma once

#include "reports/peeling/stand_in.hpp"
#include "reports/validation/validation_row.hpp"

#include <functional>
#include <string>
#include <vector>

namespace reports {

enum class PeelingFidelity : std::uint8_t {
    sampled, ///< every mesh through its stand-ins
    detailed ///< those that can be run are run whole, the others through their stand-ins
};

/// A number of the table, or one that follows from its row.
struct PeelingNumber {
    ValidationRow row;
    std::string mesh;
    double passes = 0;      ///< geometry passes of a frame: k of MP, 1 of SP; 0: not a number of these columns
    double batches = 0;     ///< of SPwH; 0: not a number of this column
    double uncertainty = 0; ///< share by which the line through the stand-ins may miss; 0: run whole
};

struct PeelingValidation {
    std::string source, gpu;
    PeelingFidelity fidelity = PeelingFidelity::sampled;
    std::vector<PeelingNumber> numbers; ///< by row of the table; its columns, then what follows from them
    ErrorSummary summary;
    double host_seconds = 0; ///< of all runs, one after the other
};

struct PeelingOptions {
    PeelingFidelity fidelity = PeelingFidelity::sampled;
    unsigned threads = 1;
    const std::atomic<bool>* stop = nullptr;
    std::function<void(double)> progress; ///< share done, 0 to 1; never called by two threads at once
};

/// Triangles of the stand-ins of a dataset; of the whole mesh alone where it is run.
std::vector<std::uint64_t> peeling_sizes(const PeelingDataset& dataset, PeelingFidelity fidelity);

/// A number of the table as it was printed, with its status, without the model.
ValidationRow published_peeling_row(const PublishedPeeling& published, const PeelingMeasurement& row,
                                    PeelingColumn column);

/// The numbers of one row of the table, from the runs of its dataset's stand-ins or of the whole mesh; without what the
/// null model says.
std::vector<PeelingNumber> peeling_numbers(const PublishedPeeling& published, const PeelingMeasurement& row,
                                           const std::vector<StandInRun>& runs);

/// Sets what the null model says of the numbers of all rows, and sums up.
ErrorSummary summarise_peeling(std::vector<PeelingNumber>& numbers);

PeelingValidation validate_peeling(const PublishedPeeling& published, const PeelingOptions& options);

} // namespace reports

template <>
struct sim::EnumNames<reports::PeelingFidelity> {
    static constexpr std::array<std::string_view, 2> names{"sampled", "detailed"};
};
