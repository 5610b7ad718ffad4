// A scene, ready to be replayed: frame, streams and reference, made once and run with any design.
#pragma once

#include "pipeline/frame.hpp"
#include "pipeline/machine.hpp"
#include "traces/scene.hpp"
#include "traces/workloads.hpp"

#include <string>
#include <vector>

namespace reports::stability {

struct ReplayOptions {
    std::uint32_t width = 128, height = 128;
    traces::WorkloadChoice workload = {};
    std::string camera = "auto";
    std::vector<std::string> knobs = {}; ///< of the workload: "k=4", "entry=z"
    unsigned threads = 0;                ///< of the functional front end; 0 = all cores
    std::uint32_t samples = 1;           ///< of a pixel
};

class Replay {
  public:
    explicit Replay(const std::string& scene, const ReplayOptions& options = {});
    explicit Replay(traces::Scene scene, ReplayOptions options = {});

    /// `settings` are assignments as on the command line: "existing.visibility=rop_cache", "fragment.pipes=1".
    pipeline::RunResult run(const std::string& design, const std::vector<std::string>& settings = {},
                            pipeline::MachineOptions options = {}) const;

    traces::Scene scene;
    ReplayOptions options;
    pipeline::Frame frame;
    std::vector<pipeline::FragmentStream> streams;
    pipeline::ReferenceImage reference;
};

} // namespace reports::stability
