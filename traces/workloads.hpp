// Rendering methods: each turns a scene into a frame, through a pass graph. One file per method in workloads/.
//
// What else a method declares about itself (truth, knobs, options, examples) serves every command; none of them knows a
// method by its name.
#pragma once

#include "pipeline/frame.hpp"
#include "sim/described.hpp"
#include "sim/json_value.hpp"
#include "traces/rays.hpp"
#include "traces/scene.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace traces {

/// Parameters of a workload by name; what is not named keeps its default. `values["k"] = 8`, or set("k=8").
struct WorkloadOptions {
    sim::JsonValue values;

    /// "key=value" as on the command line. Throws sim::InputError when there is no key.
    void set(std::string_view assignment);
    /// All of a list.
    static WorkloadOptions of(const std::vector<std::string>& assignments);
};

/// A parameter that trades quality for time, and values worth trying.
struct QualityKnob {
    std::string parameter;
    std::vector<std::string> values; ///< as set() takes them
};

/// What of a method's pictures tells how good they are.
enum class Measured : std::uint8_t {
    colours, ///< red, green and blue
    light    ///< alpha: the share of the truth's light that the surface of a pixel sees
};

/// A parameter with an option of its own on the command line, `--parameter VALUE`, in front of `--set
/// workload.parameter`. One declaration serves all workloads that have a parameter of the name.
struct ParameterOption {
    std::string parameter;
    std::string value; ///< what help calls it: "NAME"
    std::string help;
};

/// A use worth showing in the help of a command.
struct Example {
    std::string command;   ///< "truth"
    std::string arguments; ///< behind it
};

/// The mean of many frames of the workload itself with cheaper settings: what its usual settings compete with.
struct Averaging {
    std::string what;                    ///< what is averaged: "hard shadows"
    std::vector<std::string> drawn_once; ///< passes that the frames share, so that their time counts once
    /// The settings of each of `count` frames, in place of the given ones. `frame` has these.
    std::function<std::vector<std::vector<std::string>>(const Scene&, const pipeline::Frame& frame,
                                                        const WorkloadOptions&, std::uint32_t count)>
        settings;
};

/// A parameter that may name a user's program, and those that say of how many entries and of which opacity.
struct ProgramParameter {
    std::string program, k, opacity;
};

struct Workload {
    std::string id;
    std::string summary; ///< one line
    std::vector<sim::FieldInfo> parameters;
    std::function<pipeline::Frame(const Scene&, const pipeline::View&, const WorkloadOptions&)> build;
    /// How rays make its picture; empty: nobody knows. The frame is that of the same scene and parameters. Throws
    /// sim::InputError where these parameters have no truth.
    std::function<TruthMethod(const Scene&, const pipeline::Frame&, const WorkloadOptions&)> truth = {};
    /// The value of every parameter, those that were not given included: what a default of another version cannot
    /// change.
    std::function<sim::JsonValue(const WorkloadOptions&)> all_parameters = {};
    std::vector<ProgramParameter> program_parameters = {};
    bool reads_maps = false; ///< of materials, beside their colours; captured traces leave them out else
    Measured measured = Measured::colours;
    std::vector<QualityKnob> quality = {};
    std::optional<Averaging> averaging = {};
    std::vector<ParameterOption> options = {};
    std::vector<Example> examples = {};
};

/// All workloads, in the order in which help lists them.
const std::vector<Workload>& workloads();

/// Of workloads(): what is drawn where nobody says how.
const std::string& usual_workload();

/// Throws sim::InputError for an unknown workload, naming what is near.
const Workload& workload_named(const std::string& workload);

/// A workload by its name, or one from outside of the library; the usual one unless said otherwise.
class WorkloadChoice {
  public:
    WorkloadChoice() : name_(usual_workload()) {}
    WorkloadChoice(std::string name) : name_(std::move(name)) {}
    WorkloadChoice(const char* name) : name_(name) {}
    WorkloadChoice(Workload own) : name_(own.id), own_(std::make_shared<const Workload>(std::move(own))) {}

    const std::string& name() const { return name_; }
    /// Throws sim::InputError as workload_named() does.
    const Workload& get() const { return own_ ? *own_ : workload_named(name_); }

  private:
    std::string name_;
    std::shared_ptr<const Workload> own_;
};

/// The frame of a workload. Throws sim::InputError for an unknown workload or parameter (naming what is near) and for
/// values out of range.
pipeline::Frame build_frame(const Scene& scene, const pipeline::View& view, const WorkloadChoice& workload,
                            const WorkloadOptions& options = {});

/// What rays have to do for the frame that build_frame() made of the same. Throws sim::InputError where nobody knows,
/// naming the workloads of which it is known.
TruthMethod truth_method(const Scene& scene, const pipeline::Frame& frame, const WorkloadChoice& workload,
                         const WorkloadOptions& options = {});

} // namespace traces
