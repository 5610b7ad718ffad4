// A memory partition: the controller of one DRAM channel, shared by the crossbar and the ROP partitions.
//
// Modelled: one request a cycle, from the crossbar and the ROP partitions in turn, and from these in turn; bounded
// queues of reads and writes; bandwidth, rows, order and latency of the channel (dram_channel.hpp); seeded latency
// jitter. The crossbar is answered when the data of a read are back; a ROP partition when they have crossed the bus,
// which is when the array is read or written, with the time they still take (messages.hpp); either in the order in
// which they cross the bus, which keeps that of requests to one address. Writes are posted but for those that ask for
// an answer. Not modelled: data; compression.
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/memory/dram_channel.hpp"
#include "pipeline/memory/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

#include <deque>
#include <vector>

namespace pipeline {

struct MemoryControllerStats {
    sim::Counter requests, reads, writes, row_hits, row_misses, turnarounds, activation_waits, refreshes;
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
            sim::field<&S::turnarounds>("Changes of the direction of the data bus, from reads to writes or back")
                .unit("changes"),
            sim::field<&S::activation_waits>("Rows that were opened later because of tRRD or tFAW").unit("activations"),
            sim::field<&S::refreshes>("Refreshes of all banks that fell due before a transfer").unit("refreshes"),
            sim::field<&S::bytes>(
                "Bytes moved, whole bursts, by client: index, vertex, texture, kbuffer_read, tile_read, tile_write, "
                "copy")
                .unit("bytes"),
            sim::field<&S::queued>("Most requests waiting for the data bus").unit("requests")};
    }
};
static_assert(sim::fully_described<MemoryControllerStats>);

/// Bytes by client.
using MemoryBytes = std::array<std::uint64_t, memory_client_count>;

class MemoryController final : public sim::Component {
    static constexpr std::uint32_t hub = 0; ///< port; the others are those of ROP partitions
    sim::InputSet held_;                    ///< by port

  public:
    using Params = MemoryControllerParams;
    using Stats = MemoryControllerStats;

    sim::In<MemoryRequest> hub_in{*this, "hub_in", held_, hub};
    sim::Out<MemoryResponse> hub_out{*this, "hub_out"};
    struct RopPort {
        RopPort(sim::Component& owner, sim::InputSet& held, std::uint32_t port)
            : requests_in(owner, "rop_in", held, port), responses_out(owner, "rop_out") {}
        sim::In<MemoryRequest> requests_in;
        sim::Out<MemoryResponse> responses_out;
    };

    /// Which addresses lie here: every `partitions`-th block of `interleave` bytes.
    struct Share {
        std::uint32_t partitions = 1;
        std::uint32_t interleave = 256;
        double bandwidth = 12.8;   ///< GB/s of this partition
        sim::Time core_period = 0; ///< of the cycles in which the way on the chip is counted; 0: its own clock
    };

    MemoryController(sim::Context context, const Params& params, const Share& share);

    /// A new port pair for one more ROP partition; at most 254.
    RopPort& add_rop();

    Stats stats() const;
    const Params& params() const { return params_; }
    /// Bytes booked to draw `i`; draws without traffic may be missing at the end.
    const std::vector<MemoryBytes>& draw_bytes() const { return draw_bytes_; }
    /// Cycles of its own clock from the edge that receives a lone read of `bytes`, its bank closed, to the edge that
    /// sends its data. The request latency lies in front of the port (MemorySystem).
    sim::Cycle unloaded_latency(std::uint32_t bytes) const;

  private:
    struct Answer {
        std::uint32_t tag = 0;
        sim::Cycle ready = 0; ///< is sent at this edge or later
        sim::Time back = 0;   ///< the data are here
    };
    struct Port {
        sim::In<MemoryRequest>* requests;
        sim::Out<MemoryResponse>* responses;
        FixedQueue<Answer> answers; ///< as large as the queue and the latency can fill
        sim::Time back = 0;         ///< of the last read
    };
    /// What the channel's id of a waiting request stands for.
    struct Waiting {
        std::uint32_t tag = 0;
        std::uint8_t port = 0;
        bool write = false;
        bool notify = false;
    };
    sim::Activity tick() override;
    bool answer(Port& port);
    bool accept();
    bool accept_from(std::uint32_t index);
    bool transfer();
    void note_answer(const Waiting& request, const DramChannel::Transfer& transfer);
    void book(const MemoryRequest& request);
    std::uint64_t local_address(std::uint64_t address) const;
    sim::Activity wait();

    Params params_;
    Stats stats_;
    Divisor interleave_, partitions_;
    sim::Time core_period_;
    DramChannel channel_;
    sim::Random random_;
    std::deque<RopPort> rops_;
    std::vector<Port> ports_;
    bool hub_first_ = true;      ///< the crossbar's turn
    std::uint32_t rop_turn_ = 1; ///< port of the ROP partition that goes first
    std::vector<Waiting> waiting_;
    std::vector<std::uint32_t> free_ids_; ///< unused entries of waiting_
    std::vector<MemoryBytes> draw_bytes_;
};

} // namespace pipeline
