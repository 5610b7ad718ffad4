// A scene, ready to be replayed: frame, streams and reference, made once and run with any design.
#pragma once

#include "models/kbuffers/library.hpp"
#include "pipeline/functional/frame_streams.hpp"
#include "pipeline/machine.hpp"
#include "reports/stability/replay.hpp"
#include "sim/config.hpp"
#include "traces/camera.hpp"
#include "traces/scene.hpp"
#include "traces/workloads.hpp"

#include <string>
#include <vector>

namespace support {

using reports::stability::ReplayOptions;

class Replay : public reports::stability::Replay {
  public:
    using reports::stability::Replay::Replay;

    /// The designs that can run the frame's program, or all where it has none.
    std::vector<std::string> designs() const;

    /// The stream of the k-buffer pass.
    const pipeline::FragmentStream& kbuffer_stream() const;
};

/// What a pass hands on whose tasks are whole groups of sample quads, if `multisampled`; else sample quads.
struct TaskCounts {
    std::uint64_t tasks = 0, covered = 0, alive = 0; ///< pixels of which any sample is covered, or alive
};
TaskCounts count_tasks(const pipeline::FragmentStream& stream, bool multisampled);
/// The pass is multisampled in this design.
bool multisampled(const Replay& replay, const pipeline::Pass& pass, const std::string& design);

/// Per place in row order: the quads with a living fragment there, in raster order.
std::vector<std::vector<pipeline::QuadId>> quads_by_pixel(const pipeline::FragmentStream& stream);

/// The ids of all designs.
std::vector<std::string> design_ids();

/// Hazards cannot happen in it.
bool protects(const std::string& design);
/// It shows all that the program keeps, however many fragments a pixel gets.
bool holds_everything(const std::string& design);
/// The triangles come as the scene has them.
bool keeps_submission(const std::string& design);

/// Counters of the pass whose name begins with `name`, as the design executed it.
const pipeline::PassResult& pass_named(const pipeline::RunResult& run, const std::string& name);

/// A counter by its path, for example counter(run.stages, "rop/counters/fragments").
std::uint64_t counter(const nlohmann::ordered_json& json, const std::string& path);

/// Where two runs first differ in anything but the cost of the run itself; empty when they are equal.
std::string difference(const pipeline::RunResult& a, const pipeline::RunResult& b);

/// A file of the further scenes (see support/paths.hpp); empty when it is not there.
std::string shared_scene(const std::string& name);
/// The scene of ./demo, once that was made; else empty.
std::string demo_scene();

} // namespace support
