#include "reports/html/sections.hpp"

#include "reports/counter_rows.hpp"
#include "reports/flatten.hpp"
#include "reports/html/markup.hpp"
#include "reports/left_out.hpp"
#include "reports/numbers.hpp"
#include "reports/run_numbers.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace reports {

using pipeline::RunResult;

namespace {

HtmlCell number(std::uint64_t value) { return {with_commas(value), "number"}; }
HtmlCell number(const std::string& text) { return {text, "number"}; }
HtmlCell error_number(std::uint64_t value) { return {with_commas(value), value > 0 ? "number bad" : "number"}; }

std::vector<HtmlCell> summary_row(const RunResult& run, const RunResult& first) {
    const pipeline::HazardCounts& hazards = run.hazards;
    const auto dram = bytes_per_fragment(run, "dram");
    const double relative = run.cycles > 0 && first.cycles > 0 ? milliseconds(first) / milliseconds(run) : 0.0;
    return {{run.design, "name"},
            number(run.cycles),
            number(fmt::format("{:.3f}", milliseconds(run))),
            number(short_number(frames_per_second(run))),
            number(fmt::format("{:.2f}", relative)),
            number(run.fragments),
            error_number(hazards.h1),
            error_number(hazards.h2),
            error_number(hazards.h3),
            error_number(hazards.h4),
            number(short_number(hazards_per_million(run))),
            {with_commas(run.wrong_pixels), run.wrong_pixels > 0 ? "number bad" : "number good"},
            error_number(run.lost_fragments),
            number(dram ? fmt::format("{:.1f}", *dram) : "-"),
            number(short_number(cycles_per_second(run)))};
}

std::string figure(const PictureFile& picture, bool magnified) {
    const std::string path = escape_html(picture.file.generic_string());
    return fmt::format("<figure{2}><a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\" loading=\"lazy\"></a>"
                       "<figcaption>{1}</figcaption></figure>\n",
                       path,
                       escape_html(picture.subject.empty() ? picture.title : picture.subject + ": " + picture.title),
                       magnified ? " class=\"magnified\"" : "");
}

std::string grid(const std::string& figures) { return "<div class=\"pictures\">\n" + figures + "</div>\n"; }

std::string figures_of(const Comparison& comparison, const std::vector<PictureFile>& pictures,
                       const std::string& subject, bool layers) {
    // Small frames are enlarged with sharp pixels; shrunken ones must be smoothed, or single pixels would vanish.
    const bool magnified = comparison.width() < 256;
    std::string html;
    for (const PictureFile& picture : pictures)
        if (picture.subject == subject && picture.layer == layers) html += figure(picture, magnified);
    return html;
}

} // namespace

std::string summary_section(const Comparison& comparison) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const RunResult& run : comparison.runs) rows.push_back(summary_row(run, comparison.runs.front()));
    return html_table({"design", "core cycles", "time [ms]", "frames/s", "relative speed", "fragments", "H1", "H2",
                       "H3", "H4", "hazards per million", "wrong pixels", "lost fragments", "DRAM bytes per fragment",
                       "host cycles/s"},
                      rows) +
           "<p class=\"note\">H1: the predecessor was still in flight. H2: it was in the write path. H3: the texture "
           "cache line was stale. H4: the render targets of one read held different versions. Wrong pixels differ in "
           "any bit from the frame computed in submission order; lost fragments are entries of that frame which no "
           "layer holds.</p>\n";
}

std::string pictures_section(const Comparison& comparison, const std::vector<PictureFile>& pictures) {
    if (pictures.empty()) return "<p>This comparison was made without pictures.</p>\n";
    std::string html =
        "<h3>reference and depth complexity</h3>\n" +
        grid(figures_of(comparison, pictures, "reference", false) + figures_of(comparison, pictures, "", false));
    const std::string layers = figures_of(comparison, pictures, "reference", true);
    if (!layers.empty()) html += html_details("layers of the reference", grid(layers));
    for (const RunResult& run : comparison.runs) {
        html += fmt::format("<h3>{}</h3>\n{}", escape_html(run.design),
                            grid(figures_of(comparison, pictures, run.design, false)));
        const std::string own_layers = figures_of(comparison, pictures, run.design, true);
        if (!own_layers.empty()) html += html_details("layers of " + run.design, grid(own_layers));
    }
    return html;
}

std::string passes_section(const Comparison& comparison) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const RunResult& run : comparison.runs)
        for (const pipeline::PassResult& pass : run.passes)
            rows.push_back({{run.design, "name"}, {pass.name, ""}, number(pass.first_cycle), number(pass.cycles)});
    return html_table({"design", "pass", "first cycle", "cycles"}, rows);
}

std::string needs_section(const Comparison& comparison) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const LeftOutEntry& entry : left_out_entries(comparison))
        rows.push_back({{entry.unit, "name"},
                        {entry.by_all ? "all" : fmt::format("{}", fmt::join(entry.designs, ", ")), ""},
                        {entry.reason, ""}});
    std::string html = html_table({"left out", "by", "because"}, rows);
    for (const RunResult& run : comparison.runs)
        html += fmt::format("<p><b>{}</b> was built of: {}.</p>\n", escape_html(run.design),
                            escape_html(fmt::format("{}", fmt::join(run.built, ", "))));
    return html;
}

std::string counters_section(const Comparison& comparison) {
    std::string html;
    for (const RunResult& run : comparison.runs) {
        std::vector<std::vector<HtmlCell>> rows;
        for (const CounterRow& row : counter_rows(run))
            rows.push_back({{row.stage, "name"},
                            {row.kind, ""},
                            {row.name, ""},
                            number(row.value),
                            {row.unit, ""},
                            {row.meaning, ""}});
        html += html_details("all counters of " + run.design,
                             html_table({"stage", "", "name", "value", "unit", "meaning"}, rows));
    }
    return html;
}

std::string parameters_section(const Comparison& comparison) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const auto& [path, value] : flatten(comparison.gpu.parameters)) {
        const auto origin = comparison.gpu.origins.find(path);
        const bool known = origin != comparison.gpu.origins.end();
        rows.push_back({{path, "name"},
                        number(cell_text(value)),
                        {known ? origin->second.origin : "default", ""},
                        {known ? origin->second.source : "", ""},
                        {known ? origin->second.note : "", ""}});
    }
    return html_details("every parameter of " + comparison.gpu.name,
                        html_table({"parameter", "value", "origin", "source", "note"}, rows));
}

} // namespace reports
