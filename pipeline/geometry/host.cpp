#include "pipeline/geometry/host.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/geometry/vertex_lines.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace pipeline {

namespace {

constexpr double bytes_per_mb = 1e6;

bool needs_span(const HostParams& params, const Frame& frame) {
    return params.range_cliff != RangeCliff::none || params.span_slowdown > 0 ||
           frame.submission != Submission::buffers;
}

// 1 up to the saturation, then linear in the logarithm up to 1 + span_slowdown at the limit and beyond.
double span_factor(const HostParams& params, std::uint32_t span) {
    if (span <= params.span_saturation || params.range_limit_vertices <= params.span_saturation) return 1;
    const double whole = std::log2(static_cast<double>(params.range_limit_vertices) / params.span_saturation);
    const double part = std::log2(static_cast<double>(span) / params.span_saturation);
    return 1 + params.span_slowdown * std::min(1.0, part / whole);
}

// Whether an attribute is read and has a value of its own for each vertex.
bool varies(const Frame& frame, const Material& material, const VertexAttribute& attribute) {
    return attribute.divisor == 0 && reads_attribute(frame.needs, material, attribute.semantic);
}

// Bytes of the attributes that are read, of one vertex.
double vertex_bytes(const Frame& frame, const Geometry& geometry, const Material& material) {
    double bytes = 0;
    for (const VertexAttribute& attribute : geometry.attributes)
        if (varies(frame, material, attribute)) bytes += attribute.bytes();
    return bytes;
}

double conversion_us(const HostParams& params, const Frame& frame, const Geometry& geometry, const Material& material) {
    double ns = 0;
    for (const VertexAttribute& attribute : geometry.attributes)
        if (varies(frame, material, attribute)) ns += params.convert.of(slot_of(attribute.semantic)).ns(attribute.type);
    return ns * geometry.vertex_count * 1e-3;
}

// Vertices, as often as the application names them in immediate mode and as a list keeps them.
double named_vertices(const Geometry& geometry) {
    return static_cast<double>(corners_of(geometry.topology)) * geometry.primitive_count();
}

double feed_us(const HostParams& params, Submission submission, const Geometry& geometry, std::uint32_t span,
               double bytes) {
    const double index_bytes = static_cast<double>(bytes_of(geometry.index_type)) * geometry.index_count;
    switch (submission) {
    case Submission::buffers:
        return 0;
    case Submission::client_arrays:
        return (span * bytes + index_bytes) / (std::min(params.client_gbps, params.bus_gbps) * 1e9) * 1e6;
    case Submission::immediate:
        return std::max(named_vertices(geometry) * params.immediate_ns * 1e-3,
                        bus_seconds(params, named_vertices(geometry) * bytes) * 1e6);
    case Submission::display_list:
        return named_vertices(geometry) * params.list_ns * 1e-3;
    }
    return 0;
}

void apply_cliff(DrawTerms& terms, const HostParams& params, const Geometry& geometry, double bytes) {
    const bool indexed = geometry.index_type != IndexType::none; // draws without indices were never slow
    const bool many_bytes = bytes * terms.span > params.range_limit_mb * bytes_per_mb;
    switch (params.range_cliff) {
    case RangeCliff::none:
        break;
    case RangeCliff::index_range:
        terms.over_limit = indexed && terms.span > params.range_limit_vertices;
        break;
    case RangeCliff::cache_capacity:
        terms.over_limit = indexed && many_bytes;
        break;
    case RangeCliff::host_memory:
        terms.over_limit = many_bytes;
        if (many_bytes) terms.host_share = 1;
        return;
    }
    if (terms.over_limit) terms.slowdown *= params.overflow_slowdown;
}

std::set<std::uint32_t> buffers_of(const Frame& frame, std::uint32_t number) {
    const Geometry& geometry = frame.resources->geometries[number];
    std::set<std::uint32_t> buffers;
    for (const VertexAttribute& attribute : geometry.attributes) buffers.insert(attribute.buffer);
    if (geometry.index_type != IndexType::none) buffers.insert(geometry.index_buffer);
    return buffers;
}

std::set<std::uint32_t> geometries_of(const Frame& frame, const Pass& pass) {
    std::set<std::uint32_t> geometries;
    for (const DrawPart& part : pass.parts) geometries.insert(part.geometry);
    if (pass.parts.empty())
        for (const std::uint32_t draw : pass.draws) geometries.insert(frame.draws[draw].geometry);
    return geometries;
}

// Of buffers, whole: what is not read of them takes its place all the same.
double total_bytes(const Frame& frame, const std::set<std::uint32_t>& buffers) {
    double bytes = 0;
    for (const std::uint32_t buffer : buffers)
        bytes += static_cast<double>(frame.resources->buffers[buffer].bytes.size());
    return bytes;
}

bool fits(const HostParams& params, const Frame& frame) {
    if (params.vram_mb <= 0 || frame.submission != Submission::buffers) return true;
    std::set<std::uint32_t> used;
    for (const Pass& pass : frame.passes)
        for (const std::uint32_t geometry : geometries_of(frame, pass)) used.merge(buffers_of(frame, geometry));
    return total_bytes(frame, used) <= params.vram_mb * bytes_per_mb;
}

/// Buffers that the draws of a pass have brought into video memory so far.
class BuffersOfPass {
  public:
    /// Bytes that have to come before a draw of this geometry.
    double bring(const Frame& frame, std::uint32_t geometry) {
        std::set<std::uint32_t> missing = buffers_of(frame, geometry);
        std::erase_if(missing, [this](std::uint32_t buffer) { return present_.contains(buffer); });
        const double bytes = total_bytes(frame, missing);
        present_.merge(missing);
        return bytes;
    }

  private:
    std::set<std::uint32_t> present_;
};

void copy_buffers(std::vector<DrawTerms>& terms, const Frame& frame) {
    for (const Pass& pass : frame.passes) {
        if (!pass.parts.empty()) continue; // see range_terms
        BuffersOfPass buffers;
        for (const std::uint32_t draw : pass.draws)
            terms[draw].copied_bytes = buffers.bring(frame, frame.draws[draw].geometry);
    }
}

DrawTerms terms_of(const HostParams& params, const Frame& frame, const Geometry& geometry, const Material& material,
                   std::uint32_t span) {
    DrawTerms terms;
    terms.cpu_us = conversion_us(params, frame, geometry, material);
    if (!needs_span(params, frame)) return terms;
    terms.span = span;
    const double bytes = vertex_bytes(frame, geometry, material);
    terms.feed_us = feed_us(params, frame.submission, geometry, terms.span, bytes);
    if (frame.submission == Submission::buffers) {
        terms.slowdown = span_factor(params, terms.span);
        apply_cliff(terms, params, geometry, bytes);
    }
    return terms;
}

std::uint32_t span_of(const VertexRange& range) { return range.end - range.first; }

} // namespace

double SlotConversion::ns(ComponentType type) const {
    switch (type) {
    case ComponentType::f32:
        return f32_ns;
    case ComponentType::f16:
        return f16_ns;
    case ComponentType::s8:
        return s8_ns;
    case ComponentType::u8:
        return u8_ns;
    case ComponentType::s16:
        return s16_ns;
    case ComponentType::u16:
        return u16_ns;
    case ComponentType::s10_10_10_2:
    case ComponentType::u10_10_10_2:
        return packed_ns;
    case ComponentType::u32:
        break;
    }
    return 0;
}

const SlotConversion& ConversionParams::of(Slot slot) const {
    switch (slot) {
    case Slot::position:
        return position;
    case Slot::normal:
        return normal;
    case Slot::colour:
        return colour;
    case Slot::texcoord:
        return texcoord;
    case Slot::generic:
        break;
    }
    return generic;
}

std::vector<DrawTerms> draw_terms(const HostParams& params, const Frame& frame) {
    std::vector<DrawTerms> list;
    list.reserve(frame.draws.size());
    std::map<std::uint32_t, std::uint32_t> spans; // by geometry: draws share them
    for (const Draw& draw : frame.draws) {
        const Geometry& geometry = frame.resources->geometries[draw.geometry];
        std::uint32_t span = 0;
        if (needs_span(params, frame)) {
            const auto [known, unseen] = spans.try_emplace(draw.geometry, 0);
            if (unseen) known->second = span_of(used_vertices(*frame.resources, geometry));
            span = known->second;
        }
        list.push_back(terms_of(params, frame, geometry, frame.resources->materials[draw.material], span));
    }
    if (!fits(params, frame)) copy_buffers(list, frame);
    return list;
}

std::vector<DrawTerms> range_terms(const HostParams& params, const Frame& frame, std::span<const DrawRange> ranges) {
    const bool all_fit = fits(params, frame), spans = needs_span(params, frame);
    const bool parts = !ranges.empty() && ranges.front().is_part();
    std::vector<DrawTerms> list;
    if (!parts || (all_fit && !spans)) return list;
    list.reserve(ranges.size());
    BuffersOfPass buffers;
    for (const DrawRange& range : ranges) {
        Geometry part = frame.resources->geometries[range.geometry];
        const VertexRange used =
            spans ? used_vertices(*frame.resources, part, 3 * range.first_triangle, 3 * range.primitives)
                  : VertexRange{};
        part.index_count = 3 * range.primitives;
        const Material& material = frame.resources->materials[frame.draws[range.draw].material];
        list.push_back(terms_of(params, frame, part, material, span_of(used)));
        if (!all_fit) list.back().copied_bytes = buffers.bring(frame, range.geometry);
    }
    return list;
}

} // namespace pipeline
