#include "cli/measuring.hpp"

#include "cli/options.hpp"
#include "reports/atomic_file.hpp"
#include "reports/result.hpp"
#include "sim/check.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cli {

Measuring::Measuring(const std::string& fidelity, const std::string& threads) {
    options_.fidelity = fidelity_of(fidelity);
    options_.threads = threads_of(threads);
    options_.stop = &stop_requested();
    line_.emplace();
    reports::enter({options_.stop, line_->progress(), nullptr}, reports::Progress::Phase::measuring);
    if (reports::Progress* progress = line_->progress()) {
        progress->phase = reports::Progress::Phase::measuring;
        options_.progress = [progress](double share) { progress->share = share; };
    }
}

std::string write_tables(const std::string& directory, const std::string& document_name,
                         const nlohmann::ordered_json& document, const std::vector<reports::Table>& tables,
                         const std::string& page, bool already_begun) {
    const std::filesystem::path folder(directory);
    if (!already_begun) reports::begin_report_folder(folder);
    std::string names = document_name;
    for (const reports::Table& table : tables) {
        reports::write_file(folder / table.name, table.text());
        names += ", " + table.name;
    }
    reports::write_file(folder / document_name, reports::result_text(document));
    if (!page.empty()) {
        reports::write_file(folder / "report.html", page);
        names += ", report.html";
    }
    return fmt::format("Written to {}: {}\n", directory, names);
}

void check_peeling_gpus(const std::string& gpus, const std::string& measured) {
    for (const std::string& name : list_of(gpus))
        if (name != measured)
            throw sim::InputError(fmt::format("--gpus: '{}' was not measured; expected {}", name, measured));
}

} // namespace cli
