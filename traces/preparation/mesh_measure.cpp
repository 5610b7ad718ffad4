#include "traces/preparation/mesh_measure.hpp"

#include "pipeline/functional/vertex_fetch.hpp"
#include "traces/preparation/triangle_mesh.hpp"

#include <algorithm>
#include <map>
#include <vector>

namespace traces {

using pipeline::Geometry;
using pipeline::Resources;

namespace {

/// The attributes of a geometry as the fetch unit sees them: in order of address, so that neighbours share a line.
class VertexLines {
  public:
    VertexLines(const Resources& resources, const Geometry& geometry) {
        for (const pipeline::VertexAttribute& attribute : geometry.attributes)
            spans_.push_back(
                {resources.buffers[attribute.buffer].address + attribute.offset, attribute.stride, attribute.bytes()});
        std::sort(spans_.begin(), spans_.end(), [](const Span& a, const Span& b) { return a.address < b.address; });
    }
    std::uint64_t bytes() const {
        std::uint64_t sum = 0;
        for (const Span& span : spans_) sum += span.bytes;
        return sum;
    }
    /// Looks every line of a vertex up once.
    void fetch(pipeline::Cache& cache, std::uint32_t vertex) const {
        std::uint64_t next = 0; // lines below it were looked up for the attribute before
        for (const Span& span : spans_) {
            const std::uint64_t first = span.address + std::uint64_t{vertex} * span.stride;
            const std::uint64_t end = cache.line_of(first + span.bytes - 1) + 1;
            std::uint64_t line = cache.line_of(first);
            if (line + 1 == next) ++line;
            for (; line < end; ++line) cache.access(line);
            next = end;
        }
    }

  private:
    struct Span {
        std::uint64_t address = 0;
        std::uint32_t stride = 0, bytes = 0;
    };
    std::vector<Span> spans_;
};

class Measurer {
  public:
    Measurer(const Resources& resources, const pipeline::VertexReuseParams& reuse,
             const pipeline::CacheParams& pre_transform)
        : resources_(resources), reuse_(reuse), cache_(pre_transform, "pre-transform cache") {}

    MeshMeasure measure(const Geometry& geometry) {
        MeshMeasure result;
        result.draws = 1;
        result.index_bytes = std::uint64_t{geometry.index_count} * pipeline::bytes_of(geometry.index_type);
        const std::uint32_t runs = reuse_.runs();
        const std::uint64_t misses = cache_.stats().misses;
        const VertexLines lines(resources_, geometry);
        cache_.clear();
        ++stamp_;
        if (seen_.size() < geometry.vertex_count) seen_.resize(geometry.vertex_count, 0);
        reuse_.begin_draw(geometry.vertex_count, geometry.index_type != pipeline::IndexType::none);
        const pipeline::PrimitiveReader read(resources_, geometry);
        for (std::uint32_t i = 0; i < geometry.triangle_count(); ++i) draw(read(i), lines, result);
        result.vertex_bytes = result.vertices * lines.bytes();
        result.vertex_shader_runs = reuse_.runs() - runs;
        result.lines_fetched = cache_.stats().misses - misses;
        return result;
    }

  private:
    void draw(const std::array<std::uint32_t, 3>& corners, const VertexLines& lines, MeshMeasure& result) {
        ++(names_a_vertex_twice(corners) ? result.degenerate : result.triangles);
        const pipeline::ReuseResult reused = reuse_.triangle(corners);
        for (std::size_t i = 0; i < 3; ++i) {
            if ((reused.missed >> i & 1U) != 0) lines.fetch(cache_, corners[i]);
            if (seen_[corners[i]] == stamp_) continue;
            seen_[corners[i]] = stamp_;
            ++result.vertices;
        }
    }

    const Resources& resources_;
    pipeline::VertexReuseModel reuse_;
    pipeline::Cache cache_;
    std::vector<std::uint32_t> seen_; ///< by vertex: the last geometry that named it
    std::uint32_t stamp_ = 0;
};

void add_draw(MeshMeasure& sum, const MeshMeasure& one) {
    sum.draws += one.draws;
    sum.triangles += one.triangles;
    sum.degenerate += one.degenerate;
    sum.vertices += one.vertices;
    sum.index_bytes += one.index_bytes;
    sum.vertex_bytes += one.vertex_bytes;
    sum.vertex_shader_runs += one.vertex_shader_runs;
    sum.lines_fetched += one.lines_fetched;
}

double ratio(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

} // namespace

MeshMeasure measure_meshes(const Scene& scene, const pipeline::VertexReuseParams& reuse,
                           const pipeline::CacheParams& pre_transform) {
    Measurer measurer(*scene.resources, reuse, pre_transform);
    std::map<std::uint32_t, MeshMeasure> measured; // draws of one geometry cost the same
    MeshMeasure sum;
    for (const pipeline::Draw& draw : scene.draws) {
        const auto [entry, is_new] = measured.try_emplace(draw.geometry);
        if (is_new) entry->second = measurer.measure(scene.resources->geometries[draw.geometry]);
        add_draw(sum, entry->second);
    }
    sum.bytes_fetched = sum.lines_fetched * pre_transform.line;
    sum.acmr = ratio(sum.vertex_shader_runs, sum.triangles);
    sum.atvr = ratio(sum.vertex_shader_runs, sum.vertices);
    sum.overfetch = ratio(sum.bytes_fetched, sum.vertex_bytes);
    return sum;
}

} // namespace traces
