// What geometry, validate, calibrate and study share: how to run, a progress line, and the files they leave.
#pragma once

#include "cli/interruption.hpp"
#include "cli/progress_line.hpp"
#include "reports/csv.hpp"
#include "reports/geometry/validation.hpp"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cli {

/// Shows progress while it lives. Throws sim::InputError for a fidelity or a number of threads that is none.
class Measuring {
  public:
    Measuring(const std::string& fidelity, const std::string& threads);
    const reports::GeometryRunOptions& options() const { return options_; }
    /// Wipes the progress line.
    void end() { line_.reset(); }

  private:
    std::optional<ProgressLine> line_;
    reports::GeometryRunOptions options_;
};

/// Writes a document, tables and, if there is one, a page into `directory`; returns the line that says so. What an
/// earlier run left there is removed, unless the caller has begun the folder and written some of its files.
std::string write_tables(const std::string& directory, const std::string& document_name,
                         const nlohmann::ordered_json& document, const std::vector<reports::Table>& tables,
                         const std::string& page, bool already_begun = false);

/// Throws sim::InputError for a GPU of --gpus other than the one that depth peeling was measured on.
void check_peeling_gpus(const std::string& gpus, const std::string& measured);

} // namespace cli
