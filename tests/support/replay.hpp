// A scene, ready to be replayed: frame, streams and reference, made once and run with any design.
#pragma once

#include "models/kbuffers/library.hpp"
#include "pipeline/functional/front_end.hpp"
#include "pipeline/machine.hpp"
#include "sim/config.hpp"
#include "traces/camera.hpp"
#include "traces/scene.hpp"
#include "traces/workloads.hpp"

#include <string>
#include <vector>

namespace support {

struct ReplayOptions {
    std::uint32_t            width = 128, height = 128;
    std::string              workload = "transparency";
    std::string              camera   = "auto";
    std::vector<std::string> knobs; ///< of the workload: "k=4", "entry=z"
};

class Replay {
  public:
    explicit Replay(const std::string& scene, const ReplayOptions& options = {});

    /// `settings` are assignments as on the command line: "existing.visibility=rop_cache", "fragment.pipes=1".
    pipeline::RunResult run(const std::string& design, const std::vector<std::string>& settings = {},
                            pipeline::MachineOptions options = {}) const;

    pipeline::Frame                        frame;
    std::vector<pipeline::FragmentStream>  streams;
    pipeline::ReferenceImage               reference;
};

/// Streams of all draw passes of a frame.
std::vector<pipeline::FragmentStream> rasterize_frame(const pipeline::Frame& frame, unsigned threads = 0);

} // namespace support
