#include "reports/study.hpp"

#include "pipeline/functional/parallel.hpp"
#include "pipeline/geometry/host.hpp"
#include "reports/toml_reader.hpp"
#include "ropsim_build.hpp"
#include "sim/suggest.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <mutex>
#include <optional>
#include <set>

namespace reports {

namespace fs = std::filesystem;

namespace {

StudySeries series_of(TomlTable& table) {
    StudySeries series;
    series.name = table.text("name");
    series.scene = table.text("scene");
    series.prepare = table.texts("prepare");
    series.settings = table.texts("settings");
    series.submission = table.text_or("submission", "buffers");
    series.reads_all = table.flag_or("reads_all", true);
    return series;
}

void read_study(TomlTable& root, Study& study) {
    study.title = root.text("title");
    study.question = root.text("question");
    study.source = root.text_or("source", "");
    study.gpus = root.texts("gpus");
    study.x = root.text("x");
    study.logarithmic = root.flag_or("logarithmic", false);
    study.measure = root.text_or("measure", "fps");
    const std::vector<std::string>& measures = study_measures();
    if (std::find(measures.begin(), measures.end(), study.measure) == measures.end())
        root.expected("measure", fmt::format("one of {}", fmt::join(measures, ", ")));
    root.tables("series", [&](TomlTable& table) { study.series.push_back(series_of(table)); });
    root.entry_lists("points", [&](const std::map<std::string, std::string>& point) { study.points.push_back(point); });
    if (study.series.empty()) root.expected("series", "at least one");
    if (study.points.empty()) root.expected("points", "at least one");
    for (const auto& point : study.points)
        if (!point.contains("x")) root.expected("points", "an x in every point");
}

/// {name} replaced by the point's variable.
std::string filled(const std::string& text, const std::map<std::string, std::string>& point, const Study& study) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t end = text[i] == '{' ? text.find('}', i) : std::string::npos;
        if (end == std::string::npos) {
            result += text[i++];
            continue;
        }
        const auto found = point.find(text.substr(i + 1, end - i - 1));
        if (found == point.end())
            throw sim::InputError(fmt::format("study {}: '{}' names a variable that the point x = {} does not have",
                                              study.name, text, point.at("x")));
        result += found->second;
        i = end + 1;
    }
    return result;
}

std::vector<std::string> filled(const std::vector<std::string>& texts, const std::map<std::string, std::string>& point,
                                const Study& study) {
    std::vector<std::string> list;
    for (const std::string& text : texts) list.push_back(filled(text, point, study));
    return list;
}

pipeline::Submission submission_of(const std::string& text, const Study& study) {
    const auto& names = sim::EnumNames<pipeline::Submission>::names;
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        throw sim::InputError(fmt::format("study {}: submission: expected one of {}, got '{}'", study.name,
                                          fmt::join(names, ", "), text));
    return static_cast<pipeline::Submission>(found - names.begin());
}

StudyValue measure(const PreparedFrame& prepared, const pipeline::GpuParams& gpu, const GeometryRunOptions& options) {
    const pipeline::VertexPathResult result = run_geometry(gpu, *prepared.frame, options.fidelity, options.stop);
    StudyValue value;
    value.fps = result.frames_per_second();
    value.milliseconds = result.milliseconds;
    value.vertices_per_second = static_cast<double>(prepared.vertices) * value.fps;
    value.triangles_per_second = static_cast<double>(prepared.triangles) * value.fps;
    value.acmr = result.counts.acmr();
    const double used = static_cast<double>(prepared.measure.vertex_bytes);
    value.overfetch = used > 0 ? static_cast<double>(result.counts.vertex_bytes.value) / used : 0;
    value.bytes = static_cast<double>(result.counts.vertex_bytes.value + result.counts.index_bytes.value);
    value.draws = prepared.measure.draws;
    value.limit = result.limit();
    return value;
}

} // namespace

const std::vector<std::string>& study_measures() {
    static const std::vector<std::string> list{"fps",  "ms",        "vertices_per_s", "triangles_per_s",
                                               "acmr", "overfetch", "bytes"};
    return list;
}

double measure_of(const StudyValue& value, const std::string& measure) {
    const std::map<std::string, double> all{{"fps", value.fps},
                                            {"ms", value.milliseconds},
                                            {"vertices_per_s", value.vertices_per_second},
                                            {"triangles_per_s", value.triangles_per_second},
                                            {"acmr", value.acmr},
                                            {"overfetch", value.overfetch},
                                            {"bytes", value.bytes}};
    return all.at(measure);
}

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

std::vector<StudyValue> run_series(const Study& study, const StudySeries& series,
                                   const std::map<std::string, std::string>& point,
                                   const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    const GeometryExperiment experiment{filled(series.scene, point, study), filled(series.prepare, point, study),
                                        submission_of(filled(series.submission, point, study), study),
                                        series.reads_all};
    std::optional<PreparedFrame> prepared;
    std::vector<StudyValue> values;
    for (const std::string& gpu : gpus) {
        const pipeline::GpuParams params = configured_gpu(gpu, filled(series.settings, point, study));
        if (!prepared) prepared = prepare_frame(experiment, params);
        StudyValue value = measure(*prepared, params, options);
        value.gpu = gpu;
        value.series = series.name;
        value.x = point.at("x");
        value.measure = measure_of(value, study.measure);
        values.push_back(std::move(value));
    }
    return values;
}

StudyResult run_study(const Study& study, const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    StudyResult result{study, {}, options.fidelity};
    if (!gpus.empty()) result.study.gpus = gpus;
    if (result.study.gpus.empty()) result.study.gpus = {"neutral"};
    const std::size_t cells = study.points.size() * study.series.size();
    const std::size_t each = result.study.gpus.size();
    result.values.resize(cells * each);
    std::mutex mutex;
    std::size_t done = 0;
    pipeline::parallel_for(options.threads, cells, [&](std::size_t cell) {
        const auto& point = study.points[cell / study.series.size()];
        const StudySeries& series = study.series[cell % study.series.size()];
        std::vector<StudyValue> values = run_series(study, series, point, result.study.gpus, options);
        std::move(values.begin(), values.end(), result.values.begin() + static_cast<std::ptrdiff_t>(cell * each));
        const std::lock_guard lock(mutex);
        ++done;
        if (options.progress) options.progress(static_cast<double>(done) / static_cast<double>(cells));
    });
    return result;
}

} // namespace reports
