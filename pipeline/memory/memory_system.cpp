#include "pipeline/memory/memory_system.hpp"

#include "pipeline/memory/unit_report.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace pipeline {

namespace {

constexpr sim::Cycle port_latency = 1;   ///< between a unit and its end of the crossbar, or its partition
constexpr std::uint32_t port_buffer = 8; ///< requests that wait at a port
// The ways of the ROP partitions to one channel are full together: each holds its time in requests of this size.
constexpr std::uint32_t rop_request = 64; ///< bytes

sim::ChannelConfig link_of(sim::Cycle latency, std::uint32_t width) {
    return {latency, width, static_cast<std::uint32_t>(width * (latency + 1)) + port_buffer};
}

// The way to a channel, one request a cycle, holds what the channel moves in that time, were all requests of `bytes`.
sim::ChannelConfig way_to(const MemoryController::Share& share, sim::Cycle latency, std::uint32_t bytes) {
    const double moved = static_cast<double>(latency * share.core_period) * share.bandwidth * 1e-3;
    const double on_the_way = std::min(std::ceil(moved / bytes), static_cast<double>(latency)) + 1;
    return {latency, 1, static_cast<std::uint32_t>(on_the_way) + port_buffer};
}

} // namespace

MemorySystem::MemorySystem(sim::Simulation& simulation, const sim::Clock& core, const MemoryParams& params)
    : simulation_(simulation), core_(core), clock_(&core), params_(params) {
    if (!std::has_single_bit(params.interleave))
        throw sim::InputError(fmt::format("memory.interleave: expected a power of two, got {}", params.interleave));
    if (params.clock_mhz > 0) clock_ = &simulation.add_clock("memory", params.clock_mhz);
    if (!std::has_single_bit(params.controller.dram.burst_bytes) ||
        params.controller.dram.burst_bytes > params.interleave)
        throw sim::InputError(fmt::format(
            "memory.controller.dram.burst_bytes: expected a power of two up to memory.interleave ({}), got {}",
            params.interleave, params.controller.dram.burst_bytes));
    share_ = {params.partitions, params.interleave, params.bandwidth / params.partitions, core.period};
    for (std::uint32_t i = 0; i < params.partitions; ++i)
        controllers_.push_back(std::make_unique<MemoryController>(
            simulation.context(fmt::format("memory.partition{}", i), *clock_), params.controller, share_));
}

std::uint32_t MemorySystem::partition_of(std::uint64_t address) const {
    return static_cast<std::uint32_t>(address / params_.interleave % params_.partitions);
}

MemoryHub& MemorySystem::hub() {
    if (hub_ != nullptr) return *hub_;
    hub_ = std::make_unique<MemoryHub>(simulation_.context("memory.hub", core_), params_.hub, params_.partitions,
                                       params_.interleave);
    for (std::uint32_t i = 0; i < params_.partitions; ++i) {
        connect(hub_->partition(i).requests_out, controllers_[i]->hub_in,
                way_to(share_, params_.hub.latency + params_.controller.request_latency,
                       params_.controller.dram.burst_bytes));
        connect(controllers_[i]->hub_out, hub_->partition(i).responses_in, link_of(params_.hub.latency, 1));
    }
    return *hub_;
}

void MemorySystem::attach(sim::Out<MemoryRequest>& requests, sim::In<MemoryResponse>& responses) {
    MemoryHub::ClientPort& port = hub().add_client();
    connect(requests, port.requests_in, link_of(port_latency, params_.hub.requests_per_clk));
    connect(port.responses_out, responses, link_of(port_latency, params_.hub.requests_per_clk));
}

void MemorySystem::attach_rop(std::uint32_t rop, std::vector<sim::Out<MemoryRequest>>& requests,
                              std::vector<sim::In<MemoryResponse>>& responses) {
    CHECK(rop == rops_ && requests.size() == params_.partitions && responses.size() == params_.partitions);
    ++rops_;
    for (std::uint32_t i = 0; i < params_.partitions; ++i) {
        MemoryController::RopPort& port = controllers_[i]->add_rop();
        connect(requests[i], port.requests_in,
                way_to(share_, port_latency + params_.controller.request_latency, rop_request));
        connect(port.responses_out, responses[i], link_of(port_latency, 1));
    }
}

sim::Cycle MemorySystem::unloaded_rop_latency(std::uint32_t bytes) const {
    return 2 * port_latency + params_.controller.request_latency + controllers_.front()->unloaded_latency(bytes);
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
