// Reads the files of studies.
#include "models/kbuffers/library.hpp"
#include "reports/frame_size.hpp"
#include "reports/study.hpp"
#include "reports/toml_reader.hpp"
#include "ropsim_build.hpp"
#include "sim/suggest.hpp"
#include "traces/workloads.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

namespace reports {

namespace fs = std::filesystem;

namespace {

bool has_variable(const std::string& text) { return text.find('{') != std::string::npos; }

void expect_one_of(const TomlTable& table, const std::string& key, const std::string& word,
                   const std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), word) == known.end())
        table.expected(
            key, fmt::format("one of {}; got '{}'{}", fmt::join(known, ", "), word, sim::did_you_mean(word, known)));
}

template <class Rows>
std::vector<std::string> ids_of(const Rows& rows) {
    std::vector<std::string> list;
    for (const auto& row : rows) list.emplace_back(row.id);
    return list;
}

StudySeries series_of(TomlTable& table) {
    StudySeries series;
    series.name = table.text("name");
    series.scene = table.text("scene");
    series.settings = table.texts("settings");
    series.design = table.text_or("design", "");
    if (!series.design.empty()) {
        const std::string id = series.design.substr(0, series.design.find('?'));
        if (!has_variable(id)) expect_one_of(table, "design", id, ids_of(models::designs()));
        return series;
    }
    series.prepare = table.texts("prepare");
    series.submission = table.text_or("submission", "buffers");
    series.reads_all = table.flag_or("reads_all", true);
    return series;
}

const std::map<std::string, std::string>& titles() {
    static const std::map<std::string, std::string> list{
        {"fps", "frames per second"},
        {"ms", "milliseconds"},
        {"vertices_per_s", "vertices per second"},
        {"triangles_per_s", "triangles per second"},
        {"acmr", "vertices shaded per triangle (ACMR)"},
        {"overfetch", "bytes fetched per byte of vertices"},
        {"bytes", "bytes fetched"},
        {"draws", "draw calls"},
        {"hazards.per_million", "hazards per million fragments"},
        {"hazards.concurrency_per_million", "hazards by concurrency per million fragments"},
        {"hazards.incoherence_per_million", "hazards by incoherence per million fragments"},
        {"wrong_share", "wrong pixels over drawn pixels"},
        {"colour_error", "mean colour error of drawn pixels"},
        {"colour_error_worst", "largest colour error"},
        {"frame_change", "mean change of a pixel between runs"},
        {"frame_change_worst", "largest change of a pixel between runs"}};
    return list;
}

StudyMeasure measure_named(const std::string& value) {
    const auto found = titles().find(value);
    return {value, found == titles().end() ? value : found->second, "", false};
}

StudyMeasure measure_of_table(TomlTable& table, const Study& study) {
    StudyMeasure measure = measure_named(table.text("value"));
    measure.title = table.text_or("title", measure.title);
    measure.over = table.text_or("over", "");
    measure.optional = table.flag_or("optional", false);
    std::vector<std::string> names;
    for (const StudySeries& series : study.series) names.push_back(series.name);
    if (!measure.over.empty()) expect_one_of(table, "over", measure.over, names);
    return measure;
}

// One by its name, or a list of tables.
void read_measures(TomlTable& root, Study& study) {
    root.tables("measures", [&](TomlTable& table) { study.measures.push_back(measure_of_table(table, study)); });
    const std::string only = root.text_or("measure", study.measures.empty() ? "fps" : "");
    if (!only.empty()) study.measures.push_back(measure_named(only));
    if (study.of_designs()) return;
    for (const StudyMeasure& measure : study.measures) {
        expect_one_of(root, "measure", measure.value, study_measures());
        if (!measure.over.empty()) root.expected("measures", "over in studies of designs only");
    }
}

void read_frames(TomlTable& root, Study& study) {
    study.size = root.text_or("size", study.size);
    if (!has_variable(study.size) && !frame_size(study.size)) root.expected("size", "WIDTHxHEIGHT");
    study.samples = root.text_or("samples", study.samples);
    if (!has_variable(study.samples) && !sample_count(study.samples)) root.expected("samples", "1, 4 or 8");
    study.workload = root.text_or("workload", study.workload);
    expect_one_of(root, "workload", study.workload, ids_of(traces::workloads()));
    constexpr double most = 1024;
    const double seeds = root.number_or("seeds", 1);
    if (!(seeds >= 1 && seeds <= most)) root.expected("seeds", fmt::format("1 to {}", most));
    study.seeds = static_cast<std::uint32_t>(seeds);
}

void read_series(TomlTable& root, Study& study) {
    root.tables("series", [&](TomlTable& table) { study.series.push_back(series_of(table)); });
    if (study.series.empty()) root.expected("series", "at least one");
    for (const StudySeries& series : study.series)
        if (series.design.empty() == study.of_designs()) root.expected("series", "a design in all of them or in none");
    root.entry_lists("points", [&](const StudyPoint& point) { study.points.push_back(point); });
    if (study.points.empty()) root.expected("points", "at least one");
    for (const StudyPoint& point : study.points)
        if (!point.contains("x")) root.expected("points", "an x in every point");
}

void read_study(TomlTable& root, Study& study) {
    study.title = root.text("title");
    study.question = root.text("question");
    study.answer = root.text_or("answer", "");
    study.source = root.text_or("source", "");
    study.gpus = root.texts("gpus");
    study.x = root.text("x");
    study.logarithmic = root.flag_or("logarithmic", false);
    read_series(root, study);
    read_measures(root, study);
    if (study.of_designs()) read_frames(root, study);
}

} // namespace

std::vector<std::string> study_names() {
    std::set<std::string> names;
    for (const fs::path& directory : ropsim_build::data_dirs()) {
        std::error_code missing;
        for (const fs::directory_entry& entry : fs::directory_iterator(directory / "reports/studies", missing))
            if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
    }
    return {names.begin(), names.end()};
}

Study load_study(const std::string& name_or_path) {
    Study study;
    study.name = name_or_path;
    const auto read = [&study](TomlTable& root) { read_study(root, study); };
    if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml")) {
        study.name = fs::path(name_or_path).stem().string();
        read_toml_file(name_or_path, read);
        return study;
    }
    const std::vector<std::string> names = study_names();
    if (std::find(names.begin(), names.end(), name_or_path) == names.end())
        throw sim::InputError(fmt::format("unknown study '{}'{}; expected a .toml file or one of: {}", name_or_path,
                                          sim::did_you_mean(name_or_path, names), fmt::join(names, ", ")));
    read_data_file(fmt::format("reports/studies/{}.toml", name_or_path), read);
    return study;
}

} // namespace reports
