// A ROP group: four ROPs that work on one quad at a time, with the caches of the pixels they own, in front of all
// memory partitions.
//
// Modelled: in-order input queue whose lookups run ahead of execution; caches of 2x2 sectors for depth, colour and
// k-buffer, each with a share of the GPU's bytes; stores under a byte mask that fetch nothing; write-back of the dirty
// pixels only, in whole bursts; fast clears, whose sectors are not fetched; stencil and depth test, colour write,
// fixed blending and write masks, with the raster state of each draw; stores of k-buffer values computed by the shader;
// the programmable blender with its interlock; k-buffer reads from texture units, served from the tile cache or from
// memory as the visibility rule says, with the value of the cycle in which that array is read; stores that can be seen
// behind the tile cache when the memory's array has taken the burst that writes them back; units that modify pixels in
// place (programmable blender, peeling unit, atomic minima); lists of fragments; write-back on replacement, on command
// and at the end of a pass; clears and copies as streams of memory traffic. Every access to a pixel's state happens in
// this one component, reads before writes within a cycle. A group of sample quads is taken apart as it enters the
// queue, one sample quad per cycle: from there on each has its own sector, test, program run and bytes. A read of a
// texture unit that finds only some of its pixels in the cache takes the others from memory, and they complete the
// sector as they pass. Not modelled: logic operations, compression, tests and stores of several samples at once.
// Source: specification 004, sections 2.1, 7 (rop parameters), 7.1 (t_rop, t_vis), 7.3, 7.4, 7.6 and 8.
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/fragment/messages.hpp"
#include "pipeline/functional/fragment_operations.hpp"
#include "pipeline/memory/messages.hpp"
#include "pipeline/output/programmable_blender.hpp"
#include "pipeline/output/rop_params.hpp"
#include "pipeline/output/rop_surfaces.hpp"
#include "sim/channel.hpp"

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace pipeline {

class Rop final : public sim::Component {
    sim::InputSet memory_held_, reads_held_;

  public:
    sim::In<QuadTask> quads_in{*this, "quads_in"};
    std::vector<sim::Out<MemoryRequest>> memory_out; ///< one per memory partition
    std::vector<sim::In<MemoryResponse>> memory_in;
    sim::Out<Commit> commits_out{*this, "commits_out"};       ///< linked when someone waits for stores
    sim::Out<Commit> releases_out{*this, "releases_out"};     ///< the same stores, linked when shaders hold locks
    sim::Out<LastEntryBound> bounds_out{*this, "bounds_out"}; ///< linked when fragments are rejected early
    std::vector<sim::In<KBufferRead>> reads_in;               ///< one per pipe, when shaders read the k-buffer
    std::vector<sim::Out<KBufferReadDone>> reads_out;
    std::vector<sim::Out<LineInvalidation>> invalidations_out; ///< one per pipe, when texture caches are kept coherent

    Rop(sim::Context context, const RopParams& params, const PassContext& pass, const KBufferPlan& plan,
        const RopSurfaces& surfaces, const RopShape& shape);

    RopStats stats() const;
    const HazardLedger& ledger() const { return ledger_; }
    void keep_accesses() { ledger_.keep_accesses(); }
    const std::vector<DrawOutput>& draw_outputs() const { return draw_outputs_; }

    // Called between runs of the event core; the next run does the work.
    /// Forgets what is on chip; all must be clean. Shares the caches' bytes among the sectors of the pass's surfaces;
    /// throws sim::InputError when one cannot hold a quad.
    void begin_pass();
    void write_back_all();
    /// Streams this group's share of surfaces, one stream after the other.
    void stream(const SurfaceStream& stream);

  private:
    static constexpr std::uint32_t no_entry = TileCache::none;
    static constexpr std::uint32_t stream_chunk = 256;
    static constexpr std::uint32_t largest_request = 4096; ///< bytes; see MemoryRequest
    static constexpr std::uint32_t request_room = 72;      ///< one step adds at most this many: all targets of one read
    static constexpr std::uint32_t stream_window = 16;     ///< chunk reads outstanding

    static constexpr std::uint32_t rops = 4; ///< of a group

    // Memory tags: the upper bits say what an answer is for.
    static constexpr std::uint32_t tag_tile = 1U << 28U; ///< | use << 26 | entry
    static constexpr std::uint32_t tag_read = 2U << 28U; ///< | job << 7 | target (64 = all targets)
    static constexpr std::uint32_t tag_stream = 3U << 28U;
    static constexpr std::uint32_t tag_store = 4U << 28U; ///< | store in flight; write that can be seen from then on
    static constexpr std::uint32_t tag_kind = 15U << 28U;
    static constexpr std::uint32_t all_target = 64;
    static constexpr sim::Cycle never = ~sim::Cycle{0};

    enum class Use : std::uint8_t { depth, colour, kbuffer };
    struct Queued {
        QuadTask task;                                                    ///< of one sample
        std::array<std::uint32_t, 3> entry{no_entry, no_entry, no_entry}; ///< by Use
    };
    struct ReadJob {
        KBufferRead read;
        std::uint32_t outstanding = 0; ///< requests without an answer
        std::uint32_t unread = 0;      ///< of an atomic read, those whose array has not been read
    };
    struct TimedRead {
        KBufferRead read;
        sim::Cycle ready = 0;
    };
    /// Pixels on their way to memory: what can be seen there once the array has taken them.
    struct StoreInFlight {
        std::uint32_t block = 0, pixels = 0;
        std::vector<float> values;
        std::array<PixelVersion, 4> versions{};
        std::optional<Commit> commit; ///< the quad waits for it, whose store this is
        std::uint32_t parts = 0;      ///< that memory has not taken yet
    };
    struct Coming { ///< an answer of memory whose data are on their way back
        std::uint32_t tag = 0;
        sim::Cycle ready = 0;
    };
    struct PendingBlend { ///< a result inside a blender without interlock
        std::uint32_t block = 0, pixel = 0;
        PixelVersion version;
        sim::Cycle written = 0;
    };

    sim::Activity tick() override;
    bool take_memory();
    void array_accessed(std::uint32_t tag);
    void take_answer(std::uint32_t tag);
    bool accept_reads();
    void accept_read(const KBufferRead& read);
    bool serve_tile_reads();
    bool admit();
    QuadTask next_part(const QuadTask& task) const;
    void part_taken(const QuadTask& part);
    std::uint32_t secure_line(Use use, std::uint32_t block, bool keeps);
    bool execute(sim::Activity& waiting);
    bool stream_next();
    bool send_requests();
    bool send_answers();
    bool send_invalidations();
    bool write_back_next();

    TileCache& cache(Use use);
    const TileCache& cache(Use use) const { return const_cast<Rop*>(this)->cache(use); }
    std::span<ClearBits* const> clear_bits(Use use) const; ///< one for each target that is ever cleared
    std::vector<SurfaceBytes> memory_of(Use use) const;
    std::span<const SurfaceBytes> memory(Use use) const { return memory_[static_cast<std::size_t>(use)]; }
    SectorShape sector_shape(Use use) const;
    std::uint32_t own_lines(const SectorShape& shape) const;
    std::uint32_t lines_that_fit(Use use) const;
    std::uint64_t line_address(Use use, const SurfaceBytes& surface, std::uint32_t line) const;
    const SurfaceUse& use_of_quad(QuadId quad) const { return uses_[pass_->states.number(*pass_->stream, quad)]; }
    bool cleared(Use use, std::uint32_t line) const;
    bool has_room() const; ///< for what one step asks of memory and tells the texture caches
    void request(std::uint64_t address, std::uint32_t bytes, std::uint32_t tag, MemoryClient client, bool write,
                 std::uint32_t draw);
    void fetch(Use use, std::uint32_t entry);
    std::uint32_t write_pixels(Use use, std::uint32_t line, std::uint16_t pixels, std::uint32_t tag,
                               std::uint32_t draw);
    std::uint32_t write_run(std::uint64_t begin, std::uint64_t end, std::uint32_t tag, std::uint32_t draw);
    std::uint32_t parts_of(std::uint64_t address, std::uint32_t bytes) const;
    std::uint16_t with_cleared(Use use, std::uint32_t line, std::uint16_t pixels);
    void clean(Use use, std::uint32_t entry);
    std::uint32_t send_to_memory(std::uint32_t block, std::uint32_t pixels, std::optional<Commit> commit);
    void arrived_in_memory(std::uint32_t store);
    void show(const StoreInFlight& store);
    bool send_commits();
    void sample(const KBufferRead& read, std::uint64_t targets);
    std::uint32_t run_depth_colour(const Queued& queued);
    void store_colours(const RasterState& state, QuadId quad, std::uint32_t pixel, SurfacePlace place);
    FragmentTest test_pixel(const RasterState& state, QuadId quad, SurfacePlace place, DepthCode incoming);
    std::uint32_t run_store(const Queued& queued);
    std::uint32_t run_blend(const Queued& queued);
    std::uint32_t run_append(const Queued& queued);
    void write_nodes(const QuadTask& task, std::uint32_t count);
    void capture_farthest(QuadId quad, std::size_t at, DepthCode code);
    bool hazardous_store(const Queued& queued, std::uint32_t block, std::uint32_t pixel, PixelVersion& oldest);
    std::uint32_t unit_work(const float* pixel, const float* entry) const;
    void note_bound(std::uint32_t block, std::uint32_t pixel);
    float last_depth(std::uint32_t block, std::uint32_t pixel);
    bool send_bounds();
    bool kbuffer_on_chip(const KBufferRead& read) const;
    void apply_pending_blends();
    static Commit commit_of(const Queued& queued);
    void finish(const Queued& queued);
    bool own_read_latency() const {
        return plan_->shader.read_request_latency + plan_->shader.read_return_latency != 0;
    }
    std::uint32_t request_latency() const;               ///< of a k-buffer read, to the tile cache's array
    std::uint32_t return_latency() const;                ///< and back
    std::uint32_t cycles_for(std::uint32_t bytes) const; ///< over the ports of the group's ROPs, at least 1

    RopParams params_;
    const PassContext* pass_;
    const KBufferPlan* plan_;
    RopSurfaces surfaces_;
    std::vector<std::string> port_names_;
    RopStats stats_;
    std::vector<SurfaceUse> uses_; ///< by raster state of the pass
    RopShape shape_;
    TileCache depth_tiles_, colour_tiles_, kbuffer_tiles_;
    std::unique_ptr<ProgrammableBlender> blender_;
    HazardLedger ledger_;
    std::vector<DrawOutput> draw_outputs_;
    FixedQueue<Queued> queue_;
    FixedQueue<MemoryRequest> requests_;
    std::vector<GrowingQueue<Coming>> coming_;               ///< by memory partition, in order
    sim::Cycle first_coming_ = never;                        ///< when the first of them is here
    std::array<std::vector<SurfaceBytes>, 3> memory_;        ///< by Use: where the surfaces of the pass lie
    std::array<std::vector<std::uint32_t>, 3> parts_coming_; ///< of a tile that is fetched, by Use and entry
    FixedQueue<TimedRead> tile_reads_;                       ///< on their way to the tile cache's array
    FixedQueue<TimedRead> tile_answers_;                     ///< and back from it
    FixedQueue<KBufferRead> answers_;
    FixedQueue<std::uint32_t> invalidations_;
    FixedQueue<LastEntryBound> bounds_;
    float cleared_depth_ = 0;        ///< of the program's last entry
    std::vector<float> tile_bounds_; ///< sent last, by tile; empty when nothing is rejected early by tile
    std::vector<ReadJob> jobs_;
    std::vector<std::uint32_t> free_jobs_;
    std::vector<StoreInFlight> stores_;
    std::vector<std::uint32_t> free_stores_;
    std::deque<Commit> commits_;               ///< of stores that memory has taken
    std::vector<std::uint32_t> unpublished_;   ///< blocks in memory while nothing may become visible
    std::vector<std::uint8_t> is_unpublished_; ///< by block
    std::vector<PendingBlend> pending_blends_;
    std::vector<float> pending_values_;
    std::uint32_t draw_ = 0; ///< that memory traffic is booked to
    std::uint32_t next_pipe_ = 0;
    std::uint32_t parts_taken_ = 0; ///< sample quads of the input's first task that are in the queue
    sim::Cycle unit_free_ = 0;
    bool interlocked_ = false; ///< the head of the queue has been counted as stalled
    bool writing_back_ = false;
    bool acknowledge_ = false; ///< the write-back was commanded in band
    std::uint32_t write_back_at_ = 0;
    std::deque<SurfaceStream> streams_; ///< the first one runs; what is left of it
    std::uint32_t stream_outstanding_ = 0;
};

} // namespace pipeline
