#include "pipeline/memory/memory_controller.hpp"

namespace pipeline {

namespace {

constexpr std::uint32_t largest_request = 4096; ///< bytes; see MemoryRequest

sim::Time time_of(DramChannel::Fine fine) {
    return (fine + DramChannel::fine_per_time - 1) / DramChannel::fine_per_time;
}

// Reads accepted, one a cycle, and not answered: those that wait for the bus, and those within the latency behind it.
std::uint32_t answers_in_flight(const MemoryControllerParams& params) {
    return params.queue + params.dram.latency + params.dram.row_miss + params.jitter_cycles + 2;
}

} // namespace

MemoryController::MemoryController(sim::Context context, const Params& params, const Share& share)
    : Component(context),
      params_(params),
      share_(share),
      channel_(params.dram, share.bandwidth, context.clock.period),
      random_(simulation().random_for(name())),
      ports_{Port{&hub_in, &hub_out, FixedQueue<Answer>(answers_in_flight(params))},
             Port{&rop_in, &rop_out, FixedQueue<Answer>(answers_in_flight(params))}},
      queue_(params.queue) {}

sim::Cycle MemoryController::unloaded_latency(std::uint32_t bytes) const {
    return clock().cycle_at(time_of(channel_.unloaded_latency(bytes)));
}

std::uint64_t MemoryController::local_address(std::uint64_t address, const Port& port) const {
    // The tiles of a ROP partition are about every partitions-th one of a surface.
    if (&port == &ports_[rop]) return address / share_.partitions;
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

void MemoryController::serve(const MemoryRequest& request, Port& port) {
    CHECK(request.bytes >= 1 && request.bytes <= largest_request);
    book(request);
    const auto service = channel_.serve(local_address(request.address, port), request.bytes, now());
    ++(service.row_hit ? stats_.row_hits : stats_.row_misses);
    queue_.push(clock().cycle_at(time_of(service.transferred)));
    stats_.queued.note(queue_.size());
    if (request.write) return;
    sim::Cycle ready = clock().cycle_at(time_of(service.done));
    if (params_.jitter_cycles > 0) ready += random_.below(params_.jitter_cycles + std::uint64_t{1});
    if (!port.answers.empty()) ready = std::max(ready, port.answers.back().ready);
    port.answers.push({request.tag, ready});
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

void MemoryController::forget_transferred() {
    while (!queue_.empty() && queue_.front() <= cycle()) queue_.pop();
}

bool MemoryController::accept() {
    if (queue_.full()) return false;
    for (std::size_t i = 0; i < ports_.size(); ++i) {
        const std::size_t index = (turn_ + i) % ports_.size();
        Port& port = ports_[index];
        if (!port.requests->connected() || port.answers.full()) continue;
        const MemoryRequest* request = port.requests->peek();
        if (request == nullptr) continue;
        serve(*request, port);
        port.requests->pop();
        turn_ = (index + 1) % ports_.size();
        return true;
    }
    return false;
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
    // A full queue moves on with its oldest transfer. Otherwise the last write of all ends the work.
    if (queue_.full())
        next = std::min(next, queue_.front());
    else if (next == ~sim::Cycle{0} && !blocked && !queue_.empty())
        next = queue_.back();
    if (next != ~sim::Cycle{0}) wake_at(next);
    if (blocked) return sim::Activity::blocked;
    return next == ~sim::Cycle{0} ? sim::Activity::starved : sim::Activity::memory;
}

sim::Activity MemoryController::tick() {
    bool progress = answer(ports_[hub]);
    progress |= answer(ports_[rop]);
    forget_transferred();
    progress |= accept();
    return progress ? sim::Activity::busy : wait();
}

} // namespace pipeline
