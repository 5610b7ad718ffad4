// A comparison as a folder: result.json, CSV tables, report.html and pictures.
#pragma once

#include "reports/comparison_result.hpp"

#include <atomic>
#include <filesystem>
#include <string>

namespace reports {

struct ReportOptions {
    bool images = true;
    const std::atomic<bool>* stop = nullptr; ///< becomes true: sim::Interrupted is thrown between two files
};

/// What is known before anything was computed: that `directory` can be written to and that pictures can be made. Throws
/// sim::InputError.
void check_report_folder(const std::filesystem::path& directory, const ReportOptions& options);

/// Writes everything, each file complete or not at all, and says so in one line. report.html comes last: when it is
/// there, all it points to is.
std::string write_report(const Comparison& comparison, const std::filesystem::path& directory,
                         const ReportOptions& options);

} // namespace reports
