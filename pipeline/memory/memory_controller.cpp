#include "pipeline/memory/memory_controller.hpp"

#include <algorithm>
#include <utility>

namespace pipeline {

namespace {

constexpr std::uint32_t largest_request = 4096; ///< bytes; see MemoryRequest
constexpr std::uint32_t most_draws = 1U << 24U; ///< of a frame

sim::Time time_of(DramChannel::Fine fine) {
    return (fine + DramChannel::fine_per_time - 1) / DramChannel::fine_per_time;
}

// Reads accepted, one a cycle, and not answered: those that wait for the bus, and those within the latency behind it.
std::uint32_t answers_in_flight(const MemoryControllerParams& params) {
    return params.queue + params.dram.latency + params.dram.row_miss + params.jitter_cycles + 2;
}

} // namespace

MemoryController::MemoryController(sim::Context context, const Params& params, const Share& share)
    : Component(std::move(context)),
      params_(params),
      share_(share),
      channel_(params.dram, share.bandwidth, clock().period, params.queue),
      random_(simulation().random_for(name())),
      ports_{Port{&hub_in, &hub_out, FixedQueue<Answer>(answers_in_flight(params))},
             Port{&rop_in, &rop_out, FixedQueue<Answer>(answers_in_flight(params))}},
      waiting_(params.queue) {
    for (std::uint32_t id = params.queue; id > 0; --id) free_ids_.push_back(id - 1);
}

sim::Cycle MemoryController::unloaded_latency(std::uint32_t bytes) const {
    return clock().cycle_at(time_of(channel_.unloaded_latency(bytes)));
}

std::uint64_t MemoryController::local_address(std::uint64_t address, std::size_t port) const {
    // The tiles of a ROP partition are about every partitions-th one of a surface.
    if (port == rop) return address / share_.partitions;
    const std::uint64_t block = address / share_.interleave;
    return block / share_.partitions * share_.interleave + address % share_.interleave;
}

void MemoryController::book(const MemoryRequest& request) {
    const auto client = static_cast<std::size_t>(request.client);
    ++stats_.requests;
    ++(request.write ? stats_.writes : stats_.reads);
    stats_.bytes[client] += request.bytes;
    if (request.draw >= draw_bytes_.size()) draw_bytes_.resize(request.draw + 1);
    draw_bytes_[request.draw][client] += request.bytes;
}

bool MemoryController::answer(Port& port) {
    bool progress = false;
    while (!port.answers.empty() && port.answers.front().ready <= cycle() && port.responses->ready()) {
        port.responses->send({port.answers.front().tag});
        port.answers.pop();
        progress = true;
    }
    return progress;
}

// One request a cycle, from the ports in turn.
bool MemoryController::accept() {
    if (free_ids_.empty()) return false;
    for (std::size_t i = 0; i < ports_.size(); ++i) {
        const std::size_t index = (turn_ + i) % ports_.size();
        Port& port = ports_[index];
        const bool room = port.answers.size() + channel_.waiting() < port.answers.capacity();
        if (!port.requests->connected() || !room) continue;
        const MemoryRequest* request = port.requests->peek();
        if (request == nullptr) continue;
        CHECK(request->bytes >= 1 && request->bytes <= largest_request && request->draw < most_draws);
        const std::uint32_t id = free_ids_.back();
        free_ids_.pop_back();
        waiting_[id] = {request->tag, static_cast<std::uint8_t>(index), request->write};
        channel_.enqueue(local_address(request->address, index), request->bytes, id, now());
        stats_.queued.note(channel_.waiting());
        book(*request);
        port.requests->pop();
        turn_ = (index + 1) % ports_.size();
        return true;
    }
    return false;
}

// Commits the transfers that start before the next edge.
bool MemoryController::transfer() {
    bool progress = false;
    while (const auto transfer = channel_.transfer(now())) {
        const Waiting& request = waiting_[transfer->id];
        ++(transfer->row_hit ? stats_.row_hits : stats_.row_misses);
        free_ids_.push_back(transfer->id);
        progress = true;
        if (request.write) continue;
        FixedQueue<Answer>& answers = ports_[request.port].answers;
        sim::Cycle ready = clock().cycle_at(time_of(transfer->done));
        if (params_.jitter_cycles > 0) ready += random_.below(params_.jitter_cycles + std::uint64_t{1});
        if (!answers.empty()) ready = std::max(ready, answers.back().ready);
        answers.push({request.tag, ready});
    }
    return progress;
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
    bool progress = answer(ports_[hub]);
    progress |= answer(ports_[rop]);
    progress |= accept();
    progress |= transfer();
    return progress ? sim::Activity::busy : wait();
}

} // namespace pipeline
