#include "pipeline/memory/memory_hub.hpp"

namespace pipeline {

MemoryHub::MemoryHub(sim::Context context, const Params& params, std::uint32_t partitions, std::uint32_t interleave)
    : Component(std::move(context)),
      params_(params),
      interleave_(interleave),
      partition_count_(partitions),
      next_client_(partitions, 0),
      reads_(params.reads_in_flight),
      wanted_(partitions) {
    for (std::uint32_t i = 0; i < partitions; ++i) partitions_.push_back(std::make_unique<PartitionPort>(*this));
    free_reads_.reserve(params.reads_in_flight);
    for (std::uint32_t i = params.reads_in_flight; i > 0; --i) free_reads_.push_back(i - 1);
}

MemoryHub::ClientPort& MemoryHub::add_client() {
    CHECK_MSG(clients_.size() < ClientSet::most, name());
    clients_.push_back(std::make_unique<ClientPort>(*this));
    return *clients_.back();
}

std::uint32_t MemoryHub::partition_of(std::uint64_t address) const {
    return static_cast<std::uint32_t>(partition_count_.remainder(interleave_.quotient(address)));
}

// The answers of different partitions to one client take turns: the first of them moves on with every answer.
bool MemoryHub::pass_responses() {
    bool progress = false;
    const auto count = static_cast<std::uint32_t>(partitions_.size());
    const std::uint32_t first = next_partition_;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t index = (first + i) % count;
        PartitionPort& port = *partitions_[index];
        const MemoryResponse* response = port.responses_in.peek();
        if (response == nullptr) continue;
        const std::uint32_t slot = response->tag;
        ClientPort& client = *clients_[reads_[slot].client];
        if (!client.responses_out.ready()) continue;
        client.responses_out.send({reads_[slot].tag});
        port.responses_in.pop();
        free_reads_.push_back(slot);
        ++stats_.responses;
        next_partition_ = (index + 1) % count;
        progress = true;
    }
    return progress;
}

void MemoryHub::grant(std::uint32_t partition, const ClientSet& clients) {
    const std::uint32_t client = clients.next(next_client_[partition]);
    MemoryRequest request = clients_[client]->requests_in.receive();
    CHECK_MSG(interleave_.remainder(request.address) + request.bytes <= interleave_.number(),
              "a request crosses an interleave block");
    if (!request.write) {
        const std::uint32_t slot = free_reads_.back();
        free_reads_.pop_back();
        reads_[slot] = {request.tag, client};
        request.tag = slot;
        stats_.reads_in_flight.note(reads_.size() - free_reads_.size());
    }
    partitions_[partition]->requests_out.send(request);
    next_client_[partition] = (client + 1) % ClientSet::most;
    ++stats_.requests;
    if (clients.has_several()) ++stats_.conflicts;
}

// One grant per partition: what the clients ask for first, then who is next in turn.
bool MemoryHub::pass_requests(bool& waiting) {
    const bool room = free_reads_.size() >= partitions_.size(); // each grant of this round may be a read
    std::uint64_t wants = 0;                                    // a bit per partition
    for (std::uint32_t client = 0; client < clients_.size(); ++client) {
        const MemoryRequest* request = clients_[client]->requests_in.peek();
        if (request == nullptr) continue;
        waiting = true;
        if (!request->write && !room) continue;
        const std::uint32_t partition = partition_of(request->address);
        if ((wants >> partition & 1U) == 0) wanted_[partition].clear();
        wants |= std::uint64_t{1} << partition;
        wanted_[partition].add(client);
    }
    bool progress = false;
    for (; wants != 0; wants &= wants - 1) {
        const auto partition = static_cast<std::uint32_t>(std::countr_zero(wants));
        if (!partitions_[partition]->requests_out.ready()) continue;
        grant(partition, wanted_[partition]);
        progress = true;
    }
    return progress;
}

sim::Activity MemoryHub::tick() {
    bool progress = pass_responses();
    bool waiting = false;
    for (std::uint32_t round = 0; round < params_.requests_per_clk && pass_requests(waiting); ++round) progress = true;
    if (progress) return sim::Activity::busy;
    if (waiting) return sim::Activity::blocked;
    return free_reads_.size() == reads_.size() ? sim::Activity::starved : sim::Activity::memory;
}

} // namespace pipeline
