#include "pipeline/memory/dram_channel.hpp"

#include "sim/check.hpp"

#include <algorithm>

namespace pipeline {

namespace {
// 1 GB/s is one byte in 10^-9 s = 10^6 fs.
constexpr double fine_per_byte_at_1_gb_per_s = 1e6;
} // namespace

DramChannel::DramChannel(const DramParams& params, double bandwidth, sim::Time cycle)
    : row_bytes_(params.row_bytes),
      latency_(params.latency * cycle * fine_per_time),
      row_miss_(params.row_miss * cycle * fine_per_time),
      per_byte_(static_cast<Fine>(fine_per_byte_at_1_gb_per_s / bandwidth + 0.5)),
      banks_(params.banks) {
    CHECK(bandwidth > 0 && row_bytes_ > 0 && !banks_.empty());
}

DramChannel::Service DramChannel::serve(std::uint64_t local, std::uint32_t bytes, sim::Time arrival) {
    const std::uint64_t row = local / row_bytes_;
    Bank& bank = banks_[row % banks_.size()];
    Service service;
    Fine ready = arrival * fine_per_time;
    service.row_hit = bank.row == row;
    if (!service.row_hit) ready = std::max(ready, bank.free) + row_miss_;
    service.transferred = std::max(ready, bus_free_) + bytes * per_byte_;
    service.done = service.transferred + latency_;
    bus_free_ = service.transferred;
    bank = {row, service.transferred};
    return service;
}

} // namespace pipeline
