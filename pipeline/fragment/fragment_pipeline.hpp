// A quad pipeline: shades quads, many in flight, and reads textures, peeled layers and (on existing hardware) the
// k-buffer.
//
// Modelled: W quads in flight, fewer when the shader's registers run out; ALU issue rate; one texture unit with its L1;
// pending lines are merged; misses go to memory (textures) or to the ROP partition that owns the pixel (k-buffer);
// results leave one per cycle, out of order. A k-buffer value is that of the cycle in which the array behind the L1 was
// read: for this quad, for the line it hits, or for the miss it joins. A hit is available after the hit latency, like
// any texel. What the shader does with the value is a second way through the pipe, with the latency of the first and
// issue cycles of its own; quads on their second way issue first. Where the shader has a critical section, it asks the
// lock table before it reads, and runs the program inside. A miss on its way when its line is invalidated serves
// whoever waits for it already, and is not kept. A group of sample quads is shaded once; a shader that peels reads the
// layer before at every sample of the group, and masks those out that it does not capture. The loop of a full-screen
// pass fetches without waiting as long as it hits, and runs as long as its longest pixel; where its loads depend on
// each other they go past the L1, step by step, each when the one before is back. A pass's own shader is run again for
// its instructions and for the lines of the surfaces that it reads; a fetch takes the time of its texels, and a cycle
// more for each further line. Not modelled: individual instructions; branches; several lines of a material's texture.
// Source: specification 004, sections 7, 7.1 (t_disp, t_rd, t_done; read value rule).
#pragma once

#include "pipeline/fixed_queue.hpp"
#include "pipeline/fragment/fragment_params.hpp"
#include "pipeline/fragment/messages.hpp"
#include "pipeline/fragment/pass_context.hpp"
#include "pipeline/fragment/quad_payloads.hpp"
#include "pipeline/fragment/texture_cache.hpp"
#include "pipeline/memory/messages.hpp"
#include "sim/channel.hpp"
#include "sim/described.hpp"
#include "sim/stats.hpp"

#include <deque>
#include <optional>
#include <vector>

namespace pipeline {

struct FragmentPipelineStats {
    sim::Counter quads, fragments, issue_cycles, texture_cycles, peel_rejects, kbuffer_reads, uncached_loads,
        uncached_stores;
    sim::HighWater in_flight_max;
    TextureCacheStats l1;

    static constexpr auto fields() {
        using S = FragmentPipelineStats;
        return std::tuple{sim::field<&S::quads>("Quads shaded").unit("quads"),
                          sim::field<&S::fragments>("Living fragments shaded").unit("fragments"),
                          sim::field<&S::issue_cycles>("Cycles the ALUs were reserved").unit("cycles"),
                          sim::field<&S::texture_cycles>("Cycles the texture unit was reserved").unit("cycles"),
                          sim::field<&S::peel_rejects>("Fragments rejected as not of the layer that the pass captures")
                              .unit("fragments"),
                          sim::field<&S::kbuffer_reads>("Quads that read the k-buffer").unit("quads"),
                          sim::field<&S::uncached_loads>("Loads of full-screen passes past the L1").unit("requests"),
                          sim::field<&S::uncached_stores>("Stores of full-screen passes past the L1").unit("requests"),
                          sim::field<&S::in_flight_max>("Most quads in flight").unit("quads"),
                          sim::field<&S::l1>("Texture L1 cache")};
    }
};
static_assert(sim::fully_described<FragmentPipelineStats>);

class FragmentPipeline final : public sim::Component {
  public:
    sim::In<QuadTask> quads_in{*this, "quads_in"};
    sim::Out<Completion> done_out{*this, "done_out"};
    sim::Out<MemoryRequest> textures_out{*this, "textures_out"}; ///< linked when textures are read
    sim::In<MemoryResponse> textures_in{*this, "textures_in"};
    std::vector<sim::Out<KBufferRead>> reads_out; ///< one per ROP partition, when the shader reads the k-buffer
    std::vector<sim::In<KBufferReadDone>> reads_in;
    std::vector<sim::In<LineInvalidation>> invalidations_in; ///< one per partition, when this cache is kept coherent
    sim::Out<LockRequest> locks_out{*this, "locks_out"};     ///< linked when shaders have a critical section
    sim::In<LockGrant> locks_in{*this, "locks_in"};

    /// @param site null when the shader does not read the k-buffer
    /// @param payloads null likewise
    FragmentPipeline(sim::Context context, std::uint16_t pipe, const FragmentParams& params,
                     const TextureParams& texture, const PassContext& pass, std::uint32_t partitions,
                     const ShaderSite* site, QuadPayloads* payloads);

    const FragmentPipelineStats& stats() const { return stats_; }
    /// Drops all k-buffer lines and sets the quads in flight from the registers of the pass; between passes.
    void begin_pass(std::uint32_t registers_per_fragment);
    /// Drops the lines of a surface that was written: bytes [begin, end).
    void drop_surface(std::uint64_t begin, std::uint64_t end);

  private:
    static constexpr std::uint16_t nobody = 0xFFFF;
    static constexpr std::uint32_t uncached_tag = 1U << 16U; ///< of answers that no line of the L1 waits for

    struct Thread {
        QuadTask task;
        std::uint64_t own = 0;    ///< render targets asked for and not answered
        std::uint64_t merged = 0; ///< render targets another thread has asked for
        std::uint64_t lined = 0;  ///< of `own`, those that fill lines reserved for them in the L1
        std::uint32_t block = 0;
        std::uint32_t generation =
            0;                 ///< of L1 when the lookup was made, or one of its own when the line was invalidated
        std::uint32_t alu = 0; ///< cycles its instructions need to issue, on the way through the pipe that comes next
        sim::Cycle looked_up = 0;                ///< when it looked for its pixel's entries
        std::uint32_t line = TextureCache::none; ///< texture line this thread is filling
        std::uint32_t fetch = 0;                 ///< next of the quad's read-only fetches
        std::uint32_t fixed_fetches = 0;         ///< how many come before those of the surfaces that its shader reads
        std::uint32_t fetches = 0;               ///< how many there are
        std::uint32_t step = 0;                  ///< next of its dependent steps past the L1
        std::uint32_t steps = 0;
        std::uint32_t loads = 0;     ///< of the present step, on their way
        std::uint16_t next = nobody; ///< in the chain of threads that wait for one block or line
    };
    struct Chain { ///< of threads, the oldest first
        std::uint16_t first = nobody;
        std::uint16_t last = nobody;
    };
    struct Timed {
        std::uint16_t thread = 0;
        sim::Cycle ready = 0;
    };

    sim::Activity tick() override;
    bool take_answers();
    bool finish_one();
    bool take_hits();
    bool ask_for_lock();
    bool lookup_next();
    bool read_kbuffer_of_next();
    bool issue_next();
    bool send_texture_request();
    void invalidate(std::uint32_t block);
    void start(const QuadTask& task);
    void fetch_textures(std::uint16_t thread);
    void use_texture_unit(sim::Cycle cycles);
    std::uint32_t filter_cycles(std::uint32_t texel_bytes) const;
    std::uint32_t fetch_cycles(std::uint16_t thread) const;
    std::uint64_t fetch_line(std::uint16_t thread) const;
    bool reads_texture(const QuadTask& task) const;
    /// Fetches of a quad before those of the surfaces that its shader reads.
    std::uint32_t fetches_before_surfaces(const QuadTask& task) const;
    void run_shader(std::uint16_t thread);
    void texture_arrived(std::uint16_t thread);
    void fetched(std::uint16_t thread);
    bool take_steps(std::uint16_t thread);
    void load_arrived(std::uint16_t thread);
    void shaded(std::uint16_t thread);
    void after_values(std::uint16_t thread);
    bool issue_program();
    bool take_programs();
    void issue(std::uint16_t thread, std::uint32_t cycles);
    void lookup_targets(std::uint16_t index);
    bool send_read(std::uint16_t index);
    void kbuffer_arrived(std::uint16_t index);
    void give_to_waiting(const Thread& from, std::uint64_t targets);
    void finish_complete(std::uint32_t block);
    void fill_l1(const Thread& thread, std::uint64_t targets);
    bool locks() const { return site_ != nullptr && site_->critical_section != CriticalSection::none; }
    bool uses_l1() const { return !site_->bypass_l1 && l1_.enabled(); } ///< for the k-buffer
    void append(Chain& chain, std::uint16_t thread);
    void run_program(const QuadTask& task);
    bool is_behind(float depth, QuadId quad, std::size_t pixel) const;
    bool is_before(float depth, QuadId quad, std::size_t pixel) const;
    bool is_captured(float depth, QuadId quad, std::size_t pixel) const;
    std::uint32_t captured_samples(const QuadTask& task) const;
    std::uint64_t all_targets() const {
        return program_targets_ == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << program_targets_) - 1;
    }
    sim::Cycle next_event();

    std::uint16_t pipe_;
    FragmentParams params_;
    TextureParams texture_;
    const PassContext* pass_;
    const ShaderSite* site_;
    QuadPayloads* payloads_;
    std::uint32_t program_targets_ = 0;
    std::uint32_t line_targets_ = 0;
    std::vector<std::string> port_names_;
    TextureCache l1_;
    FragmentPipelineStats stats_;
    std::vector<Thread> threads_;
    std::vector<QuadWork> work_; ///< by thread: of the shader that the pass brings
    std::vector<std::uint16_t> free_threads_;
    std::uint32_t thread_limit_ = 0;
    std::vector<Chain> block_chain_;      ///< threads that wait for lines of a block
    std::vector<Chain> line_chain_;       ///< threads that wait for a texture line of L1
    FixedQueue<Timed> shading_;           ///< in the ALUs, in order
    FixedQueue<std::uint16_t> locked_;    ///< inside their critical section, about to read
    FixedQueue<Timed> hits_;              ///< all render targets hit L1, values on their way through the texture unit
    FixedQueue<std::uint16_t> returned_;  ///< values are there, the program has not been issued
    FixedQueue<Timed> programs_;          ///< in the ALUs for the second time, in order
    FixedQueue<std::uint16_t> finished_;  ///< shader done, result waits for the way out
    FixedQueue<std::uint16_t> unsent_;    ///< texture requests the link had no room for
    std::deque<MemoryRequest> uncached_;  ///< loads and stores past the L1 the link had no room for
    std::vector<MemorySegment> segments_; ///< of one step
    std::optional<std::uint16_t> read_in_hand_; ///< looked up, request not sent yet
    sim::Cycle issue_free_ = 0;
    sim::Cycle texture_free_ = 0;
    std::uint32_t call_ = ~std::uint32_t{0};    ///< draw call of the youngest quad, for invalidate_on_draw
    std::uint32_t orphans_ = ~std::uint32_t{0}; ///< next generation of lines invalidated on their way
};

} // namespace pipeline
