// A fragment pipe between a source of quads, a sink of completions and mock memories.
#pragma once

#include "pipeline/fragment/fragment_pipeline.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/sim_kit.hpp"

#include <deque>
#include <functional>
#include <memory>
#include <optional>

namespace tests {

/// The memory side of the k-buffer: serves reads, in order, a fixed time after they came. What it samples is
/// {stores of the pixel at that time} in every channel; a store is a call of store().
class MockKBuffer final : public sim::Component {
  public:
    sim::In<pipeline::KBufferRead> reads_in{*this, "reads_in"};
    sim::Out<pipeline::KBufferReadDone> done_out{*this, "done_out"};
    sim::Out<pipeline::LineInvalidation> invalidations_out{*this, "invalidations_out"}; ///< may stay unlinked

    struct Store {
        sim::Cycle cycle;
        std::uint32_t block;
    };
    std::vector<pipeline::KBufferRead> reads;
    std::vector<sim::Cycle> cycles; ///< of their arrival

    /// @param stores in order of time; each adds 1 to all pixels of its block, observable from the next cycle on
    MockKBuffer(sim::Context context, pipeline::QuadPayloads& payloads, sim::Cycle latency, std::vector<Store> stores)
        : Component(std::move(context)),
          payloads_(&payloads),
          latency_(latency),
          stores_(stores.begin(), stores.end()) {}

  private:
    sim::Activity tick() override {
        bool moved = false;
        for (; !due_.empty() && due_.front() <= cycle(); moved = true) {
            const pipeline::KBufferRead& read = reads[served_++];
            serve(read);
            done_out.send({read.thread});
            due_.pop_front();
        }
        for (; reads_in.peek() != nullptr; moved = true) {
            reads.push_back(reads_in.receive());
            cycles.push_back(cycle());
            due_.push_back(cycle() + latency_);
        }
        for (; !stores_.empty() && stores_.front().cycle <= cycle(); moved = true) {
            const std::uint32_t block = stores_.front().block;
            if (versions_.size() <= block) versions_.resize(block + 1);
            ++versions_[block];
            if (invalidations_out.connected()) invalidations_out.send({block});
            stores_.pop_front();
        }
        if (!stores_.empty()) wake_at(std::max(stores_.front().cycle, cycle() + 1));
        if (moved) return sim::Activity::busy;
        if (!due_.empty()) wake_at(due_.front());
        return due_.empty() && stores_.empty() ? sim::Activity::starved : sim::Activity::memory;
    }

    void serve(const pipeline::KBufferRead& read) {
        const std::uint32_t version = read.block < versions_.size() ? versions_[read.block] : 0;
        const auto value = static_cast<float>(version);
        const std::array<float, 4> four{value, value, value, value};
        for (std::uint32_t target = 0; target < 64; ++target)
            for (std::uint32_t pixel = 0; (read.targets >> target & 1) != 0 && pixel < 4; ++pixel)
                payloads_->sample(read.slot, pixel, target, four.data(), {version, version}, {0, cycle()});
    }

    pipeline::QuadPayloads* payloads_;
    sim::Cycle latency_;
    std::deque<Store> stores_;
    std::vector<std::uint32_t> versions_;
    std::deque<sim::Cycle> due_;
    std::size_t served_ = 0;
};

struct PipeOptions {
    pipeline::FragmentParams fragment = {};
    pipeline::TextureParams texture = {};
    std::optional<pipeline::ShaderSite> site = {}; ///< reads the k-buffer; every quad gets a payload slot
    sim::Cycle texture_latency = 200;              ///< inside the mock memory
    sim::Cycle kbuffer_latency = 100;              ///< inside the mock k-buffer
    std::vector<MockKBuffer::Store> stores = {};
    std::uint32_t registers = 1; ///< of the shader, per fragment
    SourceOptions source = {};
    SinkOptions sink = {};
    sim::Mode mode = sim::Mode::normal;
    std::uint64_t shuffle = 1;
};

class PipeBench {
    std::vector<std::uint32_t> slots_; ///< by quad; filled while the source is made

  public:
    Rig rig;
    std::optional<pipeline::ShaderSite> site;
    pipeline::QuadPayloads payloads;
    pipeline::FragmentPipeline pipe;
    Source<pipeline::QuadTask> source;
    Sink<pipeline::Completion> sink;
    Responder<pipeline::MemoryRequest, pipeline::MemoryResponse> textures;
    std::optional<MockKBuffer> kbuffer; ///< with a site

    /// Without `tasks`, all quads of the pass.
    explicit PipeBench(const QuadPass& pass, const PipeOptions& options = {},
                       std::optional<std::vector<pipeline::QuadTask>> tasks = {})
        : rig(options.mode, 1, options.shuffle),
          site(options.site),
          payloads(512, pass.program().floats_per_pixel()),
          pipe(rig.context("pipe"), 0, options.fragment, options.texture, pass.context, 1, site ? &*site : nullptr,
               site ? &payloads : nullptr),
          source(rig.context("source"), with_slots(tasks ? *tasks : pass.quad_tasks()), options.source),
          sink(rig.context("sink"), options.sink),
          textures(rig.context("textures"), options.texture_latency,
                   [](const pipeline::MemoryRequest& request) { return pipeline::MemoryResponse{request.tag}; }) {
        pipe.begin_pass(options.registers);
        sim::connect(source.out, pipe.quads_in, {1, 1, 4});
        sim::connect(pipe.done_out, sink.in, {1, 1, 4});
        sim::connect(pipe.textures_out, textures.requests_in, {1, 1, 8});
        sim::connect(textures.responses_out, pipe.textures_in, {1, 1, 8});
        if (!site) return;
        kbuffer.emplace(rig.context("kbuffer"), payloads, options.kbuffer_latency, options.stores);
        sim::connect(pipe.reads_out[0], kbuffer->reads_in, {1, 1, 8});
        sim::connect(kbuffer->done_out, pipe.reads_in[0], {1, 4, 16});
        if (!pipe.invalidations_in.empty())
            sim::connect(kbuffer->invalidations_out, pipe.invalidations_in[0], {1, 16, 64});
    }

    void run() { rig.simulation.run(); }
    /// Cycle at which the completion of a quad came out of its link.
    sim::Cycle done(pipeline::QuadId quad) const {
        for (const auto& arrival : sink.arrivals())
            if (arrival.value.sequence == quad) return arrival.cycle;
        return never;
    }
    /// Predecessors contained in what a quad read, of its first pixel: at the oldest of its render targets.
    std::uint32_t read_version(pipeline::QuadId quad, std::uint32_t target = 0) {
        return payloads.version(slots_[quad], 0, target).stores;
    }
    /// Cycle of the latest sample of a quad.
    sim::Cycle read_at(pipeline::QuadId quad) { return payloads[slots_[quad]].last_read; }

  private:
    std::vector<pipeline::QuadTask> with_slots(std::vector<pipeline::QuadTask> tasks) {
        if (site)
            for (pipeline::QuadTask& task : tasks)
                if (task.kind == pipeline::QuadKind::quad) {
                    task.slot = payloads.take();
                    if (slots_.size() <= task.quad) slots_.resize(task.quad + 1);
                    slots_[task.quad] = task.slot;
                }
        return tasks;
    }
};

} // namespace tests
