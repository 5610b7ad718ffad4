#include "reports/html/sections.hpp"

#include "reports/counter_rows.hpp"
#include "reports/flatten.hpp"
#include "reports/hazard_text.hpp"
#include "reports/html/markup.hpp"
#include "reports/left_out.hpp"
#include "reports/numbers.hpp"
#include "reports/run_numbers.hpp"
#include "reports/surface_text.hpp"
#include "reports/wrong_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

namespace reports {

using pipeline::RunResult;

namespace {

HtmlCell number(std::uint64_t value) { return {with_commas(value), "number"}; }
HtmlCell number(const std::string& text) { return {text, "number"}; }
HtmlCell error_number(std::uint64_t value) { return {with_commas(value), value > 0 ? "number bad" : "number"}; }

std::vector<HtmlCell> summary_row(const RunResult& run, const std::string& label, const RunResult& base) {
    const pipeline::HazardCounts& hazards = run.hazards;
    const auto dram = bytes_per_fragment(run, "dram"), area = on_chip_bytes(run);
    const double relative = run.cycles > 0 && base.cycles > 0 ? milliseconds(base) / milliseconds(run) : 0.0;
    return {{label, "name"},
            number(run.cycles),
            number(fmt::format("{:.3f}", milliseconds(run))),
            number(fmt::format("{:.2f}", relative)),
            error_number(hazards.of(pipeline::HazardKind::concurrency)),
            error_number(hazards.of(pipeline::HazardKind::incoherence)),
            {with_commas(run.wrong_pixels), run.wrong_pixels > 0 ? "number bad" : "number good"},
            number(area ? fmt::format("{:.1f}", *area / 1024) : "-"),
            number(dram ? fmt::format("{:.1f}", *dram) : "-"),
            number(run.fragments),
            error_number(hazards.total()),
            number(short_number(hazards_per_million(run))),
            error_number(run.lost_fragments),
            error_number(run.lost_updates),
            number(short_number(frames_per_second(run))),
            number(short_number(cycles_per_second(run))),
            number(short_number(cycles_per_cpu_second(run)))};
}

std::string wrong_list(const Comparison& comparison) {
    std::string html;
    for (const std::string& line : wrong_lines(comparison)) html += fmt::format("<li>{}</li>", escape_html(line));
    return html.empty() ? "" : "<ul class=\"note\">" + html + "</ul>\n";
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
    const RunResult& base = comparison.runs.at(comparison.base_run());
    for (std::size_t i = 0; i < comparison.runs.size(); ++i)
        rows.push_back(summary_row(comparison.runs[i], comparison.variants.at(i).label, base));
    return html_table({"design", "core cycles", "time [ms]", "relative speed", "hazards by concurrency",
                       "hazards by incoherence", "wrong pixels", "on chip [KiB]", "DRAM bytes per fragment",
                       "fragments", "hazards", "hazards per million", "lost fragments", "lost updates", "frames/s",
                       "host cycles/s", "CPU cycles/s"},
                      rows) +
           wrong_list(comparison) +
           fmt::format("<p class=\"note\">Speed is relative to {}. Wrong pixels differ in any bit from the frame "
                       "computed in submission order; lost fragments are entries of that frame which no layer holds; "
                       "a lost update was overwritten by a stale value. On chip: tile caches, payloads that wait, and "
                       "what the design adds.</p>\n",
                       escape_html(comparison.variants.at(comparison.base_run()).label));
}

std::string hazards_section(const Comparison& comparison) {
    std::vector<std::vector<HtmlCell>> rows;
    for (std::size_t i = 0; i < comparison.runs.size(); ++i)
        for (const auto kind : {pipeline::HazardKind::concurrency, pipeline::HazardKind::incoherence}) {
            const RunResult& run = comparison.runs[i];
            if (run.hazards.total() == 0) continue;
            std::vector<HtmlCell> row{{comparison.variants.at(i).label, "name"}, {std::string(hazard_name(kind)), ""}};
            for (const auto& cells : run.hazards.by) row.push_back(number(cells[static_cast<std::size_t>(kind)]));
            row.push_back(error_number(run.hazards.of(kind)));
            row.push_back(number(short_number(hazards_per_million(run, kind))));
            rows.push_back(std::move(row));
        }
    if (rows.empty()) return "<p>No design had a hazard.</p>\n";
    return html_table({"design", "kind", "H1 in flight", "H2 write path", "H3 stale line", "H4 torn read", "total",
                       "per million fragments"},
                      rows) +
           fmt::format("<p class=\"note\">{} {}</p>\n", hazard_kinds_explained, hazard_classes_explained);
}

std::string area_section(const Comparison& comparison) {
    std::vector<std::vector<HtmlCell>> rows;
    for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
        const nlohmann::ordered_json& area = comparison.runs[i].area;
        if (!area.contains("total_bytes")) continue;
        std::string added;
        for (const auto& memory : area.at("added").items())
            added += fmt::format("{}{}: {}", added.empty() ? "" : ", ", memory.key(),
                                 with_commas(memory.value().get<std::uint64_t>()));
        const auto bytes = [&area](const char* name) { return number(area.at(name).get<std::uint64_t>()); };
        rows.push_back({{comparison.variants.at(i).label, "name"},
                        bytes("tile_cache_bytes"),
                        bytes("payload_bytes"),
                        bytes("added_bytes"),
                        bytes("total_bytes"),
                        {added.empty() ? "nothing" : added, ""},
                        bytes("added_comparators"),
                        bytes("added_alu_lanes")});
    }
    if (comparison.equal_area)
        for (const EqualArea::Unfit& unfit : comparison.equal_area->does_not_fit)
            rows.push_back({{unfit.variant.label, "name"},
                            {"does not fit", "bad"},
                            {},
                            {},
                            {with_commas(unfit.needed), "number bad"},
                            {"needed with the smallest tile caches", ""},
                            {},
                            {}});
    const std::string equal =
        comparison.equal_area
            ? fmt::format("<p>Every design has {}; its tile caches have what is left beside all else.</p>\n",
                          counted(comparison.equal_area->bytes, "byte"))
            : "";
    return equal + html_table({"design", "tile caches [B]", "payloads [B]", "added [B]", "total [B]",
                               "what is added [B]", "comparators", "ALU lanes"},
                              rows);
}

std::string pictures_section(const Comparison& comparison, const std::vector<PictureFile>& pictures) {
    if (pictures.empty()) return "<p>This comparison was made without pictures.</p>\n";
    std::string html =
        "<h3>reference and depth complexity</h3>\n" +
        grid(figures_of(comparison, pictures, "reference", false) + figures_of(comparison, pictures, "", false));
    const std::string layers = figures_of(comparison, pictures, "reference", true);
    if (!layers.empty()) html += html_details("layers of the reference", grid(layers));
    for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
        const RunResult& run = comparison.runs[i];
        html += fmt::format("<h3>{}</h3>\n{}", escape_html(comparison.variants.at(i).label),
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

std::string surfaces_section(const Comparison& comparison) {
    std::vector<std::vector<HtmlCell>> rows;
    for (const SurfaceRow& row : surface_rows(comparison))
        rows.push_back(
            {{row.name, "name"}, {row.content, ""}, {row.size, ""}, number(row.nominal), number(row.high_water)});
    return html_table({"surface", "content", "size [pixels]", "whole [bytes]", "written at once [bytes]"}, rows) +
           "<p class=\"note\">A surface takes memory where something wrote to it, in pages of 16 x 16 pixels: the most "
           "that were written to at any time, in any design.</p>\n";
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
