// Crossbar and partitions with clients that read, and ROP partitions that have a way of their own.
#pragma once

#include "pipeline/memory/memory_system.hpp"
#include "tests/support/sim_kit.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tests {

/// At 1 GHz: 8 bytes per cycle and partition.
inline pipeline::MemoryParams small_memory() {
    pipeline::MemoryParams params;
    params.partitions = 4;
    params.bandwidth = 32;
    params.hub.latency = 5;
    params.controller.request_latency = 40;
    params.controller.return_latency = 60;
    params.controller.dram = {.rcd_read_ns = 12,
                              .rcd_write_ns = 12,
                              .cl_ns = 8,
                              .wl_ns = 8,
                              .rp_ns = 12,
                              .ras_ns = 0,
                              .wr_ns = 0,
                              .rrd_ns = 0,
                              .faw_ns = 0,
                              .rtw_ns = 0,
                              .wtr_ns = 0,
                              .refi_ns = 0,
                              .row_bytes = 2048,
                              .banks = 8};
    return params;
}

inline std::vector<pipeline::MemoryRequest> reads(std::uint32_t count, std::uint64_t address, std::uint64_t step,
                                                  std::uint32_t bytes = 64) {
    std::vector<pipeline::MemoryRequest> requests;
    for (std::uint32_t i = 0; i < count; ++i)
        requests.push_back({address + i * step, bytes, 1000 + i, i % 3, pipeline::MemoryClient::vertex, false});
    return requests;
}

/// Sends requests, in order, to the memory partitions that hold their addresses, and notes every answer.
class MemoryRopClient final : public sim::Component {
  public:
    std::vector<sim::Out<pipeline::MemoryRequest>> out;
    std::vector<sim::In<pipeline::MemoryResponse>> in;
    struct Arrival {
        pipeline::MemoryResponse response;
        sim::Cycle cycle;
    };
    std::vector<Arrival> arrivals;

    MemoryRopClient(sim::Context context, const pipeline::MemorySystem& memory,
                    std::vector<pipeline::MemoryRequest> requests)
        : Component(std::move(context)), memory_(memory), requests_(std::move(requests)) {
        for (const pipeline::MemoryRequest& request : requests_) answers_ += !request.write || request.notify ? 1 : 0;
        for (std::uint32_t i = 0; i < memory.partitions(); ++i) {
            out.emplace_back(*this, "out");
            in.emplace_back(*this, "in");
        }
    }

  private:
    sim::Activity tick() override {
        bool progress = false;
        for (auto& port : in)
            for (; port.peek() != nullptr; progress = true) arrivals.push_back({port.receive(), cycle()});
        for (; sent_ < requests_.size(); ++sent_, progress = true) {
            auto& port = out[memory_.partition_of(requests_[sent_].address)];
            if (!port.ready()) break;
            port.send(requests_[sent_]);
        }
        if (progress) return sim::Activity::busy;
        if (sent_ < requests_.size()) return sim::Activity::blocked;
        return arrivals.size() < answers_ ? sim::Activity::memory : sim::Activity::starved;
    }

    const pipeline::MemorySystem& memory_;
    std::vector<pipeline::MemoryRequest> requests_;
    std::size_t sent_ = 0, answers_ = 0;
};

class MemoryBench {
  public:
    explicit MemoryBench(const pipeline::MemoryParams& params, sim::Mode mode = sim::Mode::normal,
                         std::uint64_t shuffle = 1)
        : rig(mode, 1, shuffle), memory(rig.simulation, rig.clock, params) {}

    void add(std::vector<pipeline::MemoryRequest> requests, SinkOptions sink = {}) {
        const std::string number = std::to_string(sources.size());
        sources.push_back(std::make_unique<Source<pipeline::MemoryRequest>>(rig.context("source" + number), requests));
        sinks.push_back(std::make_unique<Sink<pipeline::MemoryResponse>>(rig.context("sink" + number), sink));
        memory.attach(sources.back()->out, sinks.back()->in);
    }
    MemoryRopClient& add_rop(std::vector<pipeline::MemoryRequest> requests) {
        const auto number = static_cast<std::uint32_t>(rops.size());
        rops.push_back(
            std::make_unique<MemoryRopClient>(rig.context("rop" + std::to_string(number)), memory, requests));
        memory.attach_rop(number, rops.back()->out, rops.back()->in);
        return *rops.back();
    }
    std::vector<std::uint32_t> tags(std::size_t client) const {
        std::vector<std::uint32_t> list;
        for (const pipeline::MemoryResponse& response : sinks[client]->values()) list.push_back(response.tag);
        return list;
    }

    Rig rig;
    pipeline::MemorySystem memory;
    std::vector<std::unique_ptr<Source<pipeline::MemoryRequest>>> sources;
    std::vector<std::unique_ptr<Sink<pipeline::MemoryResponse>>> sinks;
    std::vector<std::unique_ptr<MemoryRopClient>> rops;
};

} // namespace tests
