// What a comparison of designs on one frame produced; every file and table of a report is made from this.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/run_result.hpp"
#include "sim/config.hpp"
#include "sim/json_value.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace reports {

/// What was drawn, as its file or generator states it.
struct SceneFacts {
    std::string name;
    std::string hash;                  ///< of everything that was read, 16 hexadecimal digits
    std::uint64_t triangles = 0;       ///< in the file, each counted once
    std::uint64_t triangles_drawn = 0; ///< of all instances of all draws
    std::uint64_t vertices = 0;
    std::uint64_t draws = 0;
    std::uint64_t textures = 0;
    std::string camera;             ///< as asked for: "auto"
    std::string view;               ///< that it led to, as traces::make_view() takes it
    std::vector<std::string> notes; ///< what of the input is not drawn, and what was not done as asked for
    struct Captured {
        std::string name, hash; ///< as above, of what the trace was captured from
    };
    std::optional<Captured> captured; ///< of a replayed trace
};

/// The frame after the last pass, row 0 first. With several samples to a pixel, `composite` is their mean, and
/// `kbuffer` that of the first.
struct FramePixels {
    std::vector<float> kbuffer;   ///< floats_per_pixel of the program for each pixel; empty without a k-buffer
    std::vector<float> composite; ///< linear RGBA of the finished picture for each pixel; empty when no pass makes one
    std::vector<float> colour;    ///< RGBA of the "colour" surface; empty when the frame has none
    std::vector<float> depth;     ///< window depths of the "depth" surface, likewise
    pipeline::SurfaceStore shown; ///< surfaces that are shown, and nothing else
};

struct GpuFacts {
    std::string name;
    sim::JsonValue parameters; ///< every effective value, nested by unit
    std::map<std::string, sim::Origin>
        origins; ///< of those values whose origin is stated, by path; also of the designs' parameters
};

/// Cost of the comparison on the machine that ran it: the only numbers that differ between two equal runs.
struct HostCost {
    double seconds = 0;           ///< everything: reading, shading, all runs, comparing
    double front_end_seconds = 0; ///< rasterizing and shading the frame once, and the reference
    std::uint64_t peak_bytes = 0; ///< resident memory at its highest
    unsigned threads = 1;
};

/// What a run was of.
struct VariantFacts {
    std::string design;           ///< id
    std::string text;             ///< "existing?visibility=rop_cache"
    std::string label;            ///< the same, shorter
    sim::JsonValue gpu_changes{}; ///< parameters that differ from `gpu`
};

/// A comparison of designs with the same on-chip bytes.
struct EqualArea {
    std::uint64_t bytes = 0;
    struct Unfit {
        std::string name;
        VariantFacts variant;
        std::uint64_t needed = 0; ///< bytes with the smallest tile caches
    };
    std::vector<Unfit> does_not_fit; ///< designs that did not run
};

struct Comparison {
    SceneFacts scene;
    GpuFacts gpu;
    std::shared_ptr<const pipeline::Frame> frame;
    std::uint64_t seed = 1;
    FramePixels reference; ///< in submission order, without time
    /// Fragments drawn onto each pixel of the k-buffer in one geometry pass; of several samples the most.
    std::vector<std::uint32_t> depth_complexity;
    std::vector<pipeline::RunResult> runs;         ///< in the order in which the designs were asked for
    std::vector<VariantFacts> variants;            ///< of each run
    std::vector<sim::JsonValue> design_parameters; ///< of each run
    std::vector<sim::JsonValue> design_support;    ///< what it can be used for, of each run
    std::vector<FramePixels> pixels;               ///< of each run
    std::optional<EqualArea> equal_area;
    std::string same_runs; ///< which designs have the numbers of another one, and why; empty where all were run
    HostCost host;

    std::uint32_t width() const { return frame->view.width; }
    std::uint32_t height() const { return frame->view.height; }
    std::uint32_t samples() const { return frame->view.samples; }
    /// The run that others are compared with: unprotected hardware whose stores become visible when they are written
    /// back; where there is none, the first.
    std::size_t base_run() const;
    /// The k-buffer, hazards and fragments per pixel are those of another view than the picture.
    bool has_light_view() const { return frame->kbuffer_seen_from_elsewhere(); }
};

} // namespace reports
