// A truth as text: for the terminal and for programs.
#include "reports/numbers.hpp"
#include "reports/result.hpp"
#include "reports/text_table.hpp"
#include "reports/truth/truth_run.hpp"
#include "sim/described_json.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

ordered_json light_json(const TruthPlan& plan) {
    const auto list = [](const glm::dvec3& v) { return ordered_json{v.x, v.y, v.z}; };
    const std::uint32_t parts = light_parts(plan.sampling.rays);
    return {{"centre", list(plan.light->centre)},
            {"u", list(plan.light->u)},
            {"v", list(plan.light->v)},
            {"rays_per_point", parts * parts},
            {"seed", plan.sampling.seed}};
}

ordered_json error_json(const TruthError& error) {
    return {{"what", error.what},
            {"compared", error.compared},
            {"doubtful", error.doubtful},
            {"overflown", error.overflown},
            {"wrong", error.wrong},
            {"worst", std::isfinite(error.worst) ? ordered_json(error.worst) : ordered_json(nullptr)},
            {"tolerance", error.tolerance},
            {"holds", error.compared == 0 ? ordered_json(nullptr) : ordered_json(error.holds())}};
}

double visibility_mean(const Truth& truth) {
    double sum = 0.0;
    for (const float share : truth.visibility) sum += static_cast<double>(share);
    return truth.visibility.empty() ? 1.0 : sum / static_cast<double>(truth.visibility.size());
}

std::string errors_text(const TruthRun& run, TerminalStyle style) {
    std::vector<std::vector<std::string>> rows;
    for (const TruthError& error : run.errors)
        rows.push_back({error.what, with_commas(error.compared), with_commas(error.doubtful),
                        with_commas(error.overflown), with_commas(error.wrong),
                        error.compared == 0 ? "-" : fmt::format("{:.4f}", 100.0 * error.share_right()),
                        fmt::format("{:.2g}", error.tolerance),
                        std::isfinite(error.worst) ? fmt::format("{:.2g}", error.worst) : "missing",
                        error.compared == 0 ? "-"
                        : error.holds()     ? "yes"
                                            : "no"});
    return text_table({{"in submission order", "", true},
                       {"compared", "pixels"},
                       {"doubtful", "pixels"},
                       {"over k", "pixels"},
                       {"wrong", "pixels"},
                       {"right", "%"},
                       {"tolerance", ""},
                       {"worst", ""},
                       {"99.9 %", ""}},
                      rows, style);
}

std::string pixels_text(const TruthRun& run, TerminalStyle style) {
    const TruthCounts& counts = run.truth.counts;
    const auto pixels = static_cast<double>(run.truth.pixels());
    return text_table(
        {{"pixels", ""},
         {"seen", "pixels"},
         {"doubtful", "pixels"},
         {"hits", "mean/pixel"},
         {"hits", "most"},
         {"layers", "kept"},
         {"rays", ""},
         {"rays/light", "per point"},
         {"light seen", "mean"},
         {"build", "s"},
         {"time", "s"},
         {"rays/s", "M"},
         {"from", "", true}},
        {{with_commas(run.truth.pixels()), with_commas(counts.pixels_seen), with_commas(counts.pixels_doubtful),
          fmt::format("{:.2f}", static_cast<double>(counts.surfaces) / pixels), with_commas(counts.deepest),
          with_commas(run.truth.layers), short_number(static_cast<double>(counts.pixel_rays + counts.light_rays)),
          run.plan.light
              ? with_commas(std::uint64_t{light_parts(run.plan.sampling.rays)} * light_parts(run.plan.sampling.rays))
              : "-",
          run.plan.light ? fmt::format("{:.4f}", visibility_mean(run.truth)) : "-",
          run.cached ? "-" : fmt::format("{:.2f}", run.build_seconds),
          run.cached ? "-" : fmt::format("{:.2f}", run.tracing_seconds),
          run.cached ? "-" : fmt::format("{:.2f}", run.rays_per_second() / 1e6), run.cached ? "cache" : "rays"}},
        style);
}

} // namespace

ordered_json truth_json(const TruthRun& run) {
    const SceneFacts& scene = run.scene;
    ordered_json json = {{"ropsim", {{"version", version_text()}, {"build", build_text()}}},
                         {"scene",
                          {{"name", scene.name},
                           {"hash", scene.hash},
                           {"triangles_drawn", scene.triangles_drawn},
                           {"draws", scene.draws},
                           {"camera", scene.camera},
                           {"view", scene.view},
                           {"width", run.truth.width},
                           {"height", run.truth.height},
                           {"workload", run.frame->workload},
                           {"notes", scene.notes}}},
                         {"truth", sim::to_json(run.truth.counts)}};
    json["truth"]["layers"] = run.truth.layers;
    if (run.plan.light) {
        json["light"] = light_json(run.plan);
        json["light"]["visibility_mean"] = visibility_mean(run.truth);
    }
    ordered_json errors = ordered_json::array();
    for (const TruthError& error : run.errors) errors.push_back(error_json(error));
    json["errors"] = std::move(errors);
    if (!run.errors.empty()) json["holds"] = run.holds();
    json["host"] = {{"seconds", run.seconds},
                    {"build_seconds", run.build_seconds},
                    {"tracing_seconds", run.tracing_seconds},
                    {"rays_per_second", run.rays_per_second()},
                    {"cached", run.cached},
                    {"threads", run.threads},
                    {"notes", run.notes}};
    return json;
}

std::string truth_text(const TruthRun& run, TerminalStyle style) {
    std::string text = fmt::format("{}: {} in {}, {} at {}x{}, camera {}\n\n", run.scene.name,
                                   counted(run.scene.triangles_drawn, "triangle"), counted(run.scene.draws, "draw"),
                                   run.frame->workload, run.truth.width, run.truth.height, run.scene.camera);
    text += pixels_text(run, style);
    if (!run.errors.empty()) text += "\n" + errors_text(run, style);
    return text;
}

} // namespace reports
