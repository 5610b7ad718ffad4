// A memory partition: the controller of one DRAM channel, shared by the crossbar and the ROP partition in front of it.
//
// Modelled: fair arbitration of the two ports, one request a cycle; a bounded queue; bandwidth, rows, order and latency
// of the channel (dram_channel.hpp); seeded latency jitter; reads are answered in the order in which their data cross
// the bus, which keeps that of requests to one row; writes are posted. Not modelled: data; compression.
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/memory/dram_channel.hpp"
#include "pipeline/memory/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

namespace pipeline {

struct MemoryControllerStats {
    sim::Counter requests, reads, writes, row_hits, row_misses;
    std::array<sim::Counter, memory_client_count> bytes{};
    sim::HighWater queued;

    static constexpr auto fields() {
        using S = MemoryControllerStats;
        return std::tuple{
            sim::field<&S::requests>("Requests accepted; reads + writes").unit("requests"),
            sim::field<&S::reads>("Reads").unit("requests"),
            sim::field<&S::writes>("Writes").unit("requests"),
            sim::field<&S::row_hits>("Requests to the open row of their bank; row_hits + row_misses = requests")
                .unit("requests"),
            sim::field<&S::row_misses>("Requests that opened a row").unit("requests"),
            sim::field<&S::bytes>(
                "Bytes moved, by client: index, vertex, texture, kbuffer_read, tile_read, tile_write, "
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
    using Stats = MemoryControllerStats;

    sim::In<MemoryRequest> hub_in{*this, "hub_in"};
    sim::In<MemoryRequest> rop_in{*this, "rop_in"}; ///< may stay unlinked
    sim::Out<MemoryResponse> hub_out{*this, "hub_out"};
    sim::Out<MemoryResponse> rop_out{*this, "rop_out"};

    /// Which addresses lie here: every `partitions`-th block of `interleave` bytes.
    struct Share {
        std::uint32_t partitions = 1;
        std::uint32_t interleave = 256;
        double bandwidth = 12.8; ///< GB/s of this partition
    };

    MemoryController(sim::Context context, const Params& params, const Share& share);

    const Stats& stats() const { return stats_; }
    const Params& params() const { return params_; }
    /// Bytes booked to draw `i`; draws without traffic may be missing at the end.
    const std::vector<MemoryBytes>& draw_bytes() const { return draw_bytes_; }
    /// Cycles of its own clock from the edge that receives a lone read of `bytes` to the edge that sends the answer.
    sim::Cycle unloaded_latency(std::uint32_t bytes) const;

  private:
    struct Answer {
        std::uint32_t tag = 0;
        sim::Cycle ready = 0;
    };
    struct Port {
        sim::In<MemoryRequest>* requests;
        sim::Out<MemoryResponse>* responses;
        FixedQueue<Answer> answers; ///< as large as the queue and the latency can fill
    };
    /// What the channel's id of a waiting request stands for.
    struct Waiting {
        std::uint32_t tag = 0;
        std::uint8_t port = 0;
        bool write = false;
    };
    static constexpr std::size_t hub = 0, rop = 1;

    sim::Activity tick() override;
    bool answer(Port& port);
    bool accept();
    bool transfer();
    void book(const MemoryRequest& request);
    std::uint64_t local_address(std::uint64_t address, std::size_t port) const;
    sim::Activity wait();

    Params params_;
    Stats stats_;
    Share share_;
    DramChannel channel_;
    sim::Random random_;
    std::array<Port, 2> ports_;
    std::size_t turn_ = hub; ///< port that goes first
    std::vector<Waiting> waiting_;
    std::vector<std::uint32_t> free_ids_; ///< unused entries of waiting_
    std::vector<MemoryBytes> draw_bytes_;
};

} // namespace pipeline
