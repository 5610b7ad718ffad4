#include "reports/report_files.hpp"

#include "reports/atomic_file.hpp"
#include "reports/csv.hpp"
#include "reports/html/page.hpp"
#include "reports/images.hpp"
#include "reports/numbers.hpp"
#include "reports/picture_files.hpp"
#include "reports/result.hpp"
#include "sim/check.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

namespace fs = std::filesystem;

void check_report_folder(const fs::path& directory, const ReportOptions& options) {
    make_directory(directory);
    if (options.images) require_images();
}

std::string write_report(const Comparison& comparison, const fs::path& directory, const ReportOptions& options) {
    const auto check_stop = [&options] {
        if (options.stop != nullptr && *options.stop) throw sim::Interrupted();
    };
    begin_report_folder(directory);
    std::vector<PictureFile> pictures;
    if (options.images) pictures = write_pictures(comparison, directory, options.stop);
    std::vector<std::string> tables;
    for (const Table& table : all_tables(comparison)) {
        check_stop();
        write_file(directory / table.name, table.text());
        tables.push_back(table.name);
    }
    check_stop();
    write_file(directory / "result.json", result_text(result_json(comparison)));
    write_file(directory / "report.html", html_page(comparison, pictures, tables));
    return fmt::format("Written to {}: report.html, result.json, {} (.csv), {} (.png, .exr for measuring)",
                       directory.string(), counted(tables.size(), "table"), counted(pictures.size(), "picture"));
}

} // namespace reports
