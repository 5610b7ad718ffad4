// report.html: one self-contained page (style, script and numbers inside; pictures by relative path).
#pragma once

#include "reports/comparison_result.hpp"
#include "reports/picture_files.hpp"

#include <string>
#include <vector>

namespace reports {

/// `pictures` may be empty; `tables` are the names of the CSV files beside the page. Without JavaScript the page has
/// all tables and no charts.
std::string html_page(const Comparison& comparison, const std::vector<PictureFile>& pictures,
                      const std::vector<std::string>& tables);

} // namespace reports
