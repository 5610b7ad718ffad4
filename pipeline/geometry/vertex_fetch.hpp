// The vertex fetch unit with its pre-transform cache, between memory and the vertex shaders.
//
// Modelled: the byte ranges of the attributes that the frame reads, cut into lines; lines shared by neighbouring
// attributes of one vertex are looked up once; a line cache whose tags are set when a miss is sent, so that later
// accesses wait for the same fill; bounded misses and vertices on their way; delivery in order; the input port, which
// moves indices, lines and attributes one after the other (input_port.hpp). Sources: specification 004, sections 2.1,
// 5, 9.2; the latency-hiding FIFO between tags and data is that of Igehy, Eldridge, Proudfoot,
// "Prefetching in a Texture Cache Architecture", 1998.
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/geometry/geometry_pass.hpp"
#include "pipeline/geometry/input_port.hpp"
#include "pipeline/geometry/messages.hpp"
#include "pipeline/geometry/vertex_lines.hpp"
#include "pipeline/memory/cache.hpp"
#include "pipeline/memory/messages.hpp"
#include "sim/channel.hpp"

namespace pipeline {

struct VertexFetchParams {
    CacheParams cache{.bytes = 16384, .line = 32, .ways = 4};
    std::uint32_t lines_per_clk = 4;
    std::uint32_t lines_in_flight = 256;
    std::uint32_t vertices_in_flight = 512;
    std::uint32_t hit_latency = 4;
    InputPortParams port = {};

    static constexpr auto fields() {
        using P = VertexFetchParams;
        return std::tuple{
            sim::field<&P::cache>("Pre-transform cache"),
            sim::field<&P::lines_per_clk>("Lines looked up").unit("lines/cycle").range(1, 64),
            sim::field<&P::lines_in_flight>("Lines requested and not arrived").unit("lines").range(1, 65536),
            sim::field<&P::vertices_in_flight>("Vertices looked up and not delivered").unit("vertices").range(1, 65536),
            sim::field<&P::hit_latency>("From the tags to the shader when all lines are held")
                .unit("cycles")
                .range(1, 1000),
            sim::field<&P::port>("Input port")};
    }
};
static_assert(sim::fully_described<VertexFetchParams>);

struct VertexFetchStats {
    CacheStats cache;
    sim::Counter vertices, merged, bytes, port_cycles;
    sim::HighWater vertices_in_flight, lines_in_flight;

    static constexpr auto fields() {
        using S = VertexFetchStats;
        return std::tuple{
            sim::field<&S::cache>("Pre-transform cache; its accesses are lines of vertices"),
            sim::field<&S::vertices>("Vertices delivered").unit("vertices"),
            sim::field<&S::merged>("Hits on lines that were still on their way").unit("accesses"),
            sim::field<&S::bytes>("Bytes requested; misses * line").unit("bytes"),
            sim::field<&S::port_cycles>("Cycles of the input port at work, when it limits").unit("cycles"),
            sim::field<&S::vertices_in_flight>("Most vertices looked up and not delivered").unit("vertices"),
            sim::field<&S::lines_in_flight>("Most lines requested and not arrived").unit("lines")};
    }
};
static_assert(sim::fully_described<VertexFetchStats>);

class VertexFetch final : public sim::Component {
  public:
    using Params = VertexFetchParams;
    using Stats = VertexFetchStats;

    sim::In<VertexRequest> vertices_in{*this, "vertices_in"};
    sim::Out<MemoryRequest> requests_out{*this, "requests_out"};
    sim::In<MemoryResponse> responses_in{*this, "responses_in"};
    sim::Out<VertexTask> vertices_out{*this, "vertices_out"};

    /// @param host what the terms of the draws (GeometryPass::terms) refer to
    VertexFetch(sim::Context context, const Params& params, const GeometryPass& pass, const Needs& needs,
                const HostParams& host = {});

    Stats stats() const;
    const Params& params() const { return params_; }
    /// What the shaders of the passes from now on read; between passes.
    void read(const Needs& needs) { needs_ = needs; }
    /// Empties the pre-transform cache; between passes.
    void drop_cached() { cache_.clear(); }
    /// Bytes requested, by draw; draws not seen may be missing at the end.
    const std::vector<std::uint64_t>& draw_bytes() const { return draw_bytes_; }

  private:
    /// A vertex that has been looked up: complete when fill `last_fill` and all before it have arrived.
    struct Waiting {
        std::uint32_t sequence = 0;
        std::uint64_t last_fill = 0;
        std::uint32_t instructions = 0; ///< of its shader
    };

    sim::Activity tick() override;
    bool take_fills();
    bool deliver();
    bool look_up();
    bool look_up_line(std::uint64_t line);
    void begin_range(std::uint32_t range);
    void begin_vertex(const VertexRequest& request);
    bool pass_port();
    bool deliverable() { return !waiting_.empty() && waiting_.front().last_fill <= filled_; }

    Params params_;
    HostParams host_;
    const GeometryPass* pass_;
    Needs needs_;
    Cache cache_;
    Stats stats_;
    std::vector<std::uint64_t> draw_bytes_;
    VertexLines lines_; ///< of the present range and vertex
    std::uint32_t pass_number_ = 0;
    std::uint32_t range_ = 0;
    std::uint32_t draw_ = 0;

    std::vector<std::uint64_t> fill_of_; ///< by cache slot: the fill that brings its line
    std::vector<bool> here_;             ///< ring over fill numbers: the line has arrived
    std::uint64_t fills_ = 0;            ///< fills requested; they are numbered from 1
    std::uint64_t filled_ = 0;           ///< this fill and all before it have arrived

    FixedQueue<Waiting> waiting_;
    bool holding_ = false; ///< present_ is being looked up
    Waiting present_;
    std::uint64_t port_cost_ = 0; ///< of the present vertex, in parts of a cycle
    InputCost cost_;              ///< of the present range
    std::uint64_t draw_cost_ = 0; ///< of the present range, until its first vertex has paid it
    std::uint64_t port_free_ = 0; ///< when the port has moved what passed it, in parts of cycles
    std::uint64_t port_parts_ = 0;
};

} // namespace pipeline
