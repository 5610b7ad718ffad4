// Studies of geometry feed.
#include "pipeline/geometry/host.hpp"
#include "reports/study_runs.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace reports {

namespace {

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
    const double fps = result.frames_per_second();
    const double used = static_cast<double>(prepared.measure.vertex_bytes);
    StudyValue value;
    const auto add = [&value](const char* name, double number) {
        value.numbers.push_back({name, number, number, number});
    };
    add("fps", fps);
    add("ms", result.milliseconds);
    add("vertices_per_s", static_cast<double>(prepared.vertices) * fps);
    add("triangles_per_s", static_cast<double>(prepared.triangles) * fps);
    add("acmr", result.counts.acmr());
    add("overfetch", used > 0 ? static_cast<double>(result.counts.vertex_bytes.value) / used : 0);
    add("bytes", static_cast<double>(result.counts.vertex_bytes.value + result.counts.index_bytes.value));
    add("draws", static_cast<double>(prepared.measure.draws));
    value.limit = result.limit();
    return value;
}

} // namespace

const std::vector<std::string>& study_measures() {
    static const std::vector<std::string> list{"fps",  "ms",        "vertices_per_s", "triangles_per_s",
                                               "acmr", "overfetch", "bytes",          "draws"};
    return list;
}

std::vector<StudyValue> run_geometry_series(const Study& study, const StudySeries& series, const StudyPoint& point,
                                            const std::vector<std::string>& gpus, const GeometryRunOptions& options) {
    const GeometryExperiment experiment{filled(series.scene, point, study), filled(series.prepare, point, study),
                                        submission_of(filled(series.submission, point, study), study),
                                        series.reads_all};
    std::optional<PreparedFrame> prepared;
    std::vector<StudyValue> values;
    for (const std::string& gpu : gpus) {
        const pipeline::GpuParams params = configured_gpu(gpu, filled(series.settings, point, study));
        if (!prepared) prepared = prepare_frame(experiment, params);
        values.push_back(measure(*prepared, params, options));
    }
    return values;
}

} // namespace reports
