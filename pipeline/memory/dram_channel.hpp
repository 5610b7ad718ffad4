// One DRAM channel: which of the waiting requests it transfers next, and when.
//
// Modelled: a data bus of fixed bandwidth; banks with one open row each, activated while other banks transfer; the bank
// that is ready first goes first, and within a bank requests to the open row overtake others a bounded number of times;
// a fixed access latency behind the bus. Rows are spread over the banks by a hash, so that streams at distances of a
// power of two do not meet in one bank.
// Not modelled: refresh, read/write turnaround, limits on activations across banks.
// Source: Rixner et al., "Memory Access Scheduling", 2000 (first ready, first come first served).
#pragma once

#include "pipeline/memory/memory_params.hpp"
#include "sim/time.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace pipeline {

class DramChannel {
  public:
    /// Femtoseconds: bandwidths like 12.8 GB/s are whole numbers of them per byte.
    using Fine = std::uint64_t;
    static constexpr Fine fine_per_time = 1000;

    /// `bandwidth` in GB/s of this channel, above 0; `cycle` is the period of the clock that DramParams counts in. At
    /// most `queue` requests wait at a time.
    DramChannel(const DramParams& params, double bandwidth, sim::Time cycle, std::uint32_t queue);
    DramChannel(const DramChannel&) = delete;
    DramChannel& operator=(const DramChannel&) = delete;

    /// Takes a request of `bytes` at `local`, an address within this channel. `id` comes back from transfer().
    void enqueue(std::uint64_t local, std::uint32_t bytes, std::uint32_t id, sim::Time now);
    std::uint32_t waiting() const { return waiting_; } ///< requests taken and not transferred

    struct Transfer {
        std::uint32_t id = 0;
        Fine end = 0;         ///< the data has crossed the bus
        Fine done = 0;        ///< ... and, of a read, is back at the controller
        bool row_hit = false; ///< the row was open already
    };
    /// The next transfer, if it starts before the clock edge after `now`.
    std::optional<Transfer> transfer(sim::Time now);
    /// Start of the next transfer as things stand; nothing when nobody waits.
    std::optional<Fine> next_start() const {
        if (first_ == nullptr) return std::nullopt;
        return start_of(*first_);
    }
    Fine bus_free() const { return bus_free_; } ///< end of the last transfer

    std::uint32_t bank_of(std::uint64_t local) const { return bank_of_row(local / row_bytes_); }
    /// From enqueue() to done of a lone read of a closed row.
    Fine unloaded_latency(std::uint32_t bytes) const { return row_miss_ + bytes * per_byte_ + latency_; }

  private:
    struct Request {
        std::uint64_t row = 0;
        std::uint64_t number = 0; ///< order of arrival
        std::uint32_t bytes = 0;
        std::uint32_t id = 0;
    };
    struct Bank {
        std::vector<Request> requests; ///< in order of arrival
        std::uint64_t row = ~std::uint64_t{0};
        Fine ready = 0;              ///< the open row can be read from here on
        Fine free = 0;               ///< end of the last transfer
        std::size_t next = 0;        ///< of `requests`: the first one to the open row
        std::uint32_t overtakes = 0; ///< requests that have overtaken the oldest one
        bool fresh = false;          ///< nobody has used the open row yet
    };
    std::uint32_t bank_of_row(std::uint64_t row) const;
    /// Finds the next request of a bank, opening its row if none waits for the open one. The bank has requests.
    void choose(Bank& bank, sim::Time now);
    Fine start_of(const Bank& bank) const { return bank.ready > bus_free_ ? bank.ready : bus_free_; }
    bool goes_before(const Bank& a, const Bank& b) const;
    void find_first();

    std::uint64_t row_bytes_;
    std::uint32_t overtakes_;
    Fine cycle_;
    Fine latency_;
    Fine row_miss_;
    Fine per_byte_;
    Fine bus_free_ = 0;
    std::uint64_t arrivals_ = 0;
    std::uint32_t waiting_ = 0;
    std::vector<Bank> banks_;
    Bank* first_ = nullptr; ///< whose next request is transferred next; none: nobody waits
};

} // namespace pipeline
