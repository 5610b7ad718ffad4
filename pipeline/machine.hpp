// A GPU with one k-buffer design, running one frame.
//
// Builds only the units that the frame and the design need and links them; turns each pass of the frame into passes of
// the hardware (one per layer for designs that peel); runs the event core once per pass; compares the surfaces with the
// reference.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/gpu_params.hpp"
#include "pipeline/output/hazard_ledger.hpp"
#include "pipeline/output/kbuffer_design.hpp"
#include "pipeline/reference.hpp"
#include "pipeline/run_result.hpp"
#include "sim/simulation.hpp"

#include <atomic>
#include <memory>
#include <span>
#include <vector>

namespace pipeline {

class ClearBits;
struct PeeledLayer;
struct SurfaceBytes;
struct SurfaceStream;

struct MachineOptions {
    std::uint64_t seed = 1;
    sim::Mode mode = sim::Mode::normal;
    const std::atomic<bool>* stop = nullptr;          ///< becomes true to end the run (throws sim::Interrupted)
    std::atomic<std::uint64_t>* quads_done = nullptr; ///< progress
    sim::Observer* observer = nullptr;
    bool build_everything = false; ///< also units that nothing needs; results do not change
    bool keep_accesses = false;    ///< when each fragment read and stored its pixel: see accesses()
};

class Machine {
  public:
    /// @param streams what rasterize_frame() makes of `frame`; they, `frame` and `design` must outlive the machine
    /// Throws sim::InputError when the design cannot run the frame's program.
    Machine(const GpuParams& gpu, const Frame& frame, std::span<const FragmentStream> streams,
            const KBufferDesign& design, const MachineOptions& options = {});
    ~Machine();

    /// Runs the frame once. `reference` is run_reference() of the same frame and streams, with rop.fp16_overflow.
    RunResult run(const ReferenceImage& reference);

    /// Every store of the run with the time of the read it was computed from, group by group in the order of the
    /// stores; of a machine that keeps them.
    std::vector<HazardLedger::Access> accesses() const;

    /// Quads that a run dispatches over all its passes, for progress.
    static std::uint64_t total_quads(const Frame& frame, std::span<const FragmentStream> streams,
                                     const KBufferDesign& design);

  private:
    struct Units;

    void build();
    void link();
    void begin(const std::string& name);
    void end();
    void clear(const Pass& pass);
    void draw(const Pass& pass, const FragmentStream& stream);
    /// The surfaces of a pass become those of the ROPs.
    void bind(const Pass& pass, const FragmentStream& stream);
    void drop_written(std::span<const SurfaceId> written);
    /// The texture caches forget what lies in [begin, end) of memory.
    void drop_texture_lines(std::uint64_t begin, std::uint64_t end);
    void run_and_judge(std::size_t number, const FragmentStream& stream, const ReferenceImage& reference);
    /// @param triangle the draw whose triangle covers the screen, or stands for one that does
    void screen(const ScreenPass& pass, std::uint32_t triangle, std::uint64_t written_address);
    void draw_layers(const Pass& pass, const FragmentStream& stream);
    void clear_layers();
    void keep_both_ends(std::size_t pixel, const std::vector<PeeledLayer>& near_layers,
                        const std::vector<PeeledLayer>& far_layers, const FragmentStream& stream);
    void keep_entry(std::size_t pixel, std::uint32_t entry, QuadId id, const FragmentStream& stream);
    void draw_lists(const Pass& pass, const FragmentStream& stream);
    void run_lists(const FragmentStream& stream);
    bool overflowed(std::size_t place, std::uint32_t fragments) const;
    static std::uint32_t geometry_passes(const KBufferPlan& plan, const ModifyProgram& program);
    bool pass_reads_textures() const;
    bool peels() const; ///< the k-buffer pass becomes one pass per layer
    bool keeps_lists() const;
    bool locks() const;
    bool rejects_early() const;
    /// @param switches writes to other targets than the draw before
    void run_draw(const FragmentStream& stream, const Needs& needs, bool switches = true);
    bool switches_targets(const Pass& pass); ///< and remembers those of the pass
    /// Of all groups together; it runs when the simulation does.
    void stream_surface(SurfaceStream stream);
    bool clears_fast(const SurfaceLayout& layout) const;
    /// Marks the surface cleared where the table of fast clears holds it; else streams its bytes.
    void clear_surface(ClearBits& bits, const SurfaceLayout& layout, std::uint64_t pixels, const SurfaceBytes& surface);
    void resolve_cleared(ClearBits& bits, const SurfaceBytes& surface);
    void resolve_cleared(std::span<const SurfaceId> read);  ///< surfaces that a shader is about to read
    void forget_entries();                                  ///< of the k-buffer, which is cleared
    std::uint32_t kbuffer_bytes() const;                    ///< per pixel: entries, or heads of lists
    std::uint64_t kbuffer_address(SurfaceId kbuffer) const; ///< likewise
    std::uint64_t own_address() const;                      ///< where memory begins that no surface of the frame takes
    void set_costs(const Needs& needs);
    SurfaceLayout layout_of(std::uint32_t width, std::uint32_t height, std::uint32_t samples = 1) const {
        return {width, height, gpu_.rop.groups(), samples};
    }
    SurfaceLayout layout_of(const View& view) const { return layout_of(view.width, view.height, view.samples); }
    /// Compares what pass `number` wrote with the reference of it on `before`, the surfaces as it found them.
    void judge(std::size_t number, const FragmentStream& stream, SurfaceStore& before, const ReferenceImage& reference);
    void compose_and_judge(std::size_t number, const ReferenceImage& reference);
    void note_clear(std::size_t number, const ReferenceImage& reference);
    void list_units(RunResult& result) const;
    void collect_pixels(RunResult& result, const ReferenceImage& reference) const;
    void judge_pixels(RunResult& result, const ReferenceImage& reference, std::vector<std::uint8_t> wrong,
                      const std::vector<std::uint8_t>& tied) const;
    bool faultless(SurfaceId surface) const; ///< each pass that wrote it was right about what it had read
    void explain_peeling(std::vector<std::uint8_t>& facts) const;
    /// Places where colour or depth differ from the reference: 1; by the fault of what their passes read: 2.
    std::vector<std::uint8_t> wrong_fixed_places(const RunResult& result, const ReferenceImage& reference) const;
    bool explained(std::size_t place) const; ///< a hazard happened here
    void collect_hazards(RunResult& result) const;
    void collect_counters(RunResult& result);
    void collect_vertex_caches(RunResult& result) const;
    void collect_draws(RunResult& result);
    struct DrawCounters {
        std::uint32_t draw = 0;
        std::vector<std::uint64_t> counters; ///< as RunResult::draw_counters names them
    };
    using DrawSnapshot = std::vector<DrawCounters>;
    std::vector<std::uint64_t> draw_counters(std::uint32_t draw) const;
    DrawSnapshot counters_of_draws(const FragmentStream& stream) const;
    void book_draws(DrawSnapshot&& before); ///< what they gained since, as the present pass's
    bool uses_depth() const;
    bool uses_colour() const;

    GpuParams gpu_;
    const Frame* frame_;
    std::span<const FragmentStream> streams_;
    const KBufferDesign* design_;
    MachineOptions options_;
    KBufferPlan plan_;
    std::unique_ptr<Units> units_;
    std::vector<PassResult> passes_;
    std::vector<PassJudgement> judgements_;
    std::vector<PassDrawResult> pass_draws_;
    std::vector<bool> diverged_;           ///< by surface: it is not what the reference of the frame has at this time
    std::vector<float> layers_;            ///< k-buffer content put together from peeled layers
    std::vector<SurfaceId> targets_;       ///< that the last pass wrote to
    std::uint64_t lost_before_clears_ = 0; ///< updates of k-buffers that were cleared since
    bool textures_linked_ = false;
};

} // namespace pipeline
