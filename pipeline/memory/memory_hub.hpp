// The crossbar between the units that read memory and the memory partitions.
//
// Modelled: address interleaving; one request a cycle into each partition and a bounded number out of each client; per
// partition and per client round-robin arbitration; wire latency (that of its links); a bounded number of reads on
// their way.
// Not modelled: the width of the data wires; the DRAM bus behind them is narrower.
#pragma once

#include "pipeline/memory/memory_params.hpp"
#include "pipeline/memory/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

#include <memory>
#include <vector>

namespace pipeline {

struct MemoryHubStats {
    sim::Counter requests, responses, conflicts;
    sim::HighWater reads_in_flight;

    static constexpr auto fields() {
        using S = MemoryHubStats;
        return std::tuple{
            sim::field<&S::requests>("Requests passed on").unit("requests"),
            sim::field<&S::responses>("Answers passed on").unit("responses"),
            sim::field<&S::conflicts>("Grants given while another client wanted the same partition").unit("grants"),
            sim::field<&S::reads_in_flight>("Most reads on their way").unit("requests")};
    }
};
static_assert(sim::fully_described<MemoryHubStats>);

class MemoryHub final : public sim::Component {
  public:
    using Params = MemoryHubParams;
    using Stats = MemoryHubStats;

    MemoryHub(sim::Context context, const Params& params, std::uint32_t partitions, std::uint32_t interleave);

    struct ClientPort {
        explicit ClientPort(sim::Component& owner)
            : requests_in(owner, "requests_in"), responses_out(owner, "responses_out") {}
        sim::In<MemoryRequest> requests_in;
        sim::Out<MemoryResponse> responses_out;
    };
    struct PartitionPort {
        explicit PartitionPort(sim::Component& owner)
            : requests_out(owner, "requests_out"), responses_in(owner, "responses_in") {}
        sim::Out<MemoryRequest> requests_out;
        sim::In<MemoryResponse> responses_in;
    };
    /// A new port pair for one more client; at most 64 clients.
    ClientPort& add_client();
    PartitionPort& partition(std::uint32_t index) { return *partitions_[index]; }

    std::uint32_t partition_of(std::uint64_t address) const;
    const Stats& stats() const { return stats_; }
    const Params& params() const { return params_; }

  private:
    /// Who asked, while its read is with a partition, which sees the index into `reads_` as tag.
    struct Read {
        std::uint32_t tag = 0;
        std::uint32_t client = 0;
    };
    sim::Activity tick() override;
    bool pass_responses();
    bool pass_requests(bool& waiting);
    void grant(std::uint32_t partition, std::uint64_t clients);

    Params params_;
    Stats stats_;
    std::uint32_t interleave_;
    std::vector<std::unique_ptr<ClientPort>> clients_;
    std::vector<std::unique_ptr<PartitionPort>> partitions_;
    std::vector<std::uint32_t> next_client_; ///< per partition: first in turn
    std::uint32_t next_partition_ = 0;       ///< first in turn to answer
    std::vector<Read> reads_;
    std::vector<std::uint32_t> free_reads_;
    std::vector<std::uint64_t> wanted_; ///< per partition: clients with a request for it, this cycle
};

} // namespace pipeline
