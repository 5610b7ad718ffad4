#include "reports/html/page.hpp"

#include "reports/html/markup.hpp"
#include "reports/html/sections.hpp"
#include "reports/numbers.hpp"
#include "reports/remarks.hpp"
#include "reports/result.hpp"
#include "reports/run_numbers.hpp"
#include "ropsim_chart_js.hpp"
#include "ropsim_page_css.hpp"
#include "ropsim_page_js.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

namespace {

std::string section(std::string_view id, std::string_view title, std::string_view body) {
    return fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, title, body);
}

std::string facts(const Comparison& comparison) {
    const SceneFacts& scene = comparison.scene;
    const pipeline::Frame& frame = *comparison.frame;
    std::string method = escape_html(frame.workload);
    if (frame.program)
        method += fmt::format(", {} with k = {} ({} bytes per pixel)", escape_html(frame.program->id()),
                              frame.program->k(), frame.program->bytes_per_pixel());
    std::string notes;
    for (const std::string& note : remarks(comparison)) notes += fmt::format("<li>{}</li>", escape_html(note));
    if (!notes.empty()) notes = "<p class=\"note\">Notes:</p><ul class=\"note\">" + notes + "</ul>\n";
    return fmt::format("<p><b>{}</b> ({} drawn, draws: {}, hash {}) at {} x {} pixels{}, camera {}. Method: {}. "
                       "GPU: <b>{}</b>. Seed {}.</p>\n<p class=\"note\">ropsim {} ({}); {} on {}, at most {} of "
                       "memory.</p>\n",
                       escape_html(scene.name), counted(scene.triangles_drawn, "triangle"), with_commas(scene.draws),
                       escape_html(scene.hash), comparison.width(), comparison.height(), samples_text(comparison),
                       escape_html(scene.camera), method, escape_html(comparison.gpu.name), comparison.seed,
                       version_text(), escape_html(build_text()), duration_text(comparison.host.seconds),
                       counted(comparison.host.threads, "thread"),
                       bytes_text(static_cast<double>(comparison.host.peak_bytes))) +
           notes;
}

std::string files(const std::vector<std::string>& tables) {
    std::string html = "<p>The same numbers for programs: <a href=\"result.json\">result.json</a>";
    for (const std::string& table : tables) html += fmt::format(", <a href=\"{0}\">{0}</a>", escape_html(table));
    return html + ".</p>\n";
}

} // namespace

std::string html_page(const Comparison& comparison, const std::vector<PictureFile>& pictures,
                      const std::vector<std::string>& tables) {
    std::string html = fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
                                   "<meta name=\"viewport\" content=\"width=device-width\">\n"
                                   "<title>ropsim: {}</title>\n<style>\n{}</style></head><body>\n<h1>{}</h1>\n",
                                   escape_html(comparison.scene.name), ropsim_build::page_css,
                                   "Designs compared on " + escape_html(comparison.scene.name));
    html += facts(comparison);
    html += section("summary", "Summary", summary_section(comparison) + files(tables));
    html += section("hazards", "Hazards", hazards_section(comparison));
    html += section("area", "On chip", area_section(comparison));
    html += "<section id=\"charts\" hidden><h2>Charts</h2><div class=\"charts\"></div></section>\n";
    html += section("pictures", "Pictures", pictures_section(comparison, pictures));
    html += section("passes", "Passes", passes_section(comparison));
    html += section("surfaces", "Surfaces", surfaces_section(comparison));
    html += section("needs", "Built and left out", needs_section(comparison));
    html += section("counters", "Counters", counters_section(comparison));
    html += section("parameters", "Parameters", parameters_section(comparison));
    html += fmt::format("<script>{}</script>\n<script id=\"data\" type=\"application/json\">{}</script>\n"
                        "<script>\n{}</script>\n</body></html>\n",
                        ropsim_build::chart_js, script_json(chart_data(comparison)), ropsim_build::page_js);
    return html;
}

} // namespace reports
