// A memory partition: the controller of one DRAM channel, shared by the crossbar and the ROP partition in front of it.
//
// Modelled: fair arbitration of the two ports, one request a cycle; a bounded queue; bandwidth, rows and latency of the
// channel (dram_channel.hpp); seeded latency jitter; reads are answered in order of arrival, writes are posted.
// Not modelled: reordering, read/write turnaround, compression.
#pragma once

#include "pipeline/memory/dram_channel.hpp"
#include "pipeline/memory/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

namespace pipeline {

struct MemoryControllerParams {
    std::uint32_t queue         = 64;
    std::uint32_t jitter_cycles = 0;
    DramParams    dram;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&MemoryControllerParams::queue>("Requests that wait for the data bus").range(1, 65536),
            sim::field<&MemoryControllerParams::jitter_cycles>("Random extra latency of a read: 0 to this many")
                .unit("cycles")
                .at_most(100000),
            sim::field<&MemoryControllerParams::dram>("DRAM channel")};
    }
};
static_assert(sim::fully_described<MemoryControllerParams>);

struct MemoryControllerStats {
    sim::Counter                                  requests, reads, writes, row_hits, row_misses;
    std::array<sim::Counter, memory_client_count> bytes{};
    sim::HighWater                                queued;

    static constexpr auto fields() {
        using S = MemoryControllerStats;
        return std::tuple{
            sim::field<&S::requests>("Requests accepted; reads + writes").unit("requests"),
            sim::field<&S::reads>("Reads").unit("requests"),
            sim::field<&S::writes>("Writes").unit("requests"),
            sim::field<&S::row_hits>("Requests to the open row of their bank; row_hits + row_misses = requests")
                .unit("requests"),
            sim::field<&S::row_misses>("Requests that opened a row").unit("requests"),
            sim::field<&S::bytes>("Bytes moved, by client: index, vertex, texture, kbuffer_read, tile_read, tile_write, "
                                  "copy")
                .unit("bytes"),
            sim::field<&S::queued>("Most requests waiting for the data bus").unit("requests")};
    }
};
static_assert(sim::fully_described<MemoryControllerStats>);

/// Bytes by client.
using MemoryBytes = std::array<std::uint64_t, memory_client_count>;

class MemoryController final : public sim::Component {
  public:
    using Params = MemoryControllerParams;
    using Stats  = MemoryControllerStats;

    sim::In<MemoryRequest>   hub_in{*this, "hub_in"};
    sim::In<MemoryRequest>   rop_in{*this, "rop_in"}; ///< may stay unlinked
    sim::Out<MemoryResponse> hub_out{*this, "hub_out"};
    sim::Out<MemoryResponse> rop_out{*this, "rop_out"};

    /// Which addresses lie here: every `partitions`-th block of `interleave` bytes.
    struct Share {
        std::uint32_t partitions = 1;
        std::uint32_t interleave = 256;
        double        bandwidth  = 12.8; ///< GB/s of this partition
    };

    MemoryController(sim::Context context, const Params& params, const Share& share);

    const Stats&  stats() const { return stats_; }
    const Params& params() const { return params_; }
    /// Bytes booked to draw `i`; draws without traffic may be missing at the end.
    const std::vector<MemoryBytes>& draw_bytes() const { return draw_bytes_; }
    /// Cycles of its own clock from the edge that receives a lone read of `bytes` to the edge that sends the answer.
    sim::Cycle unloaded_latency(std::uint32_t bytes) const;

  private:
    /// Answers on their way, in order; a ring that is as large as the queue and the latency can fill.
    class Answers {
      public:
        explicit Answers(std::size_t capacity);
        bool                           empty() const { return head_ == tail_; }
        bool                           full() const { return tail_ - head_ > mask_; }
        void                           push(std::uint32_t tag, sim::Cycle ready);
        const std::pair<std::uint32_t, sim::Cycle>& front() const { return ring_[head_ & mask_]; }
        void                                        pop() { ++head_; }

      private:
        std::uint64_t                                     mask_;
        std::uint64_t                                     head_ = 0, tail_ = 0;
        sim::Cycle                                        last_ = 0;
        std::vector<std::pair<std::uint32_t, sim::Cycle>> ring_;
    };

    sim::Activity tick() override;
    bool          answer(Answers& answers, sim::Out<MemoryResponse>& out);
    void          forget_transferred();
    bool          accept();
    void          serve(const MemoryRequest& request, Answers& answers);
    void          book(const MemoryRequest& request);
    sim::Activity wait();

    Params                   params_;
    Stats                    stats_;
    Share                    share_;
    DramChannel              channel_;
    sim::Random              random_;
    Answers                  hub_answers_, rop_answers_;
    std::vector<sim::Cycle>  queue_; ///< ring of the edges at which the queued requests are transferred
    std::uint64_t            queue_head_ = 0, queue_tail_ = 0;
    bool                     rop_first_ = false;
    std::vector<MemoryBytes> draw_bytes_;
};

} // namespace pipeline
