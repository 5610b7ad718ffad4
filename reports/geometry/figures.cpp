#include "reports/geometry/figures.hpp"

#include "pipeline/functional/parallel.hpp"
#include "reports/toml_reader.hpp"
#include "sim/check.hpp"

#include <algorithm>
#include <compare>
#include <fmt/format.h>
#include <mutex>
#include <set>

namespace reports {

namespace {

constexpr const char* file = "reports/published/figures.toml";

PublishedInterval interval_of(TomlTable& table, const toml::node& node) {
    if (const auto number = node.value<double>()) return {*number, *number};
    const toml::array* bounds = node.as_array();
    const bool two_numbers =
        bounds != nullptr && bounds->size() == 2 && bounds->get(0)->is_number() && bounds->get(1)->is_number();
    if (!two_numbers) table.expected("published", "numbers, or intervals [least, most]");
    const PublishedInterval interval{*bounds->get(0)->value<double>(), *bounds->get(1)->value<double>()};
    if (interval.high < interval.low) table.expected("published", "intervals [least, most]");
    return interval;
}

PublishedFigure figure_of(TomlTable& table) {
    PublishedFigure figure;
    figure.table = table.text("table");
    figure.row = table.text("row");
    figure.curve.study = table.text("study");
    figure.curve.series = table.text("series");
    figure.curve.over = table.text_or("over", "");
    figure.curve.measure = table.text("measure");
    const std::vector<std::string>& measures = study_measures();
    if (std::find(measures.begin(), measures.end(), figure.curve.measure) == measures.end())
        table.expected("measure", fmt::format("one of {}", fmt::join(measures, ", ")));
    figure.curve.points = table.texts("points");
    figure.reading = choice<CurveReading>(table, "reading", sim::EnumNames<CurveReading>::names);
    if ((figure.reading == CurveReading::value) != (figure.curve.points.size() == 1))
        table.expected("points", "one point with reading = \"value\", else several, or none for all of the study");
    figure.unit = table.text_or("unit", "ratio");
    figure.origin = choice<PublishedOrigin>(table, "origin", sim::EnumNames<PublishedOrigin>::names);
    figure.source = table.text("source");
    table.entries("published", [&](const std::string& gpu, const toml::node& node) {
        figure.by_gpu[gpu] = interval_of(table, node);
    });
    table.entries("explanations", [&](const std::string& gpu, const toml::node& node) {
        figure.explanations[gpu] = text_of_node(node);
    });
    return figure;
}

/// Values of studies that figures need, each measured once.
class Curves {
  public:
    Curves(const std::vector<PublishedFigure>& figures, const std::vector<std::string>& gpus) {
        for (const PublishedFigure& figure : figures)
            for (const std::string& gpu : gpus)
                if (figure.by_gpu.contains(gpu)) want(figure.curve, gpu);
    }

    void measure(const GeometryRunOptions& options) {
        std::size_t done = 0;
        std::mutex mutex;
        std::vector<std::map<Cell, std::vector<StudyValue>>::iterator> list;
        for (auto cell = cells_.begin(); cell != cells_.end(); ++cell) list.push_back(cell);
        pipeline::parallel_for(options.threads, list.size(), [&](std::size_t i) {
            const Cell& cell = list[i]->first;
            const std::set<std::string>& gpus = gpus_.at(cell);
            const Study& study = studies_.at(cell.study);
            list[i]->second = run_series(study, series_of(study, cell.series), point_of(study, cell.x),
                                         {gpus.begin(), gpus.end()}, options);
            const std::lock_guard lock(mutex);
            ++done;
            if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(list.size()));
        });
    }

    std::vector<std::string> points_of(const StudyCurve& curve) const {
        if (!curve.points.empty()) return curve.points;
        std::vector<std::string> points;
        for (const auto& point : studies_.at(curve.study).points) points.push_back(point.at("x"));
        return points;
    }

    const StudyValue& at(const StudyCurve& curve, const std::string& series, const std::string& x,
                         const std::string& gpu) const {
        const std::vector<StudyValue>& values = cells_.at({curve.study, series, x});
        return *std::find_if(values.begin(), values.end(),
                             [&gpu](const StudyValue& value) { return value.gpu == gpu; });
    }

  private:
    struct Cell {
        std::string study, series, x;
        // NOLINTNEXTLINE(modernize-use-nullptr): the 0 that a comparison of three ways is held against
        friend auto operator<=>(const Cell&, const Cell&) = default;
    };

    static const StudySeries& series_of(const Study& study, const std::string& name) {
        for (const StudySeries& series : study.series)
            if (series.name == name) return series;
        throw sim::InputError(fmt::format("{}: study {} has no series '{}'", file, study.name, name));
    }

    static const std::map<std::string, std::string>& point_of(const Study& study, const std::string& x) {
        for (const auto& point : study.points)
            if (point.at("x") == x) return point;
        throw sim::InputError(fmt::format("{}: study {} has no point x = {}", file, study.name, x));
    }

    void want(const StudyCurve& curve, const std::string& gpu) {
        if (!studies_.contains(curve.study)) studies_[curve.study] = load_study(curve.study);
        for (const std::string& x : points_of(curve))
            for (const std::string& series : {curve.series, curve.over}) {
                if (series.empty()) continue;
                const Cell cell{curve.study, series, x};
                cells_[cell];
                gpus_[cell].insert(gpu);
            }
    }

    std::map<std::string, Study> studies_;
    std::map<Cell, std::set<std::string>> gpus_;
    std::map<Cell, std::vector<StudyValue>> cells_; ///< by GPU
};

ValidationRow row_of(const PublishedFigure& figure, const std::string& gpu, const Curves& curves) {
    const StudyCurve& curve = figure.curve;
    std::vector<double> x, y;
    for (const std::string& point : curves.points_of(curve)) {
        x.push_back(std::stod(point));
        y.push_back(measure_of(curves.at(curve, curve.series, point, gpu), curve.measure));
        if (!curve.over.empty()) y.back() /= measure_of(curves.at(curve, curve.over, point, gpu), curve.measure);
    }
    ValidationRow row;
    row.table = figure.table;
    row.row = figure.row;
    row.gpu = gpu;
    row.unit = figure.unit;
    row.low = figure.by_gpu.at(gpu).low;
    row.high = figure.by_gpu.at(gpu).high;
    row.model = read_curve(figure.reading, x, y);
    row.origin = figure.origin;
    row.source = figure.source;
    if (const auto text = figure.explanations.find(gpu); text != figure.explanations.end())
        row.explanation = text->second;
    return row;
}

std::vector<double> growths(const std::vector<double>& y) {
    std::vector<double> list;
    for (std::size_t i = 1; i < y.size(); ++i) list.push_back(y[i] / y[i - 1]);
    return list;
}

} // namespace

std::vector<PublishedFigure> load_published_figures() {
    std::vector<PublishedFigure> figures;
    read_data_file(file, [&](TomlTable& root) {
        root.text("source");
        root.tables("figures", [&](TomlTable& table) { figures.push_back(figure_of(table)); });
    });
    return figures;
}

double read_curve(CurveReading reading, const std::vector<double>& x, const std::vector<double>& y) {
    const bool grows = reading == CurveReading::least_growth || reading == CurveReading::greatest_growth;
    CHECK(x.size() == y.size() && y.size() >= (grows ? 2U : 1U));
    switch (reading) {
    case CurveReading::value:
        CHECK(y.size() == 1);
        return y.front();
    case CurveReading::argmax:
        return x[static_cast<std::size_t>(std::max_element(y.begin(), y.end()) - y.begin())];
    case CurveReading::least:
        return *std::min_element(y.begin(), y.end());
    case CurveReading::first_over_last:
        return y.front() / y.back();
    case CurveReading::least_growth:
        return std::ranges::min(growths(y));
    case CurveReading::greatest_growth:
        return std::ranges::max(growths(y));
    }
    return 0;
}

std::vector<ValidationRow> validate_figures(const std::vector<PublishedFigure>& figures, const CalibrationPlan& plan,
                                            const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    Curves curves(figures, gpus);
    curves.measure(options);
    std::vector<ValidationRow> rows;
    for (const PublishedFigure& figure : figures)
        for (const std::string& gpu : gpus) {
            if (!figure.by_gpu.contains(gpu)) continue;
            rows.push_back(row_of(figure, gpu, curves));
            apply_plan(rows.back(), plan);
        }
    return rows;
}

} // namespace reports
