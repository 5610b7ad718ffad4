#include "tests/physics/runs.hpp"

#include "reports/flatten.hpp"
#include "reports/result.hpp"
#include "sim/config.hpp"
#include "tests/physics/expression.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace physics {

namespace {

struct BoundText {
    std::string_view name, used, capacity;
};

/// Of the run "r". Limits a unit declares per cycle; a unit that finished its last item a cycle early uses less.
constexpr std::array bounds{
    BoundText{"DRAM, bytes", "r.bytes.dram.bytes", "r.gpu.memory.bandwidth * 1000 / r.core_mhz * r.cycles"},
    BoundText{"index fetch, primitives", "r.stages.index_fetch.counters.primitives",
              "r.gpu.geometry.index_fetch.primitives_per_clk * r.cycles"},
    BoundText{"vertex reuse, vertices", "r.stages.vertex_reuse.counters.misses",
              "r.gpu.geometry.vertex_reuse.vertices_per_clk * r.cycles"},
    BoundText{"vertex fetch, lines",
              "r.stages.vertex_fetch.counters.cache.hits + r.stages.vertex_fetch.counters.cache.misses",
              "r.gpu.geometry.vertex_fetch.lines_per_clk * r.cycles"},
    BoundText{"vertex shader, unit cycles", "r.stages.vertex_shader.counters.unit_cycles",
              "r.gpu.geometry.vertex_shader.units * r.cycles"},
    BoundText{"primitive assembly, primitives", "r.stages.primitive_assembly.counters.primitives",
              "r.gpu.geometry.primitive_assembly.primitives_per_clk * r.cycles"},
    BoundText{"triangle set-up, cycles",
              "r.stages.triangle_setup.counters.triangles * r.gpu.geometry.triangle_setup.cycles_per_triangle",
              "r.cycles"},
    BoundText{"rasterizer, quads", "r.stages.rasterizer.counters.quads", "r.gpu.raster.quads_per_clk * r.cycles"},
    BoundText{"rasterizer, tiles", "r.stages.rasterizer.counters.tiles", "r.gpu.raster.tiles_per_clk * r.cycles"},
    BoundText{"fragment pipes, issue cycles", "r.stages.fragment_pipeline.counters.issue_cycles",
              "r.gpu.fragment.pipes * r.cycles"},
    BoundText{"texture units, cycles", "r.stages.fragment_pipeline.counters.texture_cycles",
              "r.gpu.fragment.pipes * r.cycles"},
    BoundText{"fragment pipes, quads in flight", "r.stages.fragment_pipeline.counters.in_flight_max",
              "r.gpu.fragment.pipes * r.gpu.fragment.quads_in_flight"},
    BoundText{"reorder buffer, quads", "r.stages.reorder_buffer.counters.retired",
              "r.gpu.reorder_buffer.retire_per_clk * r.cycles"},
    BoundText{"crossbar, bytes", "r.bytes.crossbar.bytes",
              "r.gpu.crossbar.bytes_per_clk * r.stages.rop.units * r.cycles"},
    BoundText{"ROPs, bytes of stores", "r.stages.rop.counters.stores * 16", // a render target at least
              "r.gpu.rop.units * r.gpu.rop.bytes_per_clk * r.cycles"},
    BoundText{"ROPs, cycles of programs for 4 pixels", "r.stages.rop.counters.program_cycles * 4",
              "r.gpu.rop.units * r.cycles"},
    BoundText{"ROPs, reads of texture units", "r.stages.rop.counters.kbuffer_reads",
              "r.gpu.rop.reads_per_clk * r.stages.rop.units * r.cycles"},
    BoundText{"memory hub, requests", "r.stages.memory_hub.counters.requests",
              "r.gpu.memory.hub.requests_per_clk * (r.gpu.fragment.pipes + 2) * r.cycles"}, // and index, vertex fetch
};

bool has_unit(const RunNumbers& run, const BoundText& bound) {
    constexpr std::string_view stages = "r.stages.", links = "r.bytes.";
    const std::string_view rest = bound.used.substr(2);
    if (bound.used.starts_with(links))
        return run.json.at("bytes").contains(std::string(rest.substr(6, rest.find('.', 6) - 6)));
    const std::string_view stage = bound.used.substr(stages.size());
    return run.json.at("stages").contains(std::string(stage.substr(0, stage.find('.'))));
}

reports::ComparisonRequest request_of(const PredictionRun& run) {
    reports::ComparisonRequest request;
    request.scene = run.scene;
    request.width = run.width;
    request.height = run.height;
    request.workload = run.workload;
    request.workload_settings = run.workload_settings;
    request.gpu = run.gpu;
    request.gpu_settings = run.settings;
    request.designs = {run.design};
    request.threads = 1;
    return request;
}

} // namespace

RunNumbers::RunNumbers(const reports::Comparison& comparison)
    : values(comparison, 0), json(reports::result_json(comparison).at("designs").at(0)) {
    for (const auto& [path, leaf] : reports::flatten(comparison.gpu.parameters))
        if (leaf.is_number()) others["gpu." + path] = leaf.get<double>();
    for (const pipeline::PassResult& pass : comparison.runs.at(0).passes) {
        std::string name = pass.name;
        std::replace(name.begin(), name.end(), ' ', '_');
        others["pass_cycles." + name] += static_cast<double>(pass.cycles);
    }
}

double RunNumbers::at(std::string_view name) const {
    const auto found = others.find(std::string(name));
    if (found != others.end()) return found->second;
    if (const auto value = values.at(name)) return *value;
    throw sim::InputError(fmt::format("a run has no value '{}'", name));
}

std::shared_ptr<const RunNumbers> numbers_of(const PredictionRun& run) {
    static std::map<std::string, std::shared_ptr<const RunNumbers>> made;
    const std::string key =
        fmt::format("{}|{}|{}|{}|{}x{}|{}|{}", run.scene, run.workload, run.gpu, run.design, run.width, run.height,
                    fmt::join(run.workload_settings, " "), fmt::join(run.settings, " "));
    std::shared_ptr<const RunNumbers>& numbers = made[key];
    if (!numbers) numbers = std::make_shared<const RunNumbers>(reports::compare(reports::prepare(request_of(run))));
    return numbers;
}

std::vector<Bound> declared_bounds(const RunNumbers& run) {
    const Lookup lookup = [&](std::string_view name) { return run.at(name.substr(2)); };
    std::vector<Bound> list;
    for (const BoundText& bound : bounds)
        if (has_unit(run, bound))
            list.push_back({std::string(bound.name), evaluate(bound.used, lookup), evaluate(bound.capacity, lookup)});
    return list;
}

std::string exceeded_bounds(const RunNumbers& run) {
    std::string text;
    for (const Bound& bound : declared_bounds(run))
        if (bound.used > bound.capacity)
            text += fmt::format("{}: {:.6g} of {:.6g}\n", bound.name, bound.used, bound.capacity);
    return text;
}

} // namespace physics
