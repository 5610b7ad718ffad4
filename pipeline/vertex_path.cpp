#include "pipeline/vertex_path.hpp"

#include "pipeline/geometry/vertex_lines.hpp"
#include "sim/described.hpp"

#include <algorithm>

namespace pipeline {

namespace {

double cycles_of_us(double us, const GpuParams& gpu) { return us * gpu.clock.core_mhz; }

/// Bytes of indices that the primitives of these counts read.
double index_bytes_read(const Geometry& geometry, const GeometryDrawStats& counts) {
    const double primitives = geometry.primitive_count();
    if (primitives == 0) return 0;
    const double instances = static_cast<double>(counts.primitives.value) / primitives;
    return instances * static_cast<double>(geometry.index_count) * bytes_of(geometry.index_type);
}

void add_input(VertexPathDemand& demand, const InputCostParts& parts, double vertices, double lines,
               double index_bytes) {
    demand.draw_input = parts.draw;
    demand.index_input = index_bytes * parts.index_byte;
    demand.vertex_input = vertices * parts.base;
    demand.attribute_input = vertices * parts.attributes;
    demand.line_input = lines * parts.line;
    demand.large_draws =
        (parts.slowdown - 1) * (demand.index_input + demand.vertex_input + demand.attribute_input + demand.line_input);
    demand.bus = parts.bus_draw + lines * parts.bus_line + index_bytes * parts.bus_index_byte;
}

} // namespace

VertexPathDemand vertex_path_demand(const GpuParams& gpu, const Frame& frame, std::uint32_t draw,
                                    const DrawTerms& terms, const GeometryDrawStats& counts) {
    const Geometry& geometry = frame.resources->geometries[frame.draws[draw].geometry];
    const Material& material = frame.resources->materials[frame.draws[draw].material];
    const GeometryParams& params = gpu.geometry;
    const std::uint32_t line = params.vertex_fetch.cache.line;
    const auto vertices = static_cast<double>(counts.vertex_shader_runs.value);
    const auto primitives = static_cast<double>(counts.primitives.value);
    const double index_bytes = index_bytes_read(geometry, counts);
    const double lines = static_cast<double>(counts.vertex_bytes.value) / line;

    VertexPathDemand demand;
    demand.cpu = cycles_of_us(params.command_processor.draw_cpu_us, gpu);
    demand.conversion = cycles_of_us(terms.cpu_us, gpu);
    demand.host_feed = cycles_of_us(terms.feed_us, gpu);
    add_input(demand,
              input_cost_parts(params.vertex_fetch.port, gpu.host, terms, input_layout(frame.needs, geometry, material),
                               line, gpu.clock.core_mhz),
              vertices, lines, index_bytes);
    demand.index_fetch =
        std::max(index_bytes / params.index_fetch.bytes_per_clk, primitives / params.index_fetch.primitives_per_clk);
    if (geometry.index_type == IndexType::none) demand.index_fetch = primitives;
    demand.vertex_reuse = vertices / params.vertex_reuse.vertices_per_clk;
    demand.line_lookup = vertices * VertexLines(*frame.resources, geometry, material, frame.needs, line).mean_lines() /
                         params.vertex_fetch.lines_per_clk;
    demand.vertex_shader = vertices * params.vertex_shader.cycles_per_vertex / params.vertex_shader.units;
    demand.primitive_assembly = primitives / params.primitive_assembly.primitives_per_clk;
    demand.triangle_setup =
        (primitives - static_cast<double>(counts.degenerate.value)) * params.triangle_setup.cycles_per_triangle;
    demand.memory = static_cast<double>(counts.vertex_bytes.value + counts.index_bytes.value) /
                    (gpu.memory.bandwidth * 1e3 / gpu.clock.core_mhz);
    return demand;
}

std::string VertexPathResult::limit() const {
    std::string name = "input port";
    double largest = demand.input_port();
    sim::for_each_field(demand, [&](const auto& field, const double& needed) {
        const bool in_port = field.text.starts_with("input port:");
        if (in_port || needed <= largest) return;
        largest = needed;
        name = std::string(field.text);
    });
    return name;
}

} // namespace pipeline
