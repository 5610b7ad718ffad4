// The crossbar between the units that read memory and the memory partitions.
//
// Modelled: address interleaving; one request a cycle into each partition and a bounded number out of each client; per
// partition and per client round-robin arbitration; wire latency (that of its links); a bounded number of reads on
// their way.
// Not modelled: the width of the data wires; the DRAM bus behind them is narrower.
#pragma once

#include "pipeline/memory/divisor.hpp"
#include "pipeline/memory/memory_params.hpp"
#include "pipeline/memory/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"

#include <array>
#include <bit>
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

/// Numbers of clients of a crossbar.
class ClientSet {
  public:
    static constexpr std::uint32_t most = 128; ///< 64 fragment pipes, and the units in front of them

    void clear() { words_ = {}; }
    void add(std::uint32_t client) { words_[client / 64] |= std::uint64_t{1} << client % 64; }
    bool has_several() const { return std::popcount(words_[0]) + std::popcount(words_[1]) > 1; }

    /// The first one at or after `from`, going round; of a set that is not empty.
    std::uint32_t next(std::uint32_t from) const {
        const std::uint32_t word = from / 64;
        if (const std::uint64_t above = words_[word] & ~std::uint64_t{0} << from % 64; above != 0)
            return 64 * word + lowest(above);
        if (word == 0 && words_[1] != 0) return 64 + lowest(words_[1]);
        return words_[0] != 0 ? lowest(words_[0]) : 64 + lowest(words_[1]);
    }

  private:
    static std::uint32_t lowest(std::uint64_t bits) { return static_cast<std::uint32_t>(std::countr_zero(bits)); }

    std::array<std::uint64_t, 2> words_{};
};

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
    /// A new port pair for one more client; at most ClientSet::most.
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
    void grant(std::uint32_t partition, const ClientSet& clients);

    Params params_;
    Stats stats_;
    Divisor interleave_, partition_count_;
    std::vector<std::unique_ptr<ClientPort>> clients_;
    std::vector<std::unique_ptr<PartitionPort>> partitions_;
    std::vector<std::uint32_t> next_client_; ///< per partition: first in turn
    std::uint32_t next_partition_ = 0;       ///< first in turn to answer
    std::vector<Read> reads_;
    std::vector<std::uint32_t> free_reads_;
    std::vector<ClientSet> wanted_; ///< per partition: clients with a request for it, this cycle
};

} // namespace pipeline
