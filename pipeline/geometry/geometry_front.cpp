#include "pipeline/geometry/geometry_front.hpp"

#include "pipeline/memory/memory_system.hpp"
#include "pipeline/memory/unit_report.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace pipeline {

namespace {

constexpr std::uint32_t buffered = 4; ///< cycles' worth of messages that wait between two stages

/// A link of one stage to the next.
sim::ChannelConfig link_of(std::uint32_t width, sim::Cycle latency = 1) {
    return {latency, width, static_cast<std::uint32_t>(width * (latency + buffered))};
}

void expect_within_interleave(const char* key, std::uint32_t line, const MemorySystem& memory) {
    if (line > memory.params().interleave)
        throw sim::InputError(
            fmt::format("{}: expected at most memory.interleave = {}, got {}", key, memory.params().interleave, line));
}

std::uint64_t at_or_zero(const std::vector<std::uint64_t>& values, std::uint32_t index) {
    return index < values.size() ? values[index] : 0;
}

// Indices cost in turn with vertices on this port, or because they cross the bus.
bool indices_pass_port(const InputPortParams& port, const std::vector<DrawTerms>& terms) {
    return port.index_bytes_per_clk > 0 ||
           std::any_of(terms.begin(), terms.end(), [](const DrawTerms& draw) { return draw.host_share > 0; });
}

template <class Stats>
Stats at_or_empty(const std::vector<Stats>& values, std::uint32_t index) {
    return index < values.size() ? values[index] : Stats{};
}

} // namespace

GeometryFront::GeometryFront(sim::Simulation& simulation, const sim::Clock& clock, const GeometryParams& params,
                             const Frame& frame, const Needs& needs, const HostParams& host)
    : frame_(&frame),
      host_(host),
      terms_(draw_terms(host, frame)),
      command_processor_(simulation.context("geometry.command_processor", clock), params.command_processor, pass_,
                         host.frame_us),
      vertex_reuse_(simulation.context("geometry.vertex_reuse", clock), params.vertex_reuse, pass_,
                    indices_pass_port(params.vertex_fetch.port, terms_)),
      vertex_fetch_(simulation.context("geometry.vertex_fetch", clock), params.vertex_fetch, pass_, needs, host),
      vertex_shader_(simulation.context("geometry.vertex_shader", clock), params.vertex_shader),
      primitive_assembly_(simulation.context("geometry.primitive_assembly", clock), params.primitive_assembly),
      clip_cull_(simulation.context("geometry.clip_cull", clock), params.clip_cull, pass_),
      triangle_setup_(simulation.context("geometry.triangle_setup", clock), params.triangle_setup) {
    if (needs.index_buffer)
        index_fetch_ =
            std::make_unique<IndexFetch>(simulation.context("geometry.index_fetch", clock), params.index_fetch, pass_);
    else
        primitive_counter_ =
            std::make_unique<PrimitiveCounter>(simulation.context("geometry.primitive_counter", clock), pass_);
    if (frame.submission != Submission::buffers)
        host_feed_ = std::make_unique<HostFeed>(simulation.context("geometry.host_feed", clock), pass_);
    link_index_path();
    link_vertex_path(params);
}

sim::In<IndexedPrimitive>& GeometryFront::behind_index_path() {
    return host_feed_ != nullptr ? host_feed_->primitives_in : vertex_reuse_.primitives_in;
}

void GeometryFront::link_index_path() {
    if (index_fetch_ != nullptr) {
        connect(command_processor_.draws_out, index_fetch_->draws_in, link_of(1));
        connect(index_fetch_->primitives_out, behind_index_path(), link_of(index_fetch_->params().primitives_per_clk));
    } else {
        connect(command_processor_.draws_out, primitive_counter_->draws_in, link_of(1));
        connect(primitive_counter_->primitives_out, behind_index_path(), link_of(1));
    }
    if (host_feed_ != nullptr)
        connect(host_feed_->primitives_out, vertex_reuse_.primitives_in,
                link_of(index_fetch_ != nullptr ? index_fetch_->params().primitives_per_clk : 1));
}

void GeometryFront::link_vertex_path(const GeometryParams& params) {
    const std::uint32_t shaded = params.vertex_shader.vertices_per_clk();
    const std::uint32_t assembled = params.primitive_assembly.primitives_per_clk;
    connect(vertex_reuse_.vertices_out, vertex_fetch_.vertices_in, link_of(params.vertex_reuse.vertices_per_clk));
    connect(vertex_fetch_.vertices_out, vertex_shader_.vertices_in, link_of(shaded, params.vertex_fetch.hit_latency));
    connect(vertex_shader_.vertices_out, primitive_assembly_.vertices_in, link_of(shaded));
    connect(vertex_reuse_.primitives_out, primitive_assembly_.primitives_in,
            {1, assembled, params.primitive_assembly.primitives_in_flight});
    connect(primitive_assembly_.primitives_out, clip_cull_.primitives_in, link_of(assembled));
    connect(clip_cull_.triangles_out, triangle_setup_.triangles_in, {1, 1, params.triangle_setup.queue});
}

void GeometryFront::attach(MemorySystem& memory) {
    expect_within_interleave("geometry.vertex_fetch.cache.line", vertex_fetch_.params().cache.line, memory);
    if (index_fetch_ != nullptr) {
        expect_within_interleave("geometry.index_fetch.line", index_fetch_->params().line, memory);
        memory.attach(index_fetch_->requests_out, index_fetch_->responses_in);
    }
    memory.attach(vertex_fetch_.requests_out, vertex_fetch_.responses_in);
}

void GeometryFront::start(const FragmentStream& stream, std::span<const Draw> draws, bool switches) {
    start(stream, draws, stream.draws, switches);
}

void GeometryFront::start(const FragmentStream& stream, std::span<const Draw> draws, std::span<const DrawRange> ranges,
                          bool switches) {
    CHECK(draws.size() == terms_.size()); // ranges count the draws of the frame
    range_terms_ = range_terms(host_, *frame_, ranges);
    pass_ = {pass_.number + 1, &stream, frame_->resources.get(), draws, ranges, terms_, range_terms_};
    command_processor_.start(switches);
}

GeometryStats GeometryFront::stats() const {
    return {command_processor_.stats(),
            index_fetch_ != nullptr ? index_fetch_->stats() : primitive_counter_->stats(),
            host_feed_ != nullptr ? host_feed_->stats() : HostFeedStats{},
            vertex_reuse_.stats(),
            vertex_fetch_.stats(),
            vertex_shader_.stats(),
            primitive_assembly_.stats(),
            clip_cull_.stats(),
            triangle_setup_.stats()};
}

GeometryDrawStats GeometryFront::draw_stats(std::uint32_t draw) const {
    const VertexReuseStats reuse = at_or_empty(vertex_reuse_.draw_stats(), draw);
    const ClipCullStats clip = at_or_empty(clip_cull_.draw_stats(), draw);
    const std::uint64_t index_bytes = index_fetch_ == nullptr ? 0 : at_or_zero(index_fetch_->draw_bytes(), draw);
    return {.primitives = reuse.primitives,
            .vertices_referenced = {reuse.hits + reuse.misses},
            .vertex_shader_runs = reuse.misses,
            .culled = {clip.culled()},
            .degenerate = clip.culled_degenerate,
            .clipped = clip.clipped,
            .triangles = clip.triangles,
            .index_bytes = {index_bytes},
            .vertex_bytes = {at_or_zero(vertex_fetch_.draw_bytes(), draw)}};
}

nlohmann::ordered_json GeometryFront::report() const {
    nlohmann::ordered_json report;
    report["command_processor"] = unit_report(command_processor_);
    if (index_fetch_ != nullptr)
        report["index_fetch"] = unit_report(*index_fetch_);
    else
        report["primitive_counter"] = unit_report(*primitive_counter_);
    if (host_feed_ != nullptr) report["host_feed"] = unit_report(*host_feed_);
    report["vertex_reuse"] = unit_report(vertex_reuse_);
    report["vertex_fetch"] = unit_report(vertex_fetch_);
    report["vertex_shader"] = unit_report(vertex_shader_);
    report["primitive_assembly"] = unit_report(primitive_assembly_);
    report["clip_cull"] = unit_report(clip_cull_);
    report["triangle_setup"] = unit_report(triangle_setup_);
    return report;
}

} // namespace pipeline
