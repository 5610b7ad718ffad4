// A ROP group between a source of quads, a source of k-buffer reads, a sink of commits and a mock memory.
//
//     tests::QuadPass pass;
//     pass.context.end = pipeline::FragmentEnd::kbuffer_store;
//     pass.quad(0, 0);
//     tests::RopBench bench(pass, {.shader = pipeline::ShaderSite{}});
//     bench.run();
//     EXPECT_EQ(bench.commits->cycles(), (Cycles{3}));
#pragma once

#include "pipeline/output/rop.hpp"
#include "tests/support/quad_kit.hpp"
#include "tests/support/sim_kit.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>

namespace tests {

/// Reads the array, in order, a fixed time after a request came; the data are there `way_back` later. Writes are posted
/// but for those that ask for an answer. Notes what came when.
class MockMemory final : public sim::Component {
  public:
    struct Arrival {
        pipeline::MemoryRequest request;
        sim::Cycle cycle;
    };
    sim::In<pipeline::MemoryRequest> requests_in{*this, "requests_in"};
    sim::Out<pipeline::MemoryResponse> responses_out{*this, "responses_out"};
    std::vector<Arrival> arrivals;

    MockMemory(sim::Context context, sim::Cycle latency, std::uint32_t way_back)
        : Component(std::move(context)), latency_(latency), way_back_(way_back) {}

  private:
    sim::Activity tick() override {
        bool moved = false;
        for (; requests_in.peek() != nullptr; moved = true) {
            arrivals.push_back({requests_in.receive(), cycle()});
            const pipeline::MemoryRequest& request = arrivals.back().request;
            if (!request.write || request.notify)
                due_.push_back({cycle() + latency_, {request.tag, request.write ? 0 : way_back_}});
        }
        for (; !due_.empty() && due_.front().first <= cycle() && responses_out.ready(); moved = true) {
            responses_out.send(due_.front().second);
            due_.pop_front();
        }
        if (moved) return sim::Activity::busy;
        if (due_.empty()) return sim::Activity::starved;
        if (due_.front().first <= cycle()) return sim::Activity::blocked;
        wake_at(due_.front().first);
        return sim::Activity::memory;
    }

    sim::Cycle latency_;
    std::uint32_t way_back_;
    std::deque<std::pair<sim::Cycle, pipeline::MemoryResponse>> due_;
};

struct RopOptions {
    pipeline::RopParams rop = {};
    std::optional<pipeline::ShaderSite> shader = {};   ///< of passes that end in kbuffer_store
    std::optional<pipeline::BlenderSite> blender = {}; ///< of passes that end in kbuffer_blend
    sim::Cycle memory_latency = 100;                   ///< inside the mock memory, until the array is read
    std::uint32_t memory_way_back = 0;                 ///< cycles of the data from there
    std::vector<std::uint32_t> reads = {};             ///< blocks that a texture unit reads, in order; with a shader
    SourceOptions reads_source = {};
    SourceOptions source = {};
    SinkOptions commits = {};
    sim::Mode mode = sim::Mode::normal;
    std::uint64_t shuffle = 1;
};

class RopBench {
    static constexpr std::uint32_t slots = 1024;

  public:
    Rig rig;
    const QuadPass& pass;
    pipeline::KBufferPlan plan;
    pipeline::SurfaceStore surfaces; ///< depth, cleared to 1, and colour, cleared to 0
    pipeline::ClearBits depth_clear, colour_clear;
    pipeline::FixedSurfaces fixed;
    pipeline::ClearBits kbuffer_clear;
    pipeline::KBufferMemory kbuffer;
    pipeline::StoreHistory history;
    pipeline::QuadPayloads payloads;
    pipeline::Rop rop;
    Source<pipeline::QuadTask> source;
    MockMemory memory;
    std::optional<Sink<pipeline::Commit>> commits;                 ///< with a shader or a blender
    std::optional<Source<pipeline::KBufferRead>> reads;            ///< with a shader
    std::optional<Sink<pipeline::KBufferReadDone>> reads_done;     ///< with a shader
    std::optional<Sink<pipeline::LineInvalidation>> invalidations; ///< with texture caches that are kept coherent

    /// Without `tasks`, all quads of the pass. A shader has read what its predecessors stored, and stores its quad's
    /// number + 1 into every channel.
    explicit RopBench(const QuadPass& pass_, const RopOptions& options = {},
                      std::optional<std::vector<pipeline::QuadTask>> tasks = {})
        : rig(options.mode, 1, options.shuffle),
          pass(pass_),
          plan(plan_of(options)),
          surfaces(surfaces_of(pass)),
          kbuffer(pass.context.layout, pass.program(),
                  options.shader && options.shader->visibility != pipeline::Visibility::rop_cache),
          history(pass.context.layout),
          payloads(slots, pass.program().floats_per_pixel()),
          rop(rig.context("rop"), options.rop, pass.context, plan, bound(options), shape()),
          source(rig.context("source"), prepared(tasks ? *tasks : pass.quad_tasks(), options), options.source),
          memory(rig.context("memory"), options.memory_latency, options.memory_way_back) {
        fixed.winner.assign(std::size_t{pass.stream.width} * pass.stream.height, ~pipeline::QuadId{0});
        rop.begin_pass();
        sim::connect(source.out, rop.quads_in, {1, 1, 2});
        sim::connect(rop.memory_out[0], memory.requests_in, {1, 1, 64});
        sim::connect(memory.responses_out, rop.memory_in[0], {1, 1, 64});
        if (options.shader || options.blender)
            sim::connect(rop.commits_out, commits.emplace(rig.context("commits"), options.commits).in, {1, 2, 4});
        if (!rop.invalidations_out.empty())
            sim::connect(rop.invalidations_out[0], invalidations.emplace(rig.context("invalidations")).in, {1, 4, 8});
        if (!options.shader) return;
        reads.emplace(rig.context("reads"), read_messages(options), options.reads_source);
        sim::connect(reads->out, rop.reads_in[0], {1, 1, 2});
        sim::connect(rop.reads_out[0], reads_done.emplace(rig.context("reads_done")).in, {1, 1, 2});
    }

    void run() { rig.simulation.run(); }
    /// The write-back at the end of a pass; its requests are the ones that come after those so far.
    void write_back() {
        rop.write_back_all();
        run();
    }

    pipeline::DepthStencil depth(std::uint32_t x = 0, std::uint32_t row = 0) const {
        return unpack_depth_stencil(pass.context.depth_format, surfaces.read(0, {x, row, 0}));
    }
    glm::vec4 colour(std::uint32_t x = 0, std::uint32_t row = 0) const {
        return unpack_texel(surfaces.info(1).format, surfaces.read(1, {x, row, 0}));
    }
    void set_depth(float depth) {
        const pipeline::SurfaceFormat format = pass.context.depth_format;
        fill(0, [&](std::byte* texel) { pack_depth_stencil(format, {depth_code(format, depth), 0}, texel); });
    }
    void set_colour(const glm::vec4& colour) {
        fill(1, [&](std::byte* texel) { pack_colour(surfaces.info(1).format, colour, texel); });
    }

    /// Cycles at which the first and the last quad of a draw were executed.
    std::pair<sim::Cycle, sim::Cycle> executed(std::uint32_t draw = 0) const {
        const pipeline::DrawOutput& output = rop.draw_outputs()[draw];
        return {output.first_cycle, output.last_cycle};
    }
    /// First channel that the read with this number found, of its first pixel.
    float read_value(std::uint32_t read) { return payloads.values(slots - 1 - read, 0)[0]; }
    sim::Cycle read_at(std::uint32_t read) { return payloads[slots - 1 - read].last_read; }
    float stored(std::uint32_t block, std::uint32_t float_ = 0) { return kbuffer.latest(block, 0)[float_]; }

    /// Cycles at which requests of a client came to memory, and the lines of these requests, where each asks for a
    /// whole one.
    std::vector<sim::Cycle> request_cycles(pipeline::MemoryClient client) const {
        std::vector<sim::Cycle> cycles;
        for (const auto& [request, cycle] : memory.arrivals)
            if (request.client == client) cycles.push_back(cycle);
        return cycles;
    }
    std::vector<std::uint64_t> requested_lines(pipeline::MemoryClient client) const {
        std::vector<std::uint64_t> lines;
        for (const auto& [request, cycle] : memory.arrivals)
            if (request.client == client) lines.push_back((request.address & surface_mask) / request.bytes);
        return lines;
    }

  private:
    static constexpr std::uint64_t surface_mask = (std::uint64_t{1} << 36U) - 1;

    static pipeline::KBufferPlan plan_of(const RopOptions& options) {
        pipeline::KBufferPlan plan;
        plan.site = options.shader    ? pipeline::UpdateSite::fragment_shader
                    : options.blender ? pipeline::UpdateSite::blender
                                      : pipeline::UpdateSite::passes;
        if (options.shader) plan.shader = *options.shader;
        if (options.blender) plan.blender = *options.blender;
        return plan;
    }
    static pipeline::SurfaceStore surfaces_of(const QuadPass& pass) {
        const pipeline::SurfaceLayout& layout = pass.context.layout;
        pipeline::SurfaceInfo depth{.name = "depth", .format = pass.context.depth_format};
        pipeline::SurfaceInfo colour{.name = "colour"};
        if (pass.context.writes_colour()) colour.format = *pass.context.targets[0];
        depth.width = colour.width = layout.width;
        depth.height = colour.height = layout.height;
        depth.planes = colour.planes = layout.samples;
        pack_depth_stencil(depth.format, {farthest_depth(depth.format), 0}, depth.cleared.data());
        return pipeline::SurfaceStore(std::vector{depth, colour});
    }
    template <class Pack>
    void fill(pipeline::SurfaceId surface, Pack pack) {
        for (std::uint32_t row = 0; row < surfaces.rows(surface); ++row)
            for (std::uint32_t x = 0; x < pass.context.layout.width; ++x) pack(surfaces.written(surface, {x, row, 0}));
    }
    pipeline::RopSurfaces bound(const RopOptions& options) {
        fixed.surfaces = &surfaces;
        fixed.depth = 0;
        if (pass.context.writes_colour()) fixed.targets = {1};
        fixed.depth_clear = {&depth_clear};
        fixed.colour_clear = {&colour_clear};
        return {&fixed,   options.shader || options.blender ? &kbuffer : nullptr,
                &history, options.shader ? &payloads : nullptr,
                nullptr,  &kbuffer_clear};
    }
    pipeline::RopShape shape() const {
        return {1,         pass.context.shader_costs.size(), true, true, 1,
                1U << 20U, // no request is cut
                0};
    }

    std::vector<pipeline::QuadTask> prepared(std::vector<pipeline::QuadTask> tasks, const RopOptions& options) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> predecessors;
        for (pipeline::QuadTask& task : tasks) {
            if (task.kind != pipeline::QuadKind::quad) continue;
            const pipeline::Quad& quad = pass.stream.quads[task.quad];
            for (std::uint32_t pixel = 0; pixel < 4; ++pixel)
                if ((task.mask >> pixel & 1) != 0)
                    task.order[pixel] = predecessors[{pass.context.layout.block_of(quad.x, quad.y), pixel}]++;
            if (options.shader) shade(task);
        }
        return tasks;
    }
    void shade(pipeline::QuadTask& task) {
        task.slot = payloads.take();
        for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
            std::fill_n(payloads.values(task.slot, pixel), pass.program().floats_per_pixel(),
                        static_cast<float>(task.quad + 1));
            for (std::uint32_t target = 0; target < pass.program().targets(); ++target)
                payloads.version(task.slot, pixel, target) = {task.order[pixel], task.order[pixel]};
        }
    }
    std::vector<pipeline::KBufferRead> read_messages(const RopOptions& options) const {
        std::vector<pipeline::KBufferRead> messages;
        for (const std::uint32_t block : options.reads) {
            const auto read = static_cast<std::uint32_t>(messages.size());
            const std::uint64_t targets = (std::uint64_t{1} << pass.program().targets()) - 1;
            messages.push_back({block, slots - 1 - read, targets, 0, 0, static_cast<std::uint16_t>(read)});
        }
        return messages;
    }
};

} // namespace tests
