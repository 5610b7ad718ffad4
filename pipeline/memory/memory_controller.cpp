#include "pipeline/memory/memory_controller.hpp"

#include <algorithm>
#include <utility>

namespace pipeline {

namespace {

constexpr std::uint32_t largest_request = 4096; ///< bytes; see MemoryRequest
constexpr std::uint32_t most_draws = 1U << 24U; ///< of a frame
constexpr std::size_t most_rops = 254;          ///< ports are numbered in a byte

sim::Time time_of(DramChannel::Fine fine) {
    return (fine + DramChannel::fine_per_time - 1) / DramChannel::fine_per_time;
}

// What was accepted, one a cycle, and not answered: requests that wait for the bus, and reads on their way back.
std::uint32_t answers_of_hub(const MemoryControllerParams& params, sim::Time core, sim::Time own) {
    const sim::Time back = (sim::Time{params.return_latency} + params.jitter_cycles + 1) * core;
    return params.queue + params.write_queue + static_cast<std::uint32_t>(back / own) + 2;
}

} // namespace

MemoryController::MemoryController(sim::Context context, const Params& params, const Share& share)
    : Component(std::move(context)),
      params_(params),
      interleave_(share.interleave),
      partitions_(share.partitions),
      core_period_(share.core_period != 0 ? share.core_period : clock().period),
      channel_(params.dram, share.bandwidth, clock().period, params.write_queue),
      random_(simulation().random_for(name())),
      waiting_(std::size_t{params.queue} + params.write_queue) {
    ports_.push_back({&hub_in, &hub_out, FixedQueue<Answer>(answers_of_hub(params, core_period_, clock().period))});
    for (auto id = static_cast<std::uint32_t>(waiting_.size()); id > 0; --id) free_ids_.push_back(id - 1);
}

MemoryController::RopPort& MemoryController::add_rop() {
    CHECK_MSG(ports_.size() <= most_rops, name());
    RopPort& port = rops_.emplace_back(*this, held_, static_cast<std::uint32_t>(ports_.size()));
    // What waits for the bus, and as much that has crossed it and waits for room.
    ports_.push_back({&port.requests_in, &port.responses_out,
                      FixedQueue<Answer>(2 * static_cast<std::uint32_t>(waiting_.size()) + 2)});
    return port;
}

sim::Cycle MemoryController::unloaded_latency(std::uint32_t bytes) const {
    return clock().cycle_at(time_of(channel_.unloaded_latency(bytes)) + params_.return_latency * core_period_);
}

// One map for every client: the blocks of this partition, one behind the other.
std::uint64_t MemoryController::local_address(std::uint64_t address) const {
    const std::uint64_t block = interleave_.quotient(address);
    return partitions_.quotient(block) * interleave_.number() + interleave_.remainder(address);
}

void MemoryController::book(const MemoryRequest& request) {
    const auto client = static_cast<std::size_t>(request.client);
    const std::uint32_t bytes = channel_.burst_bytes_of(request.address, request.bytes);
    ++stats_.requests;
    ++(request.write ? stats_.writes : stats_.reads);
    stats_.bytes[client] += bytes;
    if (request.draw >= draw_bytes_.size()) draw_bytes_.resize(request.draw + 1);
    draw_bytes_[request.draw][client] += bytes;
}

MemoryControllerStats MemoryController::stats() const {
    Stats stats = stats_;
    const DramEvents& events = channel_.events();
    stats.turnarounds = {events.turnarounds};
    stats.activation_waits = {events.activation_waits};
    stats.refreshes = {events.refreshes};
    return stats;
}

bool MemoryController::answer(Port& port) {
    bool progress = false;
    while (!port.answers.empty() && port.answers.front().ready <= cycle() && port.responses->ready()) {
        const Answer& answer = port.answers.front();
        const sim::Time left = answer.back - std::min(answer.back, now());
        port.responses->send({answer.tag, static_cast<std::uint32_t>((left + core_period_ - 1) / core_period_)});
        port.answers.pop();
        progress = true;
    }
    return progress;
}

// One request a cycle: the crossbar and the ROP partitions take turns, and so do these among themselves.
bool MemoryController::accept() {
    if (channel_.waiting(false) >= params_.queue && channel_.waiting(true) >= params_.write_queue) return false;
    const bool turn = hub_first_;
    if (turn && accept_from(hub)) {
        hub_first_ = false;
        return true;
    }
    const bool taken = held_.any_from(rop_turn_, [&](std::uint32_t index) {
        if (index == hub || !accept_from(index)) return false;
        rop_turn_ = index + 1 < ports_.size() ? index + 1 : 1;
        return true;
    });
    if (!taken) return !turn && accept_from(hub);
    hub_first_ = true;
    return true;
}

bool MemoryController::accept_from(std::uint32_t index) {
    Port& port = ports_[index];
    if (!port.requests->connected()) return false;
    const MemoryRequest* request = port.requests->peek();
    if (request == nullptr || port.answers.size() + channel_.waiting() >= port.answers.capacity()) return false;
    if (channel_.waiting(request->write) >= (request->write ? params_.write_queue : params_.queue)) return false;
    CHECK(request->bytes >= 1 && request->bytes <= largest_request && request->draw < most_draws);
    const std::uint32_t id = free_ids_.back();
    free_ids_.pop_back();
    waiting_[id] = {request->tag, static_cast<std::uint8_t>(index), request->write, request->notify};
    channel_.enqueue(local_address(request->address), request->bytes, request->write, id, now());
    stats_.queued.note(channel_.waiting());
    book(*request);
    port.requests->pop();
    return true;
}

// Commits the transfers that start before the next edge.
bool MemoryController::transfer() {
    bool progress = false;
    while (const auto transfer = channel_.transfer(now())) {
        const Waiting& request = waiting_[transfer->id];
        ++(transfer->row_hit ? stats_.row_hits : stats_.row_misses);
        free_ids_.push_back(transfer->id);
        progress = true;
        if (!request.write || request.notify) note_answer(request, *transfer);
    }
    return progress;
}

void MemoryController::note_answer(const Waiting& request, const DramChannel::Transfer& transfer) {
    Port& port = ports_[request.port];
    Answer answer{request.tag, clock().cycle_at(time_of(transfer.end)), 0};
    if (!request.write) {
        sim::Cycle way = params_.return_latency;
        if (params_.jitter_cycles > 0) way += random_.below(params_.jitter_cycles + std::uint64_t{1});
        answer.back = port.back = std::max(port.back, time_of(transfer.end) + way * core_period_);
    }
    if (request.port == hub) answer.ready = clock().cycle_at(answer.back);
    port.answers.push(answer);
}

sim::Activity MemoryController::wait() {
    sim::Cycle next = ~sim::Cycle{0};
    bool blocked = false;
    for (Port& port : ports_) {
        if (port.answers.empty()) continue;
        const sim::Cycle ready = port.answers.front().ready;
        if (ready <= cycle())
            blocked = true; // answer() found no room and will be woken by it
        else
            next = std::min(next, ready);
    }
    if (const auto start = channel_.next_start())
        next = std::min(next, clock().cycle_before(*start / DramChannel::fine_per_time));
    const sim::Cycle transferred = clock().cycle_at(time_of(channel_.bus_free()));
    // The last write of all ends the work.
    if (next == ~sim::Cycle{0} && !blocked && transferred > cycle()) next = transferred;
    if (next != ~sim::Cycle{0}) wake_at(next);
    if (blocked) return sim::Activity::blocked;
    return next == ~sim::Cycle{0} ? sim::Activity::starved : sim::Activity::memory;
}

sim::Activity MemoryController::tick() {
    bool progress = false;
    for (Port& port : ports_)
        if (!port.answers.empty()) progress |= answer(port);
    progress |= accept();
    progress |= transfer();
    return progress ? sim::Activity::busy : wait();
}

} // namespace pipeline
