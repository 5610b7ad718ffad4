// A page of plots and tables.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace reports {

struct PlotLine {
    std::string name;
    std::vector<double> values; ///< one per label
};

struct Plot {
    std::string title, x_title, y_title;
    bool logarithmic = false; ///< along x, where all labels are numbers
    bool bars = false;
    bool tornado =
        false; ///< horizontal bars from 0, one label a row, the lines over each other; x_title names the axis
    std::vector<std::string> labels;
    std::vector<PlotLine> lines;
};

struct PageSection {
    std::string title;
    std::string html;
};

/// @param intro HTML below the heading
std::string plot_page(std::string_view title, std::string_view intro, const std::vector<Plot>& plots,
                      const std::vector<PageSection>& sections);

} // namespace reports
