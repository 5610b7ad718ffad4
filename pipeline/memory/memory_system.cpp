#include "pipeline/memory/memory_system.hpp"

#include "pipeline/memory/unit_report.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

namespace pipeline {

namespace {

constexpr sim::Cycle port_latency = 1;   ///< between a unit and its end of the crossbar, or its partition
constexpr std::uint32_t port_buffer = 8; ///< requests that wait at a port

sim::ChannelConfig link_of(sim::Cycle latency, std::uint32_t width) {
    return {latency, width, static_cast<std::uint32_t>(width * (latency + 1)) + port_buffer};
}

} // namespace

MemorySystem::MemorySystem(sim::Simulation& simulation, const sim::Clock& core, const MemoryParams& params)
    : simulation_(simulation), core_(core), clock_(&core), params_(params) {
    if (!std::has_single_bit(params.interleave))
        throw sim::InputError(fmt::format("memory.interleave: expected a power of two, got {}", params.interleave));
    if (params.clock_mhz > 0) clock_ = &simulation.add_clock("memory", params.clock_mhz);
    const MemoryController::Share share{params.partitions, params.interleave, params.bandwidth / params.partitions};
    for (std::uint32_t i = 0; i < params.partitions; ++i)
        controllers_.push_back(std::make_unique<MemoryController>(
            simulation.context(fmt::format("memory.partition{}", i), *clock_), params.controller, share));
}

std::uint32_t MemorySystem::partition_of(std::uint64_t address) const {
    return static_cast<std::uint32_t>(address / params_.interleave % params_.partitions);
}

MemoryHub& MemorySystem::hub() {
    if (hub_ != nullptr) return *hub_;
    hub_ = std::make_unique<MemoryHub>(simulation_.context("memory.hub", core_), params_.hub, params_.partitions,
                                       params_.interleave);
    for (std::uint32_t i = 0; i < params_.partitions; ++i) {
        connect(hub_->partition(i).requests_out, controllers_[i]->hub_in, link_of(params_.hub.latency, 1));
        connect(controllers_[i]->hub_out, hub_->partition(i).responses_in, link_of(params_.hub.latency, 1));
    }
    return *hub_;
}

void MemorySystem::attach(sim::Out<MemoryRequest>& requests, sim::In<MemoryResponse>& responses) {
    MemoryHub::ClientPort& port = hub().add_client();
    connect(requests, port.requests_in, link_of(port_latency, params_.hub.requests_per_clk));
    connect(port.responses_out, responses, link_of(port_latency, params_.hub.requests_per_clk));
}

void MemorySystem::attach_rop(std::uint32_t partition, sim::Out<MemoryRequest>& requests,
                              sim::In<MemoryResponse>& responses) {
    CHECK(partition < params_.partitions);
    connect(requests, controllers_[partition]->rop_in, link_of(port_latency, 1));
    connect(controllers_[partition]->rop_out, responses, link_of(port_latency, 1));
}

sim::Cycle MemorySystem::unloaded_rop_latency(std::uint32_t bytes) const {
    return 2 * port_latency + controllers_.front()->unloaded_latency(bytes);
}

sim::Cycle MemorySystem::unloaded_latency(std::uint32_t bytes) const {
    return unloaded_rop_latency(bytes) + 2 * sim::Cycle{params_.hub.latency};
}

MemoryHubStats MemorySystem::hub_stats() const { return hub_ == nullptr ? MemoryHubStats{} : hub_->stats(); }

MemoryControllerStats MemorySystem::partition_stats(std::uint32_t partition) const {
    return controllers_[partition]->stats();
}

MemoryControllerStats MemorySystem::controller_stats() const {
    MemoryControllerStats sum;
    for (const auto& controller : controllers_) sim::add(sum, controller->stats());
    return sum;
}

MemoryBytes MemorySystem::draw_bytes(std::uint32_t draw) const {
    MemoryBytes sum{};
    for (const auto& controller : controllers_) {
        const std::vector<MemoryBytes>& bytes = controller->draw_bytes();
        if (draw >= bytes.size()) continue;
        for (std::size_t client = 0; client < sum.size(); ++client) sum[client] += bytes[draw][client];
    }
    return sum;
}

nlohmann::ordered_json MemorySystem::report() const {
    nlohmann::ordered_json report = nlohmann::ordered_json::object();
    if (hub_ != nullptr) report["memory_hub"] = unit_report(*hub_);
    nlohmann::ordered_json& partition = report["memory_partition"];
    partition["params"] = sim::to_json(params_.controller);
    partition["counters"] = sim::to_json(controller_stats());
    for (const auto& controller : controllers_) add_activity(partition["activity"], *controller);
    return report;
}

} // namespace pipeline
