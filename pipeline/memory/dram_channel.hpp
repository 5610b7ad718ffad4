// One DRAM channel: when each of its requests, served in order of arrival, is done.
//
// Modelled: a data bus of fixed bandwidth; banks with one open row each; the penalty of opening another row, which is
// hidden behind the transfers of earlier requests to other banks; a fixed access latency.
// Not modelled: refresh, read/write turnaround, reordering by row (README.md).
#pragma once

#include "sim/described.hpp"
#include "sim/time.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace pipeline {

struct DramParams {
    std::uint32_t latency = 226;
    std::uint32_t row_miss = 28;
    std::uint32_t row_bytes = 2048;
    std::uint32_t banks = 8;

    static constexpr auto fields() {
        return std::tuple{
            sim::field<&DramParams::latency>("Access latency of a read, without the row penalty and the transfer")
                .unit("cycles")
                .range(1, 100000),
            sim::field<&DramParams::row_miss>("Time to close a row and open another one")
                .unit("cycles")
                .range(0, 100000),
            sim::field<&DramParams::row_bytes>("Bytes of a row; a power of two").unit("bytes").range(64, 1U << 20U),
            sim::field<&DramParams::banks>("Banks of a channel, one open row each").unit("banks").range(1, 1024)};
    }
};
static_assert(sim::fully_described<DramParams>);

class DramChannel {
  public:
    /// Femtoseconds: bandwidths like 12.8 GB/s are whole numbers of them per byte.
    using Fine = std::uint64_t;
    static constexpr Fine fine_per_time = 1000;

    /// `bandwidth` in GB/s of this channel, above 0; `cycle` is the period of the clock that DramParams counts in.
    DramChannel(const DramParams& params, double bandwidth, sim::Time cycle);

    struct Service {
        Fine transferred = 0; ///< the data has crossed the bus: the request leaves the controller's queue
        Fine done = 0;        ///< a read's data is back at the controller
        bool row_hit = false;
    };
    /// Serves a request of `bytes` at `local`, an address within this channel; arrivals never go back in time.
    Service serve(std::uint64_t local, std::uint32_t bytes, sim::Time arrival);

    /// From arrival to done of the first read of a row, the bus being free.
    Fine unloaded_latency(std::uint32_t bytes) const { return row_miss_ + bytes * per_byte_ + latency_; }

  private:
    struct Bank {
        std::uint64_t row = ~std::uint64_t{0};
        Fine free = 0; ///< end of the last transfer from the open row
    };
    std::uint64_t row_bytes_;
    Fine latency_;
    Fine row_miss_;
    Fine per_byte_;
    Fine bus_free_ = 0;
    std::vector<Bank> banks_;
};

} // namespace pipeline
