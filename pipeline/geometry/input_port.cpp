#include "pipeline/geometry/input_port.hpp"

#include "pipeline/geometry/vertex_lines.hpp"

#include <cmath>

namespace pipeline {

namespace {

double cycles_of(double bytes, double bytes_per_clk) { return bytes_per_clk > 0 ? bytes / bytes_per_clk : 0; }

bool lie_together(const VertexAttribute& a, const VertexAttribute& b) {
    const std::uint64_t distance = a.offset > b.offset ? a.offset - b.offset : b.offset - a.offset;
    return a.buffer == b.buffer && a.stride == b.stride && distance < a.stride;
}

std::uint64_t in_parts(double cycles) {
    return static_cast<std::uint64_t>(std::llround(cycles * static_cast<double>(InputCost::parts_of_a_cycle)));
}

} // namespace

bool InputPortParams::limits() const {
    return index_bytes_per_clk > 0 || draw_cycles > 0 || vertex_cycles > 0 || line_bytes_per_clk > 0 ||
           stream_cycles > 0 || colour_bytes_per_clk > 0 || attribute_bytes_per_clk > 0 ||
           interleaved_bytes_per_clk > 0;
}

InputLayout input_layout(const Needs& needs, const Geometry& geometry, const Material& material) {
    InputLayout layout;
    const VertexAttribute* position = geometry.find(Semantic::position);
    for (const VertexAttribute& attribute : geometry.attributes)
        if (&attribute != position && reads_attribute(needs, material, attribute.semantic))
            layout.items.push_back({slot_of(attribute.semantic), attribute.bytes(),
                                    position != nullptr && lie_together(attribute, *position)});
    return layout;
}

InputCostParts input_cost_parts(const InputPortParams& params, const HostParams& host, const DrawTerms& terms,
                                const InputLayout& layout, std::uint32_t line, double core_mhz) {
    InputCostParts parts;
    parts.draw = params.draw_cycles;
    parts.base = params.vertex_cycles;
    for (const InputLayout::Item& item : layout.items) {
        const double apart = item.slot == Slot::colour ? params.colour_bytes_per_clk : params.attribute_bytes_per_clk;
        parts.attributes += item.beside_position ? cycles_of(item.bytes, params.interleaved_bytes_per_clk)
                                                 : params.stream_cycles + cycles_of(item.bytes, apart);
    }
    parts.line = cycles_of(line, params.line_bytes_per_clk);
    parts.index_byte = cycles_of(1, params.index_bytes_per_clk);
    const double bus_cycles_per_byte = outside_seconds(host, 1) * core_mhz * 1e6;
    parts.bus_draw = bus_cycles_per_byte * terms.copied_bytes;
    parts.bus_line = bus_cycles_per_byte * terms.host_share * line;
    parts.bus_index_byte = bus_cycles_per_byte * terms.host_share;
    parts.slowdown = terms.slowdown;
    return parts;
}

InputCost input_cost(const InputCostParts& parts) {
    return {in_parts(parts.draw + parts.bus_draw), in_parts((parts.base + parts.attributes) * parts.slowdown),
            in_parts(parts.line * parts.slowdown + parts.bus_line),
            in_parts(parts.index_byte * parts.slowdown + parts.bus_index_byte)};
}

} // namespace pipeline
