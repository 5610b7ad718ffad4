#include "pipeline/memory/dram_channel.hpp"

#include "sim/check.hpp"

#include <algorithm>

namespace pipeline {

namespace {
// 1 GB/s is one byte in 10^-9 s = 10^6 fs.
constexpr double fine_per_byte_at_1_gb_per_s = 1e6;
} // namespace

DramChannel::DramChannel(const DramParams& params, double bandwidth, sim::Time cycle, std::uint32_t queue)
    : row_bytes_(params.row_bytes),
      overtakes_(params.overtakes),
      cycle_(cycle * fine_per_time),
      latency_(params.latency * cycle_),
      row_miss_(params.row_miss * cycle_),
      per_byte_(static_cast<Fine>(fine_per_byte_at_1_gb_per_s / bandwidth + 0.5)),
      banks_(params.banks) {
    CHECK(bandwidth > 0 && row_bytes_ > 0 && !banks_.empty());
    for (Bank& bank : banks_) bank.requests.reserve(queue);
}

// The sum of the digits of the row number to the base `banks`.
std::uint32_t DramChannel::bank_of_row(std::uint64_t row) const {
    const std::uint64_t banks = banks_.size();
    if (banks == 1) return 0;
    std::uint64_t sum = 0;
    for (; row != 0; row /= banks) sum += row;
    return static_cast<std::uint32_t>(sum % banks);
}

void DramChannel::choose(Bank& bank, sim::Time now) {
    const bool may_overtake = bank.overtakes < overtakes_;
    for (bank.next = 0; bank.next < bank.requests.size(); ++bank.next) {
        if (bank.requests[bank.next].row == bank.row) return;
        if (!may_overtake) break;
    }
    bank.next = 0;
    bank.overtakes = 0;
    bank.row = bank.requests.front().row;
    bank.ready = std::max(now * fine_per_time, bank.free) + row_miss_;
    bank.fresh = true;
}

bool DramChannel::goes_before(const Bank& a, const Bank& b) const {
    const Fine start = start_of(a);
    const Fine other = start_of(b);
    return start != other ? start < other : a.requests[a.next].number < b.requests[b.next].number;
}

void DramChannel::find_first() {
    first_ = nullptr;
    for (Bank& bank : banks_)
        if (!bank.requests.empty() && (first_ == nullptr || goes_before(bank, *first_))) first_ = &bank;
}

void DramChannel::enqueue(std::uint64_t local, std::uint32_t bytes, std::uint32_t id, sim::Time now) {
    const std::uint64_t row = local / row_bytes_;
    Bank& bank = banks_[bank_of_row(row)];
    bank.requests.push_back({row, arrivals_++, bytes, id});
    ++waiting_;
    if (bank.requests.size() > 1) return; // its next request stays what it is
    bank.ready = std::max(bank.ready, now * fine_per_time);
    choose(bank, now);
    if (first_ == nullptr || goes_before(bank, *first_)) first_ = &bank;
}

std::optional<DramChannel::Transfer> DramChannel::transfer(sim::Time now) {
    if (first_ == nullptr || start_of(*first_) >= now * fine_per_time + cycle_) return std::nullopt;
    Bank& bank = *first_;
    const Request request = bank.requests[bank.next];
    bus_free_ = start_of(bank) + request.bytes * per_byte_;
    const Transfer result{request.id, bus_free_, bus_free_ + latency_, !bank.fresh};
    bank.fresh = false;
    bank.free = bus_free_;
    bank.overtakes = bank.next == 0 ? 0 : bank.overtakes + 1;
    bank.requests.erase(bank.requests.begin() + static_cast<std::ptrdiff_t>(bank.next));
    --waiting_;
    if (!bank.requests.empty()) choose(bank, now);
    find_first();
    return result;
}

} // namespace pipeline
