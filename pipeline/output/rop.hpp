// A ROP partition: the raster operations of the pixels it owns, with their tile caches, in front of one memory
// partition.
//
// Modelled: in-order input queue whose tile lookups run ahead of execution; tile caches for depth, colour and k-buffer;
// depth test, colour write and fixed blending; stores of k-buffer values computed by the shader; the programmable
// blender with its interlock; k-buffer reads from texture units, served from the tile cache or from memory as the
// visibility rule says; units that modify pixels in place (programmable blender, peeling unit, atomic minima); lists of
// fragments; write-back on replacement, on command and at the end of a pass; clears and copies as streams of memory
// traffic. Every access to a pixel's state happens in this one component, reads before writes within a cycle.
// A group of sample quads is taken apart as it enters the queue, one sample quad per cycle: from there on each has its
// own tile, test, program run and bytes.
// Not modelled: stencil, logic operations, compression, tests and stores of several samples at once.
// Source: specification 004, sections 2.1, 7 (rop parameters), 7.1 (t_rop, t_vis), 7.3, 7.4, 7.6 and 8.
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "pipeline/fragment/quad_payloads.hpp"
#include "pipeline/memory/messages.hpp"
#include "pipeline/output/fragment_lists.hpp"
#include "pipeline/output/hazard_ledger.hpp"
#include "pipeline/output/programmable_blender.hpp"
#include "pipeline/output/rop_params.hpp"
#include "sim/channel.hpp"

#include <deque>
#include <memory>
#include <vector>

namespace pipeline {

/// What the fixed-function ROP reads and writes, in row order; each pixel is touched by the partition that owns it.
struct FixedSurfaces {
    std::vector<DepthCode> depth;
    std::vector<QuadId> winner;    ///< ~0 = cleared
    std::vector<glm::vec4> colour; ///< linear RGBA, as the colour format holds it; empty when no pass writes colour
    // Where a pass captures the farthest fragment, too.
    std::vector<DepthCode> far_depth; ///< 0 = cleared
    std::vector<QuadId> far_winner;
};

/// What one draw did to the output stage.
struct DrawOutput {
    std::uint64_t quads = 0, fragments = 0, hazards = 0;
    sim::Cycle first_cycle = ~sim::Cycle{0}, last_cycle = 0;
};

/// Surfaces and per-pixel books that all partitions of a machine share, each its own pixels.
struct RopSurfaces {
    FixedSurfaces* fixed = nullptr;
    KBufferMemory* kbuffer = nullptr;
    StoreHistory* history = nullptr;
    QuadPayloads* payloads = nullptr;
    FragmentLists* lists = nullptr;
};

/// What a partition is built for.
struct RopShape {
    std::uint32_t pipes = 1;         ///< texture units that may read the k-buffer
    std::uint32_t tiles = 0;         ///< of the largest surface that any pass draws onto
    std::size_t draws = 0;           ///< draws of the frame, for the counters per draw
    bool depth = true;               ///< has a depth tile cache
    bool colour = true;              ///< has a colour tile cache
    std::uint32_t kbuffer_tiles = 0; ///< tiles of its k-buffer tile cache, 0 to 2^26 - 1
};

class Rop final : public sim::Component {
  public:
    sim::In<QuadTask> quads_in{*this, "quads_in"};
    sim::Out<MemoryRequest> memory_out{*this, "memory_out"};
    sim::In<MemoryResponse> memory_in{*this, "memory_in"};
    sim::Out<Commit> commits_out{*this, "commits_out"};       ///< linked when someone waits for stores
    sim::Out<Commit> releases_out{*this, "releases_out"};     ///< the same stores, linked when shaders hold locks
    sim::Out<LastEntryBound> bounds_out{*this, "bounds_out"}; ///< linked when fragments are rejected early
    std::deque<sim::In<KBufferRead>> reads_in;                ///< one per pipe, when shaders read the k-buffer
    std::deque<sim::Out<KBufferReadDone>> reads_out;
    std::deque<sim::Out<LineInvalidation>> invalidations_out; ///< one per pipe, when texture caches are kept coherent

    Rop(sim::Context context, const RopParams& params, const PassContext& pass, const KBufferPlan& plan,
        const RopSurfaces& surfaces, const RopShape& shape);

    RopStats stats() const;
    const HazardLedger& ledger() const { return ledger_; }
    const std::vector<DrawOutput>& draw_outputs() const { return draw_outputs_; }

    // Called between runs of the event core; the next run does the work.
    /// Forgets which tiles are on chip; all must be clean.
    void begin_pass();
    void write_back_all();
    /// Streams that many bytes of this partition's share of a surface.
    void stream(std::uint64_t read_bytes, std::uint64_t write_bytes);

  private:
    static constexpr std::uint32_t no_entry = TileCache::none;
    static constexpr std::uint32_t stream_chunk = 256;
    static constexpr std::uint64_t pool_address = std::uint64_t{1} << 42U; ///< of the lists' fragments
    static constexpr std::uint32_t largest_request = 4096;                 ///< bytes; see MemoryRequest
    static constexpr std::uint32_t request_room = 72;  ///< one step adds at most this many: all targets of one read
    static constexpr std::uint32_t stream_window = 16; ///< chunk reads outstanding

    enum class Use : std::uint8_t { depth, colour, kbuffer };
    struct Queued {
        QuadTask task;                                                    ///< of one sample
        std::array<std::uint32_t, 3> entry{no_entry, no_entry, no_entry}; ///< by Use
    };
    struct ReadJob {
        KBufferRead read;
        std::uint32_t outstanding = 0;
    };
    struct TileRead { ///< served from the tile cache
        KBufferRead read;
        sim::Cycle ready = 0;
    };
    struct PendingBlend { ///< a result inside a blender without interlock
        std::uint32_t block = 0, pixel = 0;
        PixelVersion version;
        sim::Cycle written = 0;
    };

    sim::Activity tick() override;
    bool take_memory();
    bool accept_reads();
    bool serve_tile_reads();
    bool admit();
    QuadTask next_part(const QuadTask& task) const;
    void part_taken(const QuadTask& part);
    std::uint32_t secure_tile(Use use, std::uint32_t tile);
    bool execute(sim::Activity& waiting);
    bool stream_next();
    bool send_requests();
    bool send_answers();
    bool send_invalidations();
    bool write_back_next();

    TileCache& cache(Use use);
    std::uint32_t tile_bytes(Use use) const;
    std::uint64_t tile_address(Use use, std::uint32_t tile) const;
    bool fetches(Use use) const;
    void request(std::uint64_t address, std::uint32_t bytes, std::uint32_t tag, MemoryClient client, bool write,
                 std::uint32_t draw);
    void request_tile(Use use, std::uint32_t tile, std::uint32_t tag, MemoryClient client, bool write);
    void clean(Use use, std::uint32_t entry);
    void publish(std::uint32_t tile);
    void sample(const KBufferRead& read, std::uint64_t targets);
    std::uint32_t run_depth_colour(const Queued& queued);
    void write_colour(QuadId quad, std::uint32_t pixel, std::size_t at);
    std::uint32_t run_store(const Queued& queued);
    std::uint32_t run_blend(const Queued& queued);
    std::uint32_t run_append(const Queued& queued);
    void capture_farthest(QuadId quad, std::size_t at, DepthCode code);
    bool hazardous_store(const Queued& queued, std::uint32_t block, std::uint32_t pixel, PixelVersion& oldest);
    std::uint32_t unit_work(const float* pixel, const float* entry) const;
    void note_bound(std::uint32_t block, std::uint32_t pixel);
    float last_depth(std::uint32_t block, std::uint32_t pixel);
    bool send_bounds();
    bool kbuffer_on_chip(std::uint32_t tile) const;
    void apply_pending_blends();
    void finish(const Queued& queued, bool hazardous);
    std::uint32_t rops() const;
    std::uint32_t cycles_for(std::uint32_t bytes) const; ///< over the ports of the partition's ROPs, at least 1

    RopParams params_;
    const PassContext* pass_;
    const KBufferPlan* plan_;
    RopSurfaces surfaces_;
    std::vector<std::string> port_names_;
    RopStats stats_;
    TileCache depth_tiles_, colour_tiles_, kbuffer_tiles_;
    std::unique_ptr<ProgrammableBlender> blender_;
    HazardLedger ledger_;
    std::vector<DrawOutput> draw_outputs_;
    FixedQueue<Queued> queue_;
    FixedQueue<MemoryRequest> requests_;
    FixedQueue<TileRead> tile_reads_;
    FixedQueue<KBufferRead> answers_;
    FixedQueue<std::uint32_t> invalidations_;
    FixedQueue<LastEntryBound> bounds_;
    float cleared_depth_ = 0;        ///< of the program's last entry
    std::vector<float> tile_bounds_; ///< sent last, by tile; empty when nothing is rejected early by tile
    std::vector<ReadJob> jobs_;
    std::vector<std::uint32_t> free_jobs_;
    std::vector<std::uint32_t> unpublished_;   ///< tiles evicted while nothing may become visible
    std::vector<std::uint8_t> is_unpublished_; ///< by tile
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
    std::uint64_t stream_reads_ = 0, stream_writes_ = 0, stream_address_ = 0;
    std::uint32_t stream_outstanding_ = 0;
};

} // namespace pipeline
