// The closed form of the vertex path.
#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/geometry/vertex_lines.hpp"
#include "pipeline/geometry/vertex_reuse_models.hpp"
#include "pipeline/vertex_path.hpp"
#include "sim/check.hpp"
#include "sim/described.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

namespace pipeline {

namespace {

constexpr std::uint32_t window = 8192;  ///< primitives that are counted in a row
constexpr std::uint32_t warm_up = 1024; ///< primitives before a window that fill the caches

struct PathCounts {
    std::uint64_t primitives = 0, degenerate = 0, runs = 0, lines = 0;
    std::uint64_t rows = 0; ///< lines in another row of memory than the line before them in their bank
};

/// The open row of every bank, served in order.
class OpenRows {
  public:
    explicit OpenRows(const MemoryParams& params)
        : params_(params), open_(std::size_t{params.partitions} * params.controller.dram.banks, ~std::uint64_t{0}) {}

    /// True when the row has to be opened first.
    bool opens(std::uint64_t address) {
        const std::uint64_t block = address / params_.interleave;
        const std::uint64_t partition = block % params_.partitions;
        const std::uint64_t row = block / params_.partitions * params_.interleave / params_.controller.dram.row_bytes;
        const std::uint64_t banks = params_.controller.dram.banks;
        return std::exchange(open_[partition * banks + row % banks], row) != row;
    }

  private:
    MemoryParams params_;
    std::vector<std::uint64_t> open_;
};

/// PathCounts on the reuse model, the line cache and the rows of memory, without time.
class DrawCounter {
  public:
    DrawCounter(const GpuParams& gpu, const Frame& frame, const Draw& draw)
        : geometry_(frame.resources->geometries[draw.geometry]),
          reader_(*frame.resources, geometry_),
          reuse_(gpu.geometry.vertex_reuse),
          cache_(gpu.geometry.vertex_fetch.cache, "geometry.vertex_fetch.cache"),
          lines_(*frame.resources, geometry_, frame.resources->materials[draw.material], frame.needs,
                 gpu.geometry.vertex_fetch.cache.line),
          rows_(gpu.memory) {}

    /// PathCounts [first, end), with caches that the primitives before `first` have filled.
    void count(std::uint32_t first, std::uint32_t end, PathCounts& counts) {
        const bool indexed = geometry_.index_type != IndexType::none;
        reuse_.begin_draw(indexed ? geometry_.vertex_count : std::max(geometry_.vertex_count, geometry_.index_count),
                          indexed);
        PathCounts unused;
        for (std::uint32_t i = first > warm_up ? first - warm_up : 0; i < first; ++i) primitive(i, unused);
        for (std::uint32_t i = first; i < end; ++i) primitive(i, counts);
    }

  private:
    void primitive(std::uint32_t number, PathCounts& counts) {
        const auto vertices = reader_(number);
        const ReuseResult reuse = reuse_.primitive(vertices, corners_of(geometry_.topology));
        ++counts.primitives;
        counts.degenerate += is_degenerate(geometry_.topology, vertices) ? 1U : 0U;
        for (unsigned missed = reuse.missed; missed != 0; missed &= missed - 1) {
            ++counts.runs;
            lines_.begin(vertices[static_cast<std::size_t>(std::countr_zero(missed))]);
            for (; lines_.more(); lines_.next()) {
                if (cache_.access(lines_.line()).hit) continue;
                ++counts.lines;
                counts.rows += rows_.opens(lines_.line() * cache_.line_bytes()) ? 1 : 0;
            }
        }
    }

    const Geometry& geometry_;
    PrimitiveReader reader_;
    VertexReuseModel reuse_;
    Cache cache_;
    VertexLines lines_;
    OpenRows rows_;
};

/// @param share of the primitives that may be looked at; windows lie evenly over the draw
PathCounts sample(const GpuParams& gpu, const Frame& frame, const Draw& draw, double share) {
    PathCounts counts;
    DrawCounter counter(gpu, frame, draw);
    const std::uint32_t primitives = frame.resources->geometries[draw.geometry].primitive_count();
    const auto wanted = static_cast<std::uint32_t>(std::ceil(share * primitives / window));
    if (share >= 1 || std::uint64_t{wanted} * window >= primitives) {
        counter.count(0, primitives, counts);
        return counts;
    }
    for (std::uint32_t i = 0; i < wanted; ++i) {
        const auto first = static_cast<std::uint32_t>(std::uint64_t{i} * (primitives - window) /
                                                      std::max<std::uint32_t>(wanted - 1, 1));
        counter.count(first, first + window, counts);
    }
    return counts;
}

std::uint64_t scaled(std::uint64_t count, double factor) {
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(count) * factor));
}

GeometryDrawStats stats_of(const Frame& frame, const Draw& draw, const PathCounts& counts,
                           const GeometryParams& params) {
    const Geometry& geometry = frame.resources->geometries[draw.geometry];
    const std::uint64_t instances = draw.instances.size();
    const std::uint64_t primitives = geometry.primitive_count() * instances;
    const double factor =
        counts.primitives == 0 ? 0 : static_cast<double>(primitives) / static_cast<double>(counts.primitives);
    const std::uint64_t index_lines =
        (std::uint64_t{geometry.index_count} * bytes_of(geometry.index_type) + params.index_fetch.line - 1) /
        params.index_fetch.line;
    GeometryDrawStats stats;
    stats.primitives = {primitives};
    stats.vertices_referenced = {corners_of(geometry.topology) * primitives};
    stats.vertex_shader_runs = {scaled(counts.runs, factor)};
    stats.culled = stats.degenerate = {scaled(counts.degenerate, factor)};
    stats.triangles = {primitives - stats.degenerate.value};
    stats.index_bytes = {index_lines * params.index_fetch.line * instances};
    stats.vertex_bytes = {scaled(counts.lines, factor) * params.vertex_fetch.cache.line};
    return stats;
}

/// Time of the banks of memory: a line keeps its bank for its transfer and, where it opens a row, for that; a row stays
/// open for tRAS at least, and a channel opens one each tRRD, four in tFAW. Served in order, as if no request overtook
/// another.
double bank_cycles(const GpuParams& gpu, const PathCounts& counts, double factor) {
    const MemoryParams& memory = gpu.memory;
    const DramParams& dram = memory.controller.dram;
    const double line_ns = gpu.geometry.vertex_fetch.cache.line / (memory.bandwidth / memory.partitions);
    const auto rows = static_cast<double>(counts.rows);
    const double banks_ns =
        std::max(rows * (dram.rp_ns + dram.rcd_read_ns) + static_cast<double>(counts.lines) * line_ns,
                 rows * (dram.rp_ns + dram.ras_ns)) /
        dram.banks;
    const double channel_ns = rows * std::max(dram.rrd_ns, dram.faw_ns / 4);
    return factor * std::max(banks_ns, channel_ns) / memory.partitions * 1e-3 * gpu.clock.core_mhz;
}

/// What a draw takes when nothing else is drawn: its largest demand.
double busy_cycles(const VertexPathDemand& demand) {
    return std::max({demand.host_feed, demand.input_port(), demand.index_fetch, demand.vertex_reuse, demand.line_lookup,
                     demand.vertex_shader, demand.primitive_assembly, demand.triangle_setup, demand.memory});
}

/// From the first draw call to the first triangle with nothing in the way.
double fill_cycles(const GpuParams& gpu) {
    const auto& controller = gpu.memory.controller;
    const double device = (controller.dram.rcd_read_ns + controller.dram.cl_ns) * 1e-3 * gpu.clock.core_mhz;
    const double read = 2.0 * gpu.memory.hub.latency + controller.request_latency + controller.return_latency + device;
    constexpr double stages = 12;
    return gpu.geometry.command_processor.draw_gpu_cycles + 2 * read + gpu.geometry.vertex_fetch.hit_latency +
           gpu.geometry.vertex_shader.cycles_per_vertex + gpu.geometry.triangle_setup.cycles_per_triangle + stages;
}

/// Draws one after the other, none before the CPU has submitted it and its state is set up.
class Clockwork {
  public:
    explicit Clockwork(const GpuParams& gpu)
        : set_up_(gpu.geometry.command_processor.draw_gpu_cycles), submitted_(gpu.host.frame_us * gpu.clock.core_mhz) {}

    void draw(const VertexPathDemand& demand) {
        submitted_ += demand.conversion;
        const double ready = std::max(submitted_, taken_) + set_up_;
        taken_ = std::max(ready, begun_); // the front takes a draw while the one before it is drawn
        begun_ = std::max(ready, free_);
        free_ = begun_ + busy_cycles(demand);
        submitted_ += demand.cpu;
    }
    double end() const { return free_; }

  private:
    double set_up_, submitted_;
    double taken_ = 0, begun_ = 0, free_ = 0;
};

} // namespace

VertexPathResult estimate_vertex_path(const GpuParams& gpu, const Frame& frame, const VertexPathOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    VertexPathResult result;
    const std::vector<DrawTerms> terms = draw_terms(gpu.host, frame);
    std::uint64_t primitives = 0, looked_at = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, PathCounts> known; // draws of one geometry and material are alike
    for (const Draw& draw : frame.draws)
        if (known.try_emplace({draw.geometry, draw.material}).second)
            primitives += frame.resources->geometries[draw.geometry].primitive_count();
    const double share =
        primitives == 0 ? 1 : static_cast<double>(options.estimate_primitives) / static_cast<double>(primitives);
    for (auto& [pair, counts] : known) {
        if (options.stop != nullptr && *options.stop) throw sim::Interrupted();
        const Draw draw{{}, pair.first, pair.second, {}};
        counts = sample(gpu, frame, draw, share);
        looked_at += counts.primitives;
    }
    result.share_sampled = primitives == 0 ? 1 : static_cast<double>(looked_at) / static_cast<double>(primitives);
    result.draws.resize(frame.draws.size());
    Clockwork clockwork(gpu);
    for (const Pass& pass : frame.passes)
        for (const std::uint32_t number : pass.draws) {
            VertexPathDraw& entry = result.draws[number];
            const Draw& draw = frame.draws[number];
            entry.terms = terms[number];
            const PathCounts& counts = known.at({draw.geometry, draw.material});
            entry.counts = stats_of(frame, draw, counts, gpu.geometry);
            entry.demand = vertex_path_demand(gpu, frame, number, entry.terms, entry.counts);
            const double factor = static_cast<double>(entry.counts.primitives.value) /
                                  static_cast<double>(std::max<std::uint64_t>(counts.primitives, 1));
            entry.demand.memory = std::max(entry.demand.memory, bank_cycles(gpu, counts, factor));
            clockwork.draw(entry.demand);
            sim::add(result.counts, entry.counts);
            sim::add(result.demand, entry.demand);
        }
    result.cycles = static_cast<std::uint64_t>(std::llround(clockwork.end() + fill_cycles(gpu)));
    result.milliseconds = static_cast<double>(result.cycles) / (gpu.clock.core_mhz * 1e3);
    result.host_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

} // namespace pipeline
