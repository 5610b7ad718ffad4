// Everything behind the units' memory ports: the partitions, and the crossbar if a unit needs it.
//
// A client of the crossbar calls attach(); a ROP partition, which has wires of its own to every memory partition, calls
// attach_rop(). Both see one map of addresses: `interleave` consecutive bytes lie in one partition, the next ones in
// the next. A client must always be able to take the answers to what it asked for, or the memory behind it stops.
#pragma once

#include "pipeline/memory/memory_controller.hpp"
#include "pipeline/memory/memory_hub.hpp"

#include <memory>
#include <nlohmann/json_fwd.hpp>

namespace pipeline {

class MemorySystem {
  public:
    /// Components are named "memory.hub" and "memory.partition0"...
    MemorySystem(sim::Simulation& simulation, const sim::Clock& core, const MemoryParams& params);

    /// Links a client to the crossbar. A request of such a client must lie within one interleave block.
    void attach(sim::Out<MemoryRequest>& requests, sim::In<MemoryResponse>& responses);
    /// Links ROP partition `rop` to all memory partitions: element i of each deque to partition i. A request must lie
    /// within one interleave block of that partition. ROP partitions are attached in the order of their numbers.
    void attach_rop(std::uint32_t rop, std::vector<sim::Out<MemoryRequest>>& requests,
                    std::vector<sim::In<MemoryResponse>>& responses);

    std::uint32_t partitions() const { return params_.partitions; }
    /// The partition in which `address` lies.
    std::uint32_t partition_of(std::uint64_t address) const;
    const MemoryParams& params() const { return params_; }

    bool has_hub() const { return hub_ != nullptr; }
    /// Core cycles from the send of a lone read of `bytes` by a client of the crossbar (or by a ROP partition) to the
    /// edge at which its answer can be received, the row being closed and the partitions on the core clock.
    sim::Cycle unloaded_latency(std::uint32_t bytes) const;
    sim::Cycle unloaded_rop_latency(std::uint32_t bytes) const;

    MemoryHubStats hub_stats() const;               ///< zeros without a crossbar
    MemoryControllerStats controller_stats() const; ///< sum over the partitions
    MemoryControllerStats partition_stats(std::uint32_t partition) const;
    /// Bytes booked to a draw, by client, over all partitions.
    MemoryBytes draw_bytes(std::uint32_t draw) const;
    /// "memory_hub" (if built) and "memory_partition": params, counters, activity in cycles, units summed.
    nlohmann::ordered_json report() const;

  private:
    MemoryHub& hub();

    sim::Simulation& simulation_;
    const sim::Clock& core_;
    const sim::Clock* clock_;
    MemoryParams params_;
    MemoryController::Share share_;
    std::uint32_t rops_ = 0; ///< attached
    std::unique_ptr<MemoryHub> hub_;
    std::vector<std::unique_ptr<MemoryController>> controllers_;
};

} // namespace pipeline
