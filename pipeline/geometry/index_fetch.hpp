// The index fetch unit: reads index buffers and cuts them into primitives. And the primitive counter that stands in its
// place when no draw of the frame has an index buffer.
//
// Modelled: whole memory lines, requested ahead in order, across draws, within a bounded buffer; indices consumed per
// cycle; lists of triangles, lines and points, which consume three, two and one new index per primitive; strips, fans
// and loops, which consume one; with primitive restart all indices of the draw are read, restarts and those that make
// no primitive included. Not modelled: a cache of index lines (an instance reads them again). Source: specification
// 004, sections 2.1, 5 (index_fetch_GBps), 9.1.
#pragma once

#include "pipeline/functional/vertex_fetch.hpp"
#include "pipeline/geometry/geometry_pass.hpp"
#include "pipeline/geometry/messages.hpp"
#include "pipeline/memory/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

#include <deque>

namespace pipeline {

struct IndexFetchParams {
    std::uint32_t line = 64;
    std::uint32_t lines_in_flight = 72;
    double bytes_per_clk = 24;
    std::uint32_t primitives_per_clk = 1;

    static constexpr auto fields() {
        using P = IndexFetchParams;
        return std::tuple{
            sim::field<&P::line>("Bytes of a memory request; a power of two").unit("bytes").range(16, 4096),
            sim::field<&P::lines_in_flight>("Lines requested and not used up yet; a triangle may need two")
                .range(2, 4096),
            sim::field<&P::bytes_per_clk>("Index bytes that are read out of the lines")
                .unit("bytes/cycle")
                .range(0.01, 4096),
            sim::field<&P::primitives_per_clk>("Primitives that leave").range(1, 64)};
    }
};
static_assert(sim::fully_described<IndexFetchParams>);

struct IndexFetchStats {
    sim::Counter draws, primitives, indices, lines, bytes;

    static constexpr auto fields() {
        using S = IndexFetchStats;
        return std::tuple{sim::field<&S::draws>("Instances taken").unit("draws"),
                          sim::field<&S::primitives>("Primitives sent").unit("primitives"),
                          sim::field<&S::indices>("Indices read from index buffers").unit("indices"),
                          sim::field<&S::lines>("Lines requested").unit("lines"),
                          sim::field<&S::bytes>("Bytes requested").unit("bytes")};
    }
};
static_assert(sim::fully_described<IndexFetchStats>);

class IndexFetch final : public sim::Component {
  public:
    using Params = IndexFetchParams;
    using Stats = IndexFetchStats;

    sim::In<DrawCommand> draws_in{*this, "draws_in"};
    sim::Out<MemoryRequest> requests_out{*this, "requests_out"};
    sim::In<MemoryResponse> responses_in{*this, "responses_in"};
    sim::Out<IndexedPrimitive> primitives_out{*this, "primitives_out"};

    IndexFetch(sim::Context context, const Params& params, const GeometryPass& pass);

    const Stats& stats() const { return stats_; }
    const Params& params() const { return params_; }
    /// Bytes requested, by draw; draws not seen may be missing at the end.
    const std::vector<std::uint64_t>& draw_bytes() const { return draw_bytes_; }

  private:
    /// A draw between its first request and its last primitive. Lines are numbered over the whole run.
    struct Work {
        PrimitiveReader reader;
        std::uint32_t first_primitive = 0;
        std::uint32_t range = 0;
        std::uint32_t index_bytes = 0; ///< 0: not indexed
        std::uint32_t primitives = 0;
        std::uint32_t end_index = 0; ///< indices of the draw that are read
        std::uint32_t next = 0;      ///< primitive to be sent next
        std::uint32_t read = 0;      ///< indices read out so far
        std::uint32_t reported = 0;  ///< ... that the primitives sent so far have told of
        std::uint64_t address = 0;   ///< of the first line
        std::uint32_t skip = 0;      ///< bytes of the first line before the first index
        std::uint64_t first_line = 0, end_line = 0;
    };

    sim::Activity tick() override;
    Work work_of(std::uint32_t range);
    bool take_lines();
    bool take_draw();
    bool request_lines();
    /// What keeps the next primitive from leaving; busy when nothing does.
    sim::Activity send_primitive();
    /// Reads indices of which no primitive is made, up to `end`; what keeps it from getting there, or busy.
    sim::Activity pass_over(Work& work, std::uint32_t end);
    bool arrived(const Work& work, std::uint32_t index) const;
    bool spend(std::uint32_t bytes);
    void finish_draw();
    std::uint64_t line_of(const Work& work, std::uint32_t index) const;

    Params params_;
    const GeometryPass* pass_;
    Stats stats_;
    std::vector<std::uint64_t> draw_bytes_;
    std::deque<Work> work_;
    std::size_t requesting_ = 0;  ///< of `work_`: whose lines are being requested
    std::vector<bool> here_;      ///< ring over line numbers: the line has arrived
    std::uint64_t lines_ = 0;     ///< number of the first line of the next draw
    std::uint64_t requested_ = 0; ///< lines below are requested,
    std::uint64_t arrived_ = 0;   ///< ... have all arrived,
    std::uint64_t used_up_ = 0;   ///< ... are not needed any more
    std::uint64_t rate_;          ///< index bytes per cycle, in parts of a byte
    std::uint64_t credit_ = 0;    ///< parts of bytes that may be read out now
    sim::Cycle credited_ = 0;     ///< edge up to which credit was given
};

/// Primitives of draws without index buffers: consecutive vertices, from no memory.
class PrimitiveCounter final : public sim::Component {
  public:
    using Stats = IndexFetchStats;

    sim::In<DrawCommand> draws_in{*this, "draws_in"};
    sim::Out<IndexedPrimitive> primitives_out{*this, "primitives_out"};

    PrimitiveCounter(sim::Context context, const GeometryPass& pass) : Component(std::move(context)), pass_(&pass) {}

    const Stats& stats() const { return stats_; }

  private:
    sim::Activity tick() override;

    const GeometryPass* pass_;
    Stats stats_;
    std::uint32_t next_ = 0; ///< primitive to be sent next
};

} // namespace pipeline
