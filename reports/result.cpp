#include "reports/result.hpp"

#include "reports/hazard_text.hpp"
#include "reports/run_numbers.hpp"
#include "reports/surface_text.hpp"
#include "ropsim_build.hpp"
#include "sim/described_json.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace reports {

using nlohmann::ordered_json;

namespace {

constexpr std::size_t most_notes_listed = 100;

ordered_json notes_json(const std::vector<std::string>& notes) {
    ordered_json list(notes);
    if (notes.size() <= most_notes_listed) return list;
    list = std::vector<std::string>(notes.begin(), notes.begin() + most_notes_listed);
    list.push_back(fmt::format("and {} more notes", notes.size() - most_notes_listed));
    return list;
}

ordered_json scene_json(const Comparison& comparison) {
    const SceneFacts& scene = comparison.scene;
    const pipeline::Frame& frame = *comparison.frame;
    ordered_json json = {{"name", scene.name},
                         {"hash", scene.hash},
                         {"triangles", scene.triangles},
                         {"triangles_drawn", scene.triangles_drawn},
                         {"vertices", scene.vertices},
                         {"draws", scene.draws},
                         {"textures", scene.textures},
                         {"camera", scene.camera},
                         {"view", scene.view},
                         {"width", comparison.width()},
                         {"height", comparison.height()},
                         {"samples", comparison.samples()},
                         {"workload", frame.workload},
                         {"notes", notes_json(scene.notes)}};
    if (scene.captured) json["captured"] = {{"name", scene.captured->name}, {"hash", scene.captured->hash}};
    if (frame.program)
        json["kbuffer"] = {{"program", frame.program->id()},
                           {"k", frame.program->k()},
                           {"floats_per_entry", frame.program->floats_per_entry()},
                           {"bytes_per_pixel", frame.program->bytes_per_pixel()},
                           {"overflow_pixels", overflow_pixels(comparison)}};
    return json;
}

ordered_json gpu_json(const GpuFacts& gpu) {
    ordered_json origins = ordered_json::object();
    for (const auto& [path, origin] : gpu.origins)
        origins[path] = {{"origin", origin.origin}, {"source", origin.source}, {"note", origin.note}};
    return {{"name", gpu.name}, {"parameters", *gpu.parameters}, {"origins", std::move(origins)}};
}

// Rates are over the time of the runs themselves, so that they do not depend on how many ran at once.
ordered_json host_json(const Comparison& comparison) {
    double seconds = 0, cpu_seconds = 0, cycles = 0, fragments = 0;
    ordered_json runs = ordered_json::array();
    for (const pipeline::RunResult& run : comparison.runs) {
        runs.push_back({{"id", run.design},
                        {"seconds", run.host_seconds},
                        {"cpu_seconds", run.cpu_seconds},
                        {"ticks", run.host_ticks}});
        if (run.host_seconds == 0) continue; // has the numbers of another one
        seconds += run.host_seconds;
        cpu_seconds += run.cpu_seconds;
        cycles += static_cast<double>(run.cycles);
        fragments += static_cast<double>(run.fragments);
    }
    const auto rate = [](double count, double in) { return in > 0 ? count / in : 0.0; };
    return {{"seconds", comparison.host.seconds},
            {"front_end_seconds", comparison.host.front_end_seconds},
            {"cycles_per_second", rate(cycles, seconds)},
            {"fragments_per_second", rate(fragments, seconds)},
            {"cycles_per_cpu_second", rate(cycles, cpu_seconds)},
            {"peak_bytes", comparison.host.peak_bytes},
            {"threads", comparison.host.threads},
            {"designs", std::move(runs)}};
}

ordered_json left_out_json(const std::vector<std::pair<std::string, std::string>>& left_out) {
    ordered_json list = ordered_json::array();
    for (const auto& [unit, reason] : left_out) list.push_back({{"unit", unit}, {"reason", reason}});
    return list;
}

ordered_json needs_json(const std::vector<std::string>& built,
                        const std::vector<std::pair<std::string, std::string>>& left_out) {
    return {{"built", built}, {"left_out", left_out_json(left_out)}};
}

ordered_json hazards_json(const pipeline::RunResult& run) {
    const pipeline::HazardCounts& hazards = run.hazards;
    ordered_json json;
    for (std::size_t cause = 0; cause < pipeline::hazard_classes; ++cause)
        json[std::string(hazard_class_names[cause])] = hazards.of(static_cast<pipeline::HazardClass>(cause));
    json["total"] = hazards.total();
    for (const auto kind : {pipeline::HazardKind::concurrency, pipeline::HazardKind::incoherence})
        json[std::string(hazard_name(kind))] = hazards.of(kind);
    for_each_hazard_cell(hazards, [&json](const std::string& name, std::uint64_t count) { json[name] = count; });
    json["pixels"] = hazards.pixels;
    json["per_million"] = hazards_per_million(run);
    for (const auto kind : {pipeline::HazardKind::concurrency, pipeline::HazardKind::incoherence})
        json[std::string(hazard_name(kind)) + "_per_million"] = hazards_per_million(run, kind);
    json["pairs_kept"] = run.pairs.size();
    json["mean_staleness"] = run.mean_staleness;
    json["max_staleness"] = run.max_staleness;
    return json;
}

ordered_json equal_area_json(const EqualArea& equal) {
    ordered_json list = ordered_json::array();
    for (const EqualArea::Unfit& unfit : equal.does_not_fit)
        list.push_back({{"id", unfit.name},
                        {"design", unfit.variant.design},
                        {"variant", unfit.variant.text},
                        {"needed_bytes", unfit.needed}});
    return {{"bytes", equal.bytes}, {"does_not_fit", std::move(list)}};
}

ordered_json layers_json(const pipeline::RunResult& run) {
    ordered_json list = ordered_json::array();
    for (std::size_t layer = 0; layer < run.layers.size(); ++layer)
        list.push_back({{"layer", layer},
                        {"missing", run.layers[layer].missing},
                        {"duplicate", run.layers[layer].duplicate},
                        {"unsorted", run.layers[layer].unsorted}});
    return list;
}

ordered_json hazard_distance_json(const pipeline::RunResult& run) {
    ordered_json list = ordered_json::array();
    for (std::size_t bin = 0; bin < run.hazard_distance.size(); ++bin)
        list.push_back({{"from", std::uint64_t{1} << bin},
                        {"below", std::uint64_t{2} << bin},
                        {"hazards", run.hazard_distance[bin]}});
    return list;
}

ordered_json passes_json(const pipeline::RunResult& run) {
    ordered_json list = ordered_json::array();
    for (const pipeline::PassResult& pass : run.passes)
        list.push_back({{"name", pass.name},
                        {"first_cycle", pass.first_cycle},
                        {"cycles", pass.cycles},
                        {"counters", *pass.counters}});
    return list;
}

ordered_json judgements_json(const pipeline::RunResult& run) {
    ordered_json list = ordered_json::array();
    for (const pipeline::PassJudgement& judgement : run.judgements)
        list.push_back({{"pass", judgement.pass},
                        {"surface", judgement.surface},
                        {"wrong_places", judgement.wrong_places},
                        {"other_inputs", judgement.other_inputs}});
    return list;
}

ordered_json surfaces_json(const pipeline::RunResult& run) {
    ordered_json list = ordered_json::array();
    for (const auto& [info, memory] : run.surfaces)
        list.push_back({{"name", info.name},
                        {"format", content_text(info)},
                        {"width", info.width},
                        {"height", info.height},
                        {"planes", info.planes},
                        {"levels", info.levels},
                        {"nominal_bytes", memory.nominal},
                        {"allocated_bytes", memory.allocated},
                        {"high_water_bytes", memory.high_water}});
    return list;
}

constexpr std::size_t most_draws_listed = 64;

ordered_json draw_counters_json(const pipeline::RunResult& run, const std::vector<std::uint64_t>& counters) {
    ordered_json json = ordered_json::object();
    for (std::size_t i = 0; i < counters.size(); ++i) json[run.draw_counters.at(i)] = counters[i];
    return json;
}

ordered_json draws_json(const pipeline::RunResult& run) {
    ordered_json list = ordered_json::array();
    if (run.draws.size() > most_draws_listed) return list;
    for (const pipeline::DrawResult& draw : run.draws)
        list.push_back(
            {{"draw", draw.draw}, {"name", draw.name}, {"counters", draw_counters_json(run, draw.counters)}});
    return list;
}

// In place of a list that would be too long. The cycles are the first and the last of them all.
ordered_json draws_summed_json(const pipeline::RunResult& run) {
    std::vector<std::uint64_t> sums(run.draw_counters.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const bool first = run.draw_counters[i] == "first_cycle", last = run.draw_counters[i] == "last_cycle";
        for (const pipeline::DrawResult& draw : run.draws) {
            const std::uint64_t value = draw.counters.at(i);
            if (first)
                sums[i] = sums[i] == 0 || (value != 0 && value < sums[i]) ? value : sums[i];
            else
                sums[i] = last ? std::max(sums[i], value) : sums[i] + value;
        }
    }
    return {{"draws", run.draws.size()}, {"counters", draw_counters_json(run, sums)}};
}

// What every run has, in the order of the first.
template <class T>
std::vector<T> common_to_all(const std::vector<pipeline::RunResult>& runs,
                             std::vector<T> pipeline::RunResult::*member) {
    std::vector<T> common;
    for (const T& item : runs.front().*member) {
        const auto has = [&](const pipeline::RunResult& run) {
            return std::find((run.*member).begin(), (run.*member).end(), item) != (run.*member).end();
        };
        if (std::all_of(runs.begin(), runs.end(), has)) common.push_back(item);
    }
    return common;
}

struct Needs {
    std::vector<std::string> built;
    std::vector<std::pair<std::string, std::string>> left_out;
};

ordered_json design_json(const Comparison& comparison, std::size_t number, const Needs& common) {
    const pipeline::RunResult& run = comparison.runs[number];
    const VariantFacts& variant = comparison.variants.at(number);
    ordered_json json = {{"id", run.design},
                         {"design", variant.design},
                         {"variant", variant.text},
                         {"parameters", *comparison.design_parameters.at(number)},
                         {"gpu_changes", *variant.gpu_changes},
                         {"cycles", run.cycles},
                         {"core_mhz", run.core_mhz},
                         {"milliseconds", milliseconds(run)},
                         {"fps", frames_per_second(run)},
                         {"fragments", run.fragments},
                         {"hazards", hazards_json(run)},
                         {"hazard_distance", hazard_distance_json(run)},
                         {"wrong_pixels", run.wrong_pixels},
                         {"tied_pixels", run.tied_pixels},
                         {"overflow_pixels", run.overflow_pixels},
                         {"unexplained_pixels", run.unexplained_pixels()},
                         {"wrong_because", sim::to_json(run.wrong_because)},
                         {"lost_fragments", run.lost_fragments},
                         {"lost_updates", run.lost_updates},
                         {"layers", layers_json(run)},
                         {"stages", *run.stages},
                         {"stalls", *run.stalls},
                         {"caches", *run.caches},
                         {"bytes", *run.bytes},
                         {"area", *run.area},
                         {"supports", *comparison.design_support.at(number)},
                         {"surfaces", surfaces_json(run)},
                         {"passes", passes_json(run)},
                         {"judgements", judgements_json(run)},
                         {"draws", draws_json(run)}};
    if (run.draws.size() > most_draws_listed) json["draws_summed"] = draws_summed_json(run);
    // The comparison's "needs" states what all designs have in common.
    if (run.built != common.built || run.left_out != common.left_out)
        json["needs"] = needs_json(run.built, run.left_out);
    return json;
}

} // namespace

std::string version_text() { return std::string(ropsim_build::version); }

std::string build_text() {
    return fmt::format("{}, {}, {}", ropsim_build::git_describe, ropsim_build::compiler, ropsim_build::build_type);
}

ordered_json result_json(const Comparison& comparison) {
    ordered_json json = {{"ropsim", {{"version", version_text()}, {"build", build_text()}}},
                         {"scene", scene_json(comparison)},
                         {"gpu", gpu_json(comparison.gpu)},
                         {"seed", comparison.seed},
                         {"host", host_json(comparison)},
                         {"needs", needs_json({}, {})},
                         {"designs", ordered_json::array()}};
    if (comparison.equal_area) json["equal_area"] = equal_area_json(*comparison.equal_area);
    if (comparison.runs.empty()) return json;
    const Needs common{common_to_all(comparison.runs, &pipeline::RunResult::built),
                       common_to_all(comparison.runs, &pipeline::RunResult::left_out)};
    json["needs"] = needs_json(common.built, common.left_out);
    for (std::size_t i = 0; i < comparison.runs.size(); ++i)
        json["designs"].push_back(design_json(comparison, i, common));
    return json;
}

std::string result_text(const ordered_json& result) {
    return result.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

} // namespace reports
