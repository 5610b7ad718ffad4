// ropsim stability: stiff and extreme cases, each beside exact arithmetic.
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/interruption.hpp"
#include "cli/measuring.hpp"
#include "reports/result.hpp"
#include "reports/stability/catalogue.hpp"
#include "reports/stability/conditioning.hpp"
#include "reports/stability/report.hpp"
#include "sim/check.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cli {

void stability(const StabilityCommand& command) {
    namespace stability = reports::stability;
    const bool pictures = !command.directory.empty() && !command.no_images;
    if (pictures) reports::require_images();
    const auto outcomes = stability::run(stability::cases_matching(command.filter), &stop_requested());
    // Curves are of formulas, not of cases: a choice of cases is asked for without them.
    const auto curves = command.filter.empty() ? stability::conditioning_curves() : std::vector<stability::Curve>{};
    const auto document = stability::json_of(outcomes, curves);
    std::string written;
    if (!command.directory.empty()) {
        written = "\n" + write_tables(command.directory, "stability.json", document,
                                      {stability::table_of(outcomes), stability::curves_table(curves)},
                                      stability::page_of(outcomes, curves, pictures));
        if (pictures) {
            for (const auto& [name, picture] : stability::pictures_of(outcomes))
                reports::write_png(std::filesystem::path(command.directory) / name, *picture);
        }
    }
    print(command.json ? reports::result_text(document) : stability::text_of(outcomes, terminal_style()) + written);
    const std::size_t failed = stability::failures(outcomes);
    if (failed > 0) throw sim::InputError(fmt::format("stability: {} of {} cases failed", failed, outcomes.size()));
}

} // namespace cli
