#include "tests/support/replay.hpp"

#include "sim/check.hpp"
#include "tests/support/paths.hpp"

#include <bit>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace support {

std::vector<std::string> Replay::designs() const {
    std::vector<std::string> ids;
    for (const std::string& id : design_ids()) {
        sim::Config config;
        if (!frame.program || models::make_design(id, config)->refuses(*frame.program).empty()) ids.push_back(id);
    }
    return ids;
}

const pipeline::FragmentStream& Replay::kbuffer_stream() const {
    std::size_t next = 0;
    for (const pipeline::Pass& pass : frame.passes) {
        if (!pass.rasterizes()) continue;
        if (pass.runs_program()) return streams[next];
        ++next;
    }
    CHECK_MSG(false, "the frame has no k-buffer pass");
    return streams.front();
}

TaskCounts count_tasks(const pipeline::FragmentStream& stream, bool multisampled) {
    TaskCounts counts;
    for (std::size_t id = 0; id < stream.quads.size(); ++counts.tasks) {
        unsigned covered = 0, alive = 0;
        const std::size_t end = id + (multisampled ? stream.quads[id].more + std::size_t{1} : 1);
        for (; id < end; ++id) {
            covered |= stream.quads[id].covered;
            alive |= stream.quads[id].alive;
        }
        counts.covered += static_cast<std::uint64_t>(std::popcount(covered));
        counts.alive += static_cast<std::uint64_t>(std::popcount(alive));
    }
    return counts;
}

bool multisampled(const Replay& replay, const pipeline::Pass& pass, const std::string& design) {
    if (replay.frame.view.samples == 1) return false;
    if (!pass.runs_program()) return true;
    sim::Config config;
    return models::make_design(design, config)->plan(*replay.frame.program, replay.frame.view).works_per_sample();
}

std::vector<std::vector<pipeline::QuadId>> quads_by_pixel(const pipeline::FragmentStream& stream) {
    std::vector<std::vector<pipeline::QuadId>> lists(std::size_t{stream.width} * stream.rows());
    for (pipeline::QuadId id = 0; id < stream.quads.size(); ++id) {
        const pipeline::Quad& quad = stream.quads[id];
        for (std::uint32_t lane = 0; lane < 4; ++lane)
            if ((quad.alive >> lane & 1U) != 0)
                lists[std::size_t{quad.y + lane / 2} * stream.width + quad.x + lane % 2].push_back(id);
    }
    return lists;
}

std::vector<std::string> design_ids() {
    std::vector<std::string> ids;
    for (const models::DesignInfo& design : models::designs()) ids.emplace_back(design.id);
    return ids;
}

bool protects(const std::string& design) {
    return keeps_submission(design) && design != "existing" && design != "detect";
}

bool holds_everything(const std::string& design) { return design != "dual-peel" && design != "stencil-routed"; }

bool keeps_submission(const std::string& design) {
    sim::Config config;
    return !models::make_design(design, config)->submission().changes();
}

const pipeline::PassResult& pass_named(const pipeline::RunResult& run, const std::string& name) {
    for (const pipeline::PassResult& pass : run.passes)
        if (pass.name.starts_with(name)) return pass;
    CHECK_MSG(false, "no pass of this name");
    return run.passes.front();
}

std::uint64_t counter(const nlohmann::ordered_json& json, const std::string& path) {
    return json.at(nlohmann::ordered_json::json_pointer("/" + path)).get<std::uint64_t>();
}

std::string shared_scene(const std::string& name) {
    const auto found = ropsim_test::shared_file("scenes/" + name);
    return found ? found->string() : std::string();
}

std::string demo_scene() {
    const auto file = ropsim_test::source_dir() / "build/scenes/menagerie.glb";
    return std::filesystem::exists(file) ? file.string() : std::string();
}

} // namespace support
