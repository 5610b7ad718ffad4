// The contract of a k-buffer design: where it reads and writes, what protects that, and how it turns one k-buffer pass
// into passes of the machine. A design is one file in models/kbuffers plus one line in its list.
//
// Source of the options: specification 004, section 7 (Bavoil 2007, sections 4.3.1, 4.3.2, 6.5).
#pragma once

#include "pipeline/fragment/dispatch_guard.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/output/added_hardware.hpp"
#include "pipeline/output/kbuffer.hpp"
#include "pipeline/output/kbuffer_options.hpp"
#include "sim/described.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pipeline {

/// What separates two batches of primitives on hardware that does not protect them.
struct FlushRule {
    std::uint32_t every_triangles = 0; ///< 0 = never
    bool every_draw = false;           ///< at every draw boundary
    bool drain = true;                 ///< wait until all quads in flight have stored
    bool writeback = true;             ///< make all stores observable
    bool invalidate = true;            ///< drop the texture caches' k-buffer lines
    /// Pixels per cycle of the full-screen quad, all its writes masked, that forces the flush; 0 = it costs nothing.
    std::uint32_t quad_pixels_per_clk = 0;
    bool active() const { return every_triangles != 0 || every_draw; }
};

struct ShaderSite {
    Visibility visibility = Visibility::writeback;
    TextureCoherence coherence = TextureCoherence::invalidate_on_draw;
    bool bypass_l1 = false;     ///< k-buffer reads do not look into the texture cache
    bool atomic_reads = false;  ///< one read returns all render targets of a pixel at one instant
    bool write_through = false; ///< a store cleans its tile at once
    FlushRule flush;
    CriticalSection critical_section = CriticalSection::none;
    LockArea lock_area = LockArea::pixel;
    std::uint32_t lock_latency = 1;   ///< cycles from a pipe to the lock table, and back
    std::uint32_t grants_per_clk = 4; ///< critical sections entered per cycle
    bool tile_memory = false;         ///< the whole k-buffer is on chip; memory is touched at the end of the pass only
    /// Of a k-buffer read that finds its pixels on chip: to the access, and behind it; both 0 = the GPU's.
    std::uint32_t read_request_latency = 0, read_return_latency = 0;
    std::uint32_t version_bits = 0; ///< stored with each pixel, to detect hazards; 0 = none
};

struct BlenderSite {
    BlendInterlock interlock = BlendInterlock::stall;
    std::uint32_t lanes = 4;       ///< scalar operations per cycle of one ROP's blender
    std::uint32_t port_bytes = 32; ///< tile cache port of one ROP, bytes per cycle
    std::uint32_t latency = 16;    ///< cycles from read to write
    InterlockTest test = InterlockTest::exact;
    std::uint32_t test_entries = 0;    ///< quads that fit into the unit (exact; 0 = all), counters (hashed)
    std::uint32_t atomics_per_clk = 1; ///< of one ROP, for BlendUnit::atomic_min
    EarlyReject early_reject = EarlyReject::none;
    BlendUnit unit = BlendUnit::program;
};

struct PassesSite {
    PeelRule rule = PeelRule::exact;
    double eps = 1e-4;
    SurfaceFormat depth_format = SurfaceFormat::d32f;
    PassCapture capture = PassCapture::nearest;
    std::uint32_t passes = 0; ///< geometry passes; 0 = one for each entry
};

/// Fragments of a pixel kept in order of arrival, to be put into its entries by a later full-screen pass.
struct ListsSite {
    std::uint32_t fragment_bytes = 32; ///< of one kept fragment with its link
    std::uint32_t head_bytes = 4;      ///< per pixel, read and written for each fragment
    std::uint64_t pool = 0;            ///< fragments that fit into memory, of all pixels together; 0 = no limit
    std::uint32_t per_pixel = 0;       ///< fragments of a pixel that one geometry pass keeps; 0 = no limit
    std::uint32_t passes = 1;          ///< geometry passes, each keeping the next `per_pixel` fragments
    ListCounter counter = ListCounter::quad;
    std::uint32_t counter_per_clk = 0; ///< atomics per cycle that the counter of the pool serves; 0 = no counter
    bool chained = true;               ///< each node is found through the one before; else they are an array
    ListSort sort = ListSort::full;
    std::uint32_t array_registers = 0; ///< of a lane, that hold the first places of the sorted array; see list_sort.hpp
};

/// Hardware in front of the pipes, when the design has any.
struct SchedulingPlan {
    std::unique_ptr<DispatchGuard> guard;
    std::uint32_t side_buffer = 32;   ///< quads that wait for a conflict
    std::uint32_t lookups = 4;        ///< quads tested per cycle
    std::uint32_t wakes = 1;          ///< waiting quads dispatched per cycle
    std::uint32_t lookup_latency = 2; ///< cycles
    DispatchPolicy policy = DispatchPolicy::any_pipe;
    bool order_rule = true; ///< a quad also waits behind older waiting quads of its key
    /// Areas whose quads are numbered in raster order, for locks coarser than a pixel.
    std::optional<LockArea> tickets;
};

struct KBufferPlan {
    UpdateSite site = UpdateSite::fragment_shader;
    ShaderSite shader;
    BlenderSite blender;
    PassesSite passes;
    ListsSite lists;
    SchedulingPlan scheduling;
    Retirement retirement = Retirement::in_order;
    /// Stores may happen in another order than that of the primitives; entries may then differ from the reference among
    /// fragments of equal depth, and nowhere else.
    bool order_free = false;

    /// Pixels of several samples are shaded once, and a unit behind the shader does its work at every sample. A shader
    /// works on pixels: where it updates them, each sample has to be shaded as a pixel of its own (supersampling).
    /// Specification 004, sections 4.3.1, 6.1 and 7.3.
    bool works_per_sample() const { return site == UpdateSite::blender || site == UpdateSite::passes; }
};

/// How the application hands the triangles of k-buffer passes to the GPU for a design.
struct SubmissionPlan {
    bool sort_by_centroid = false;     ///< front to back (A8)
    std::uint32_t batch_triangles = 0; ///< one draw per so many triangles (A9); 0 = draws stay as they are
    bool flush_draws = false;          ///< a draw of the flushing quad behind each draw
    double sort_ns_per_triangle = 0;   ///< of the computer's time, before the frame
    bool changes() const { return sort_by_centroid || batch_triangles != 0 || flush_draws; }
    bool operator==(const SubmissionPlan&) const = default;
};

class KBufferDesign {
  public:
    virtual ~KBufferDesign() = default;

    virtual std::string_view id() const = 0;
    virtual std::string_view summary() const = 0;
    /// Why the design cannot run this program; empty when it can.
    virtual std::string refuses(const ModifyProgram& program) const = 0;
    /// How the triangles come; by default as the scene has them.
    virtual SubmissionPlan submission() const { return {}; }
    /// A fresh plan for one machine.
    virtual KBufferPlan plan(const ModifyProgram& program, const View& view) const = 0;
    /// Effective parameters.
    virtual sim::DescribedRef parameters() const = 0;
    /// What it adds to a GPU of this shape.
    virtual AddedHardware area(const ModifyProgram& program, const View& view, const GpuShape& shape) const = 0;
};

} // namespace pipeline
