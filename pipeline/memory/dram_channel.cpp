#include "pipeline/memory/dram_channel.hpp"

#include "sim/check.hpp"

#include <algorithm>
#include <utility>

namespace pipeline {

namespace {

// 1 GB/s is one byte in 10^-9 s = 10^6 fs.
constexpr double fine_per_byte_at_1_gb_per_s = 1e6;

DramChannel::Fine fine_of_ns(double ns) { return static_cast<DramChannel::Fine>(ns * 1e6 + 0.5); }

constexpr std::uint32_t reads = 0, writes = 1; ///< directions

} // namespace

DramChannel::DramChannel(const DramParams& params, double bandwidth, sim::Time cycle, std::uint32_t write_queue)
    : row_bytes_(params.row_bytes),
      burst_bytes_(params.burst_bytes),
      bank_count_(params.banks),
      overtakes_(params.overtakes),
      write_batch_(params.write_batch),
      read_batch_(params.read_batch),
      cycle_(cycle * fine_per_time),
      per_byte_(static_cast<Fine>(fine_per_byte_at_1_gb_per_s / bandwidth + 0.5)),
      rcd_{fine_of_ns(params.rcd_read_ns), fine_of_ns(params.rcd_write_ns)},
      command_{fine_of_ns(params.cl_ns), fine_of_ns(params.wl_ns)},
      turn_{fine_of_ns(params.wtr_ns + params.cl_ns), fine_of_ns(params.rtw_ns)},
      rp_(fine_of_ns(params.rp_ns)),
      ras_(fine_of_ns(params.ras_ns)),
      wr_(fine_of_ns(params.wr_ns)),
      rrd_(fine_of_ns(params.rrd_ns)),
      faw_(fine_of_ns(params.faw_ns)),
      refi_(fine_of_ns(params.refi_ns)),
      rfc_(fine_of_ns(params.rfc_ns)),
      access_(rrd_ + faw_ + std::max(turn_[reads], turn_[writes]) +
              std::max(rcd_[reads] + command_[reads], rcd_[writes] + command_[writes]) + 1),
      next_refresh_(refi_ == 0 ? never : refi_),
      write_queue_(write_queue),
      banks_(params.banks) {
    CHECK(bandwidth > 0);
    for (Bank& bank : banks_)
        for (auto& requests : bank.requests) requests.reserve(write_queue);
}

// The sum of the digits of the row number to the base `banks`.
std::uint32_t DramChannel::bank_of_row(std::uint64_t row) const {
    if (bank_count_.number() == 1) return 0;
    std::uint64_t sum = 0;
    for (; row != 0; row = bank_count_.quotient(row)) sum += row;
    return static_cast<std::uint32_t>(bank_count_.remainder(sum));
}

// Order to one address: what shares a burst with an older request of the other direction waits for it. Those of one
// direction keep their order as they lie in one row, unless the older one waits itself.
void DramChannel::note_conflicts(Bank& bank, Request& request, std::uint32_t direction) {
    for (Request& older : bank.requests[1 - direction]) {
        if (!share_a_burst(older, request)) continue;
        ++request.waits_for;
        older.waited_for = true;
        if (direction == reads && !std::exchange(older.holds_read, true)) ++holding_;
    }
    if (waiting_[direction] == eligible_[direction]) return;
    for (Request& older : bank.requests[direction]) {
        if (older.waits_for == 0 || !share_a_burst(older, request)) continue;
        ++request.waits_for;
        older.waited_for = true;
    }
}

void DramChannel::clear_one(Request& request, std::uint32_t direction) {
    if (--request.waits_for != 0) return;
    request.cleared = arrivals_;
    arrivals_of_[direction].at(request.place).bursts = request.bursts;
    ++eligible_[direction];
}

void DramChannel::release(Bank& bank, const Request& done) {
    if (done.holds_read) --holding_;
    for (Request& younger : bank.requests[1 - direction_])
        if (younger.number > done.number && share_a_burst(younger, done)) clear_one(younger, 1 - direction_);
    for (Request& younger : bank.requests[direction_])
        if (younger.number > done.number && younger.number < done.cleared && share_a_burst(younger, done))
            clear_one(younger, direction_);
}

bool DramChannel::keeps_row(const Bank& bank, const Request& wants_another) const {
    if (wants_another.number <= reach_ || bank.row == no_row) return false;
    const std::vector<Request>& others = bank.requests[1 - direction_];
    return std::any_of(others.begin(), others.end(), [&](const Request& other) { return other.row == bank.row; });
}

// Finds the next request of a bank in the present direction, and closes the open row if none waits for it.
void DramChannel::choose(Bank& bank, Fine now) {
    const std::vector<Request>& requests = bank.requests[direction_];
    const bool may_overtake = bank.overtakes[direction_] < overtakes_;
    auto oldest = static_cast<std::uint32_t>(requests.size());
    if (bank.state == Next::closed) --closed_;
    bank.state = Next::none;
    for (std::uint32_t i = 0; i < requests.size(); ++i) {
        if (requests[i].waits_for != 0) continue;
        if (requests[i].row == bank.row) {
            bank.next = i;
            bank.state = Next::open;
            note_open(bank);
            return;
        }
        oldest = std::min(oldest, i);
        if (!may_overtake) break;
    }
    if (oldest == requests.size() || keeps_row(bank, requests[oldest])) return;
    bank.next = oldest;
    bank.state = Next::closed;
    ++closed_;
    bank.activates = std::max(now, bank.closes) + (bank.row == no_row ? 0 : rp_);
}

void DramChannel::turn_to(std::uint32_t direction, Fine now) {
    direction_ = direction;
    next_ = 0;
    batch_ = write_batch_;
    passed_ = 0;
    reach_ = last_of_batch();
    for (Bank& bank : banks_) choose(bank, now);
}

// The arrival of the request with which a batch is full, in order; without end if so many do not wait.
std::uint64_t DramChannel::last_of_batch() {
    Arrivals& arrivals = arrivals_of_[direction_];
    while (arrivals.begin != arrivals.end && arrivals.at(arrivals.begin).gone) ++arrivals.begin;
    std::uint64_t left = batch_;
    for (std::uint64_t place = arrivals.begin; place != arrivals.end; ++place) {
        const Arrivals::Arrival& arrival = arrivals.at(place);
        if (arrival.bursts >= left) return arrival.number;
        left -= arrival.bursts;
    }
    return ~std::uint64_t{0};
}

void DramChannel::note_arrival(Request& request, std::uint32_t direction) {
    Arrivals& arrivals = arrivals_of_[direction];
    if (arrivals.end - arrivals.begin == arrivals.ring.size()) {
        while (arrivals.begin != arrivals.end && arrivals.at(arrivals.begin).gone) ++arrivals.begin;
        if (arrivals.end - arrivals.begin == arrivals.ring.size()) {
            std::vector<Arrivals::Arrival> wider(2 * arrivals.ring.size());
            for (std::uint64_t place = arrivals.begin; place != arrivals.end; ++place)
                wider[place & (wider.size() - 1)] = arrivals.at(place);
            arrivals.ring = std::move(wider);
        }
    }
    request.place = arrivals.end++;
    arrivals.at(request.place) = {request.number, request.waits_for == 0 ? request.bursts : 0, false};
}

// The direction stays what it is: every row may be opened.
void DramChannel::end_batch(Fine now) {
    if (std::exchange(reach_, ~std::uint64_t{0}) == ~std::uint64_t{0}) return;
    next_ = 0;
    for (Bank& bank : banks_)
        if (bank.state == Next::none) choose(bank, now);
}

// Reads go first. Writes go when none waits, or, after as many reads as they were, when a batch of them has gathered,
// their queue is full, a read waits for one of them, or enough reads have passed.
void DramChannel::decide(Fine now) {
    if (eligible_[1 - direction_] == 0) {
        if (batch_ == 0 && direction_ == writes) batch_ = write_batch_;
        return end_batch(now);
    }
    if (eligible_[direction_] == 0) return turn_to(1 - direction_, now);
    if (batch_ != 0) return;
    if (direction_ == writes || write_bursts_ >= write_batch_ || waiting_[writes] >= write_queue_ || holding_ != 0 ||
        passed_ >= read_batch_)
        return turn_to(1 - direction_, now);
    end_batch(now);
}

// When tRRD and tFAW allow the next activation.
DramChannel::Fine DramChannel::activation_limit() const {
    const Fine fourth_last = activations_[activation_];
    const Fine last = activations_[(activation_ + 3) % 4];
    return std::max(fourth_last == 0 ? 0 : fourth_last - 1 + faw_, last == 0 ? 0 : last - 1 + rrd_);
}

// Activates rows, in the order in which their banks allow it, before `end`; returns when the next one may be activated.
DramChannel::Fine DramChannel::activate_until(Fine end) {
    while (closed_ != 0) {
        Bank* first = nullptr;
        for (Bank& bank : banks_)
            if (bank.state == Next::closed && (first == nullptr || bank.activates < first->activates)) first = &bank;
        const Fine limit = activation_limit();
        const Fine at = std::max(first->activates, limit);
        if (at >= end) return at;
        if (limit > first->activates) ++events_.activation_waits;
        first->row = first->requests[direction_][first->next].row;
        first->activated = at;
        first->closes = at + ras_;
        first->overtakes[direction_] = 0;
        first->state = Next::open;
        --closed_;
        first->fresh = true;
        note_open(*first);
        activations_[activation_] = at + 1;
        activation_ = (activation_ + 1) % 4;
    }
    return never;
}

// All banks close, stand still for tRFC, and open their rows again.
void DramChannel::refresh(Fine now) {
    Fine begin = next_refresh_;
    for (const Bank& bank : banks_) begin = std::max(begin, bank.closes + (bank.row == no_row ? 0 : rp_));
    const Fine end = begin + rfc_;
    for (Bank& bank : banks_) {
        bank.row = no_row;
        bank.closes = end;
        choose(bank, std::max(now, end));
    }
    // One that came late, behind rows that had to close, leaves time for an access before the next: devices let
    // refreshes be postponed (JEDEC), and nothing would be moved between refreshes that follow each other at once.
    next_refresh_ = std::max(next_refresh_ + refi_, end + access_);
    next_ = 0;
    ++events_.refreshes;
}

void DramChannel::note_open(Bank& bank) const {
    const Request& request = bank.requests[direction_][bank.next];
    bank.ready = std::max(bank.activated + rcd_[direction_] + command_[direction_], request.earliest);
    bank.number = request.number;
}

// Of the banks whose row is open, the one that is ready first; of those that wait for the bus, the oldest request.
void DramChannel::find_first() {
    const Fine bus = bus_free_ + (direction_ == moved_ ? 0 : turn_[direction_]);
    first_ = nullptr;
    start_ = never;
    for (Bank& bank : banks_) {
        if (bank.state != Next::open) continue;
        const Fine start = std::max(bus, bank.ready);
        if (start > start_ || (start == start_ && bank.number > first_->number)) continue;
        first_ = &bank;
        start_ = start;
    }
}

DramChannel::Transfer DramChannel::commit(Fine now) {
    Bank& bank = *first_;
    const Request request = bank.requests[direction_][bank.next];
    bus_free_ = start_ + Fine{request.bursts} * burst_bytes_.number() * per_byte_;
    next_ = 0;
    if (direction_ != moved_) ++events_.turnarounds;
    moved_ = direction_;
    const Transfer result{request.id, bus_free_, !bank.fresh};
    bank.fresh = false;
    // A read leaves its row CL before its data leave the device.
    const Fine closes = direction_ == writes ? bus_free_ + wr_ : bus_free_ - std::min(bus_free_, command_[reads]);
    bank.closes = std::max(bank.closes, closes);
    bank.overtakes[direction_] = bank.next == 0 ? 0 : bank.overtakes[direction_] + 1;
    auto& requests = bank.requests[direction_];
    requests.erase(requests.begin() + static_cast<std::ptrdiff_t>(bank.next));
    arrivals_of_[direction_].at(request.place) = {request.number, 0, true};
    --waiting_[direction_];
    --eligible_[direction_];
    batch_ -= std::min<std::uint64_t>(batch_, request.bursts);
    if (direction_ == writes) write_bursts_ -= request.bursts;
    if (direction_ == reads) passed_ = waiting_[writes] == 0 ? 0 : passed_ + request.bursts;
    if (request.waited_for) release(bank, request);
    choose(bank, now);
    decide(now);
    return result;
}

void DramChannel::enqueue(std::uint64_t local, std::uint32_t bytes, bool write, std::uint32_t id, sim::Time time) {
    const std::uint32_t direction = write ? writes : reads;
    const Fine now = time * fine_per_time;
    activate_until(std::min(now, next_refresh_)); // before what this request changes
    Request request;
    request.row = row_bytes_.quotient(local);
    request.number = arrivals_++;
    request.first = burst_bytes_.quotient(local);
    request.earliest = now + command_[direction];
    request.bursts = bursts_of(local, bytes);
    request.id = id;
    Bank& bank = banks_[bank_of_row(request.row)];
    if (!bank.requests[0].empty() || !bank.requests[1].empty()) note_conflicts(bank, request, direction);
    note_arrival(request, direction);
    ++waiting_[direction];
    if (request.waits_for == 0) ++eligible_[direction];
    if (write) write_bursts_ += request.bursts;
    bank.requests[direction].push_back(request);
    if (direction == direction_ && bank.state == Next::none) {
        choose(bank, now);
        next_ = 0;
    }
    decide(now);
}

std::optional<DramChannel::Transfer> DramChannel::transfer(sim::Time time) {
    if (waiting() == 0) return std::nullopt;
    const Fine now = time * fine_per_time;
    const Fine end = now + cycle_;
    if (next_ >= end) return std::nullopt;
    while (true) {
        const Fine activates = activate_until(std::min(end, next_refresh_));
        if (next_ == 0 || start_ >= opened_) find_first();
        if (start_ < end && start_ < next_refresh_) return commit(now);
        if (end > next_refresh_) {
            refresh(now);
            continue;
        }
        opened_ = activates == never ? never : activates + rcd_[direction_] + command_[direction_];
        next_ = std::min({start_, opened_, next_refresh_});
        return std::nullopt;
    }
}

} // namespace pipeline
