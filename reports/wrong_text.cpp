#include "reports/wrong_text.hpp"

#include "sim/counted.hpp"

#include <fmt/format.h>

namespace reports {

std::vector<std::string> wrong_lines(const Comparison& comparison) {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
        const pipeline::RunResult& run = comparison.runs[i];
        if (run.wrong_pixels == run.wrong_because.hazard) continue;
        std::string reasons;
        for_each_reason(run.wrong_because, [&](std::string_view, std::string_view words, std::uint64_t pixels) {
            if (pixels != 0)
                reasons += fmt::format("{} in {} {}", reasons.empty() ? "" : ",", sim::with_commas(pixels), words);
        });
        lines.push_back(fmt::format("{}: {}:{}", comparison.variants.at(i).label,
                                    sim::counted(run.wrong_pixels, "wrong pixel"), reasons));
    }
    return lines;
}

} // namespace reports
