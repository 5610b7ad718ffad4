// What one run of one design on one frame produced: pixels, hazards, cycles and every counter.
#pragma once

#include "pipeline/output/hazards.hpp"
#include "pipeline/surface.hpp"
#include "sim/field.hpp"
#include "sim/json_value.hpp"
#include "sim/time.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pipeline {

/// Difference of layer i to the reference, in pixels.
struct LayerErrors {
    std::uint64_t missing = 0;   ///< entry of the reference found in no layer of the run
    std::uint64_t duplicate = 0; ///< entry found more often than in the reference
    std::uint64_t unsorted = 0;  ///< nearer than the layer before it
};

/// Wrong pixels by what made them wrong, each counted once: the first of these that applies.
struct WrongBecause {
    std::uint64_t unexplained = 0;  ///< none of the others: 0 by law
    std::uint64_t hazard = 0;       ///< a hazard happened there
    std::uint64_t overflow = 0;     ///< more fragments than the design holds
    std::uint64_t tie = 0;          ///< fragments of equal depth, of a design free of order
    std::uint64_t depth_format = 0; ///< peeled layers that lie nearer to each other than the depth format can tell
    std::uint64_t eps = 0;          ///< peeled layers within eps of each other, by the eps rule
    std::uint64_t inputs = 0;       ///< a pass without fault read what one before it had left wrong

    static constexpr auto fields() {
        using S = WrongBecause;
        return std::tuple{
            sim::field<&S::unexplained>("no reason is known").unit("pixels"),
            sim::field<&S::hazard>("a hazard happened there").unit("pixels"),
            sim::field<&S::overflow>("there are more fragments than the design holds").unit("pixels"),
            sim::field<&S::tie>("fragments have equal depths, and the design is free of order").unit("pixels"),
            sim::field<&S::depth_format>("layers lie nearer to each other than the depth format of the "
                                         "passes can tell apart")
                .unit("pixels"),
            sim::field<&S::eps>("layers lie within eps of each other").unit("pixels"),
            sim::field<&S::inputs>("a pass read what one before it had left wrong elsewhere").unit("pixels")};
    }
};
static_assert(sim::fully_described<WrongBecause>);

/// Counters of one pass as the design executed it (one design may execute a frame's pass several times).
struct PassResult {
    std::string name;
    sim::Cycle first_cycle = 0, cycles = 0;
    sim::JsonValue counters; ///< stage name -> counters of this pass
};

/// A surface of the frame, and what its content took.
struct SurfaceResult {
    SurfaceInfo info;
    SurfaceMemory memory;
};

/// Counters of one draw, over all passes; RunResult::draw_counters says which. There may be a million of them.
struct DrawResult {
    std::string name;
    std::uint32_t draw = 0;
    std::vector<std::uint64_t> counters;
};

/// The part of a draw's counters that one pass added; cycles of first and last quads are 0.
struct PassDrawResult {
    std::uint32_t pass = 0; ///< index into RunResult::passes
    std::uint32_t draw = 0;
    std::vector<std::uint64_t> counters;
};

/// A surface after a pass, against the reference of that pass alone on what the run had before it.
struct PassJudgement {
    std::string pass, surface;
    std::uint64_t wrong_places = 0; ///< texels, or pixels of a k-buffer, that differ in any bit
    bool other_inputs = false;      ///< a pass before has left other surfaces than the reference of the whole frame
};

struct RunResult {
    std::string design;
    double core_mhz = 0;
    sim::Cycle cycles = 0;        ///< core cycles from the first command to the last byte written
    double sort_milliseconds = 0; ///< of the computer's time before each frame
    std::uint64_t fragments = 0;  ///< fragments that reached the k-buffer (or depth test), over all passes; one for
                                  ///< each sample of a pixel

    HazardCounts hazards;
    std::vector<HazardPair> pairs;              ///< the first `pairs_kept` in order of the victim's store
    std::vector<std::uint64_t> hazard_distance; ///< bin b: hazards with distance in [2^b, 2^(b+1)) quads
    std::uint64_t max_staleness = 0;
    double mean_staleness = 0;
    std::uint64_t lost_updates = 0;    ///< fragments whose store was overwritten by a stale value
    std::uint64_t wrong_pixels = 0;    ///< pixels that differ from the reference in any bit of any sample
    std::uint64_t tied_pixels = 0;     ///< of those, pixels that differ among fragments of equal depth only
    std::uint64_t overflow_pixels = 0; ///< pixels with more fragments than the design can hold
    WrongBecause wrong_because;
    std::uint64_t unexplained_pixels() const { return wrong_because.unexplained; }
    std::uint64_t lost_fragments = 0; ///< entries of the reference that no layer of the run holds
    std::vector<LayerErrors> layers;

    // Per place, row 0 first: with one sample, width * height pixels; see sample_planes.hpp. The k-buffer and what
    // follows from it are of its own view, colour and depth of the frame's.
    std::vector<float> kbuffer;        ///< floats_per_pixel floats each; empty when the frame has no k-buffer
    std::vector<float> colour;         ///< RGBA of the "colour" surface; empty when the frame has none
    std::vector<float> depth;          ///< window depths of the "depth" surface; empty when the frame has none
    std::vector<std::uint8_t> stencil; ///< of the same surface, where its format has any
    // Per pixel, row 0 first: what happened to any of its samples.
    std::vector<std::uint8_t> hazard_mask; ///< bit i: hazard class i happened here; empty when there was none
    std::vector<std::uint8_t> wrong_mask;  ///< 1 where the pixel differs from the reference

    SurfaceStore shown; ///< surfaces that reports show, and nothing else

    // What was built and left out on this machine for this design.
    std::vector<std::string> built;
    std::vector<std::pair<std::string, std::string>> left_out; ///< unit, reason

    sim::JsonValue stages; ///< stage -> { "params", "counters", "activity" (cycles by activity) }, units summed
    sim::JsonValue stalls; ///< stage -> activity -> fraction of elapsed time
    sim::JsonValue caches; ///< cache -> { accesses, hits, misses, hit_rate }
    sim::JsonValue bytes;  ///< link -> bytes, and bytes per fragment
    sim::JsonValue area;   ///< as area_json() says
    std::vector<SurfaceResult> surfaces;
    std::vector<PassResult> passes;
    std::vector<PassJudgement> judgements;  ///< of the frame's passes that send fragments, in order
    std::vector<std::string> draw_counters; ///< names of DrawResult::counters
    std::vector<DrawResult> draws;
    std::vector<PassDrawResult> pass_draws; ///< where a pass added anything, in the order of the passes

    /// A counter of draw number `draw` by name; 0 when there is none of that name.
    std::uint64_t draw_counter(std::size_t draw, std::string_view counter) const {
        for (std::size_t i = 0; i < draw_counters.size(); ++i)
            if (draw_counters[i] == counter) return draws.at(draw).counters.at(i);
        return 0;
    }

    // Cost of the run itself; everything else above is the same on every machine and for any thread count.
    double host_seconds = 0;
    double cpu_seconds = 0; ///< of the thread that ran it
    std::uint64_t host_ticks = 0;
};

} // namespace pipeline
