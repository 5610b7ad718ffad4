// Several k-buffer designs on one frame: what they have in common is computed once, then each design replays it.
#pragma once

#include "models/kbuffers/library.hpp"
#include "pipeline/gpu_params.hpp"
#include "pipeline/reference.hpp"
#include "reports/comparison_result.hpp"
#include "reports/design_variant.hpp"
#include "sim/observer.hpp"
#include "traces/scene.hpp"
#include "traces/trace.hpp"
#include "traces/workloads.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reports {

/// What a user asks for, in the words of the command line.
struct ComparisonRequest {
    std::string scene;           ///< as traces::load_scene takes it
    std::string camera = "auto"; ///< as traces::make_view takes it
    std::uint32_t width = 512, height = 512;
    std::uint32_t samples = 1; ///< of a pixel: 1, 4 or 8
    traces::WorkloadChoice workload;
    std::vector<std::string> workload_settings; ///< "key=value"
    /// The scene is a draw trace, and its frame is drawn: all from camera to workload_settings are its own.
    bool replay = false;
    traces::ReplayOptions replayed; ///< what of a recording
    std::string gpu = "neutral";
    std::vector<std::string> gpu_settings; ///< "section.key=value"; also parameters of designs
    std::vector<std::string> designs;      ///< at least one, each a DesignVariant, no duplicates
    bool only_able_designs = false;        ///< leave out those that cannot run the frame's program, instead of ending
    bool first_able_design = false;        ///< ... and all but the first of the others
    /// Every design has so many bytes on chip, its tile caches what is left beside all else; 0: as many as the largest.
    std::optional<std::uint64_t> equal_area;
    std::uint64_t seed = 1;
    unsigned threads = 0; ///< 0 = all cores
};

/// How far a comparison is; written by it, read by whoever shows it.
struct Progress {
    enum class Phase : std::uint8_t { reading, shading, reference, simulating, writing, measuring, tracing };
    std::atomic<Phase> phase = Phase::reading;
    std::atomic<double> share = 0;             ///< of the shading, the measurements or the rays, 0 to 1
    std::atomic<std::uint64_t> quads_done = 0; ///< of all designs together
    std::atomic<std::uint64_t> quads_total = 0;
};

/// Whoever started a comparison can watch and end it; all may be null.
struct Supervision {
    const std::atomic<bool>* stop = nullptr; ///< becomes true: sim::Interrupted is thrown soon
    Progress* progress = nullptr;
    sim::Observer* observer = nullptr; ///< sees the run; for comparisons of one design only
};

/// The next phase begins. Throws sim::Interrupted when it shall not.
void enter(const Supervision& supervision, Progress::Phase phase);

/// What the process is doing, as far as enter() was told: "shading the frame".
std::string_view latest_activity();

/// The frame as the application submits it for designs that ask for another order or for batches.
struct SubmittedFrame {
    pipeline::SubmissionPlan plan;
    pipeline::Frame frame;
    std::vector<pipeline::FragmentStream> streams;
    pipeline::ReferenceImage reference;
};

/// A row of a comparison: a design and the GPU it runs on.
struct ComparedDesign {
    DesignVariant variant;
    std::string name; ///< of row, column and folder
    std::shared_ptr<const pipeline::KBufferDesign> design;
    pipeline::GpuParams gpu;
    sim::JsonValue gpu_changes{};                              ///< what differs from the comparison's GPU
    std::shared_ptr<const SubmittedFrame> submitted = nullptr; ///< where the design takes the frame as it is
};

/// The runs, and all that they share. Immutable while they run.
struct ComparisonInput {
    SceneFacts scene;
    GpuFacts gpu;
    std::shared_ptr<const pipeline::Frame> frame;
    std::vector<pipeline::FragmentStream> streams; ///< one per draw pass
    pipeline::ReferenceImage reference;
    std::vector<ComparedDesign> designs;
    std::optional<EqualArea> equal_area;
    std::uint64_t seed = 1;
    unsigned threads = 1; ///< at least 1
    double seconds = 0;   ///< host time that making all this took
    double front_end_seconds = 0;
};

/// Checks the request, reads the scene, shades the frame and computes the reference. Throws sim::InputError with one
/// line for anything the user got wrong; what is cheap to check comes first.
ComparisonInput prepare(const ComparisonRequest& request, const Supervision& supervision = {});

/// Runs every design, several at once. Everything but `host` is the same for any number of threads.
Comparison compare(ComparisonInput input, const Supervision& supervision = {});

/// What a report says of a scene and of the frame that shows it. `notes` are added to those of both.
SceneFacts facts_of(const traces::Scene& scene, const std::string& camera, const pipeline::Frame& frame,
                    const std::vector<std::string>& notes);

/// The threads that 0 stands for.
unsigned core_count();

} // namespace reports
