#include "reports/surface_text.hpp"

#include "reports/numbers.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace reports {

namespace {

std::string size_text(const pipeline::SurfaceInfo& info) {
    std::string text = fmt::format("{} x {}", info.width, info.height);
    if (info.planes > 1) text += fmt::format(" x {}", info.planes);
    if (info.levels > 1) text += fmt::format(", {} levels", info.levels);
    return text;
}

} // namespace

std::string content_text(const pipeline::SurfaceInfo& info) {
    return info.program ? fmt::format("{}, k = {}", info.program->id(), info.program->k())
                        : std::string(sim::enum_name(info.format));
}

std::vector<SurfaceRow> surface_rows(const Comparison& comparison) {
    std::vector<SurfaceRow> rows;
    for (const pipeline::RunResult& run : comparison.runs)
        for (std::size_t i = 0; i < run.surfaces.size(); ++i) {
            const auto& [info, memory] = run.surfaces[i];
            if (i == rows.size()) rows.push_back({info.name, content_text(info), size_text(info), memory.nominal, 0});
            rows[i].high_water = std::max(rows[i].high_water, memory.high_water);
        }
    return rows;
}

std::string surfaces_text(const Comparison& comparison, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const SurfaceRow& row : surface_rows(comparison))
        rows.push_back({row.name, row.content, row.size, with_commas(row.nominal), with_commas(row.high_water)});
    if (rows.empty()) return "";
    return text_table({{"surface", "", true},
                       {"content", "", true},
                       {"size", "", true},
                       {"whole", "bytes"},
                       {"written at once", "bytes"}},
                      rows, style);
}

} // namespace reports
