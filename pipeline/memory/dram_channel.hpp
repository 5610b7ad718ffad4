// One DRAM channel: which of the waiting requests it transfers next, and when.
//
// Modelled: a data bus of fixed bandwidth that moves whole bursts; banks with one open row each, activated while other
// banks transfer (tRCD, CL, WL, tRP, tRAS, tWR); limits on activations across banks (tRRD, tFAW); the turn of the bus
// between reads and writes; refresh, for which all banks close and stand still. Reads go first; writes gather and move
// in batches. Within a direction the bank that is ready first goes first, and within a bank requests to the open row
// overtake others a bounded number of times. Requests that share a burst keep their order, reads and writes.
// A write that covers a burst in part moves the whole burst under byte enables. Consecutive addresses fill a row; rows
// are spread over the banks by a hash, so that streams at distances of a power of two do not meet in one bank.
// A bank opens the row of its next request at once, but keeps one that the other direction still wants until a request
// of the present batch needs another. Not modelled: the command bus; ranks; the answer of a read from the queue of
// writes; postponed refreshes; a request that crosses the end of a row counts as lying in the one in which it begins.
// Source: Rixner et al., "Memory Access Scheduling", 2000 (first ready, first come first served); the timing of GDDR3
// SDRAM: Qimonda HYB18H512321AF data sheet, 2005.
#pragma once

#include "pipeline/memory/divisor.hpp"
#include "pipeline/memory/memory_params.hpp"
#include "sim/time.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace pipeline {

/// What happened to a channel since its construction.
struct DramEvents {
    std::uint64_t turnarounds = 0;      ///< changes of the direction of the data bus
    std::uint64_t activation_waits = 0; ///< activations that tRRD or tFAW held back
    std::uint64_t refreshes = 0;        ///< that fell due before a transfer
};

class DramChannel {
  public:
    /// Femtoseconds: bandwidths like 12.8 GB/s are whole numbers of them per byte.
    using Fine = std::uint64_t;
    static constexpr Fine fine_per_time = 1000;

    /// `bandwidth` in GB/s of this channel, above 0; `cycle` is the time between two calls of transfer(). At most
    /// `write_queue` writes wait at a time; when there are as many, they go.
    DramChannel(const DramParams& params, double bandwidth, sim::Time cycle, std::uint32_t write_queue);
    DramChannel(const DramChannel&) = delete;
    DramChannel& operator=(const DramChannel&) = delete;

    /// Takes a request of `bytes` at `local`, an address within this channel. `id` comes back from transfer().
    void enqueue(std::uint64_t local, std::uint32_t bytes, bool write, std::uint32_t id, sim::Time now);
    std::uint32_t waiting(bool write) const { return waiting_[write ? 1 : 0]; } ///< requests taken and not transferred
    std::uint32_t waiting() const { return waiting_[0] + waiting_[1]; }

    struct Transfer {
        std::uint32_t id = 0;
        Fine end = 0;         ///< the data has crossed the bus
        bool row_hit = false; ///< the row was open already
    };
    /// The next transfer, if it starts before the clock edge after `now`. Times never decrease.
    std::optional<Transfer> transfer(sim::Time now);
    /// When transfer() may have something again, after it had nothing: not before the edge after its `now`, and no
    /// later than the next transfer. Nothing when nobody waits.
    std::optional<Fine> next_start() const {
        if (waiting() == 0) return std::nullopt;
        return next_;
    }
    Fine bus_free() const { return bus_free_; } ///< end of the last transfer
    const DramEvents& events() const { return events_; }

    /// Whole bursts that the bytes at `address` touch, in bytes.
    std::uint32_t burst_bytes_of(std::uint64_t address, std::uint32_t bytes) const {
        return bursts_of(address, bytes) * static_cast<std::uint32_t>(burst_bytes_.number());
    }
    std::uint32_t bank_of(std::uint64_t local) const { return bank_of_row(row_bytes_.quotient(local)); }
    /// From enqueue() to the end of a lone read whose bank has no open row; `bytes` from the start of a burst.
    Fine unloaded_latency(std::uint32_t bytes) const {
        return rcd_[0] + command_[0] + burst_bytes_of(0, bytes) * per_byte_;
    }

  private:
    static constexpr Fine never = ~Fine{0};
    static constexpr std::uint64_t no_row = ~std::uint64_t{0};

    struct Request {
        std::uint64_t row = 0;
        std::uint64_t number = 0; ///< order of arrival
        std::uint64_t first = 0;  ///< burst of the channel
        Fine earliest = 0;        ///< its data, were its row open
        std::uint32_t bursts = 0;
        std::uint32_t id = 0;
        std::uint32_t waits_for = 0; ///< older requests that share a burst with it and that it might overtake
        std::uint64_t cleared = 0;   ///< requests that had arrived when it had nothing to wait for any more
        std::uint64_t place = 0;     ///< in the order of arrival of its direction
        bool waited_for = false;     ///< by a younger one
        bool holds_read = false;     ///< a write that a read waits for
    };
    enum class Next : std::uint8_t { none, closed, open }; ///< of the row that the next request needs
    struct Bank {
        // What the search for the next transfer looks at comes first.
        Next state = Next::none;
        bool fresh = false;       ///< nobody has used the open row yet
        std::uint32_t next = 0;   ///< of the requests of the present direction
        Fine ready = 0;           ///< Next::open: its data, were the bus free
        std::uint64_t number = 0; ///< of the next request
        Fine activates = 0;       ///< Next::closed: the row may be activated from here on, this bank alone
        std::uint64_t row = no_row;
        Fine activated = 0;                           ///< the open row
        Fine closes = 0;                              ///< the open row may be closed, or if none is, one be activated
        std::array<std::uint32_t, 2> overtakes{};     ///< by direction: requests that have overtaken the oldest one
        std::array<std::vector<Request>, 2> requests; ///< by direction, in order of arrival
    };
    static bool share_a_burst(const Request& a, const Request& b) {
        return a.first < b.first + b.bursts && b.first < a.first + a.bursts;
    }
    std::uint32_t bank_of_row(std::uint64_t row) const;
    void note_conflicts(Bank& bank, Request& request, std::uint32_t direction);
    void release(Bank& bank, const Request& done);
    void clear_one(Request& request, std::uint32_t direction);
    bool keeps_row(const Bank& bank, const Request& wants_another) const;
    void choose(Bank& bank, Fine now);
    std::uint64_t last_of_batch();
    void note_arrival(Request& request, std::uint32_t direction);
    void end_batch(Fine now);
    void turn_to(std::uint32_t direction, Fine now);
    void decide(Fine now);
    Fine activation_limit() const;
    Fine activate_until(Fine end);
    void refresh(Fine now);
    void note_open(Bank& bank) const;
    void find_first();
    Transfer commit(Fine now);

    std::uint32_t bursts_of(std::uint64_t address, std::uint32_t bytes) const {
        const std::uint64_t last = burst_bytes_.quotient(address + bytes - 1);
        return static_cast<std::uint32_t>(last - burst_bytes_.quotient(address) + 1);
    }

    Divisor row_bytes_, burst_bytes_, bank_count_;
    std::uint32_t overtakes_, write_batch_, read_batch_;
    Fine cycle_;
    Fine per_byte_;
    std::array<Fine, 2> rcd_, command_; ///< by direction: activation to command, command to data
    std::array<Fine, 2> turn_;          ///< idle bus before data of this direction that follow others
    Fine rp_, ras_, wr_, rrd_, faw_, refi_, rfc_;
    Fine access_; ///< no way from a refresh to the first data behind it is longer

    Fine bus_free_ = 0;
    Fine next_ = 0;         ///< no transfer starts before; 0: unknown
    Bank* first_ = nullptr; ///< of the banks whose row is open, the one that comes first, while next_ is known
    Fine start_ = 0;        ///< its transfer
    Fine opened_ = 0;       ///< those of the other banks start here or later
    Fine next_refresh_;
    std::array<Fine, 4> activations_{}; ///< the last four + 1 fs each, oldest at activation_; 0: none
    std::uint32_t activation_ = 0;
    std::uint64_t arrivals_ = 0;
    std::array<std::uint32_t, 2> waiting_{};
    std::array<std::uint32_t, 2> eligible_{}; ///< of those, the ones that wait for no other
    std::uint32_t write_queue_;
    std::uint32_t write_bursts_ = 0;          ///< of the waiting writes
    std::uint32_t holding_ = 0;               ///< waiting writes that a read waits for
    std::uint32_t closed_ = 0;                ///< banks whose next request needs another row
    std::uint32_t direction_ = 0;             ///< 1: writes
    std::uint32_t moved_ = 0;                 ///< direction of the last transfer
    std::uint64_t batch_ = 0;                 ///< bursts left of the batch of writes, or of the reads that follow it
    std::uint64_t reach_ = ~std::uint64_t{0}; ///< arrival of the last request that the batch will move
    std::uint64_t passed_ = 0;                ///< bursts of reads that went first while a write waited
    /// Requests of one direction in the order of their arrival, for the bounds of batches.
    struct Arrivals {
        struct Arrival {
            std::uint64_t number = 0;
            std::uint32_t bursts = 0; ///< 0: transferred, or waits for another
            bool gone = false;
        };
        std::uint64_t begin = 0, end = 0;                     ///< places; all before `begin` are gone
        std::vector<Arrival> ring = std::vector<Arrival>(64); ///< by place; a power of two
        Arrival& at(std::uint64_t place) { return ring[place & (ring.size() - 1)]; }
    };
    std::array<Arrivals, 2> arrivals_of_; ///< by direction
    std::vector<Bank> banks_;
    DramEvents events_;
};

} // namespace pipeline
