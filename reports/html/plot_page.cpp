#include "reports/html/plot_page.hpp"

#include "reports/html/markup.hpp"
#include "ropsim_chart_js.hpp"
#include "ropsim_page_css.hpp"
#include "ropsim_plots_js.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

namespace {

nlohmann::ordered_json plot_json(const Plot& plot) {
    nlohmann::ordered_json lines = nlohmann::ordered_json::array();
    for (const PlotLine& line : plot.lines) lines.push_back({{"name", line.name}, {"values", line.values}});
    return {
        {"title", plot.title}, {"x", plot.x_title},       {"y", plot.y_title},     {"logarithmic", plot.logarithmic},
        {"bars", plot.bars},   {"tornado", plot.tornado}, {"labels", plot.labels}, {"lines", std::move(lines)}};
}

} // namespace

std::string plot_page(std::string_view title, std::string_view intro, const std::vector<Plot>& plots,
                      const std::vector<PageSection>& sections) {
    std::string html = fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
                                   "<meta name=\"viewport\" content=\"width=device-width\">\n"
                                   "<title>ropsim: {0}</title>\n<style>\n{1}</style></head><body>\n<h1>{0}</h1>\n{2}"
                                   "<section id=\"charts\" hidden><div class=\"charts\"></div></section>\n",
                                   escape_html(title), ropsim_build::page_css, intro);
    for (const PageSection& section : sections)
        html += fmt::format("<section><h2>{}</h2>\n{}</section>\n", escape_html(section.title), section.html);
    nlohmann::ordered_json data = nlohmann::ordered_json::array();
    for (const Plot& plot : plots) data.push_back(plot_json(plot));
    return html + fmt::format("<script>{}</script>\n<script id=\"data\" type=\"application/json\">{}</script>\n"
                              "<script>\n{}</script>\n</body></html>\n",
                              ropsim_build::chart_js, script_json(data), ropsim_build::plots_js);
}

} // namespace reports
