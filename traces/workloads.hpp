// Rendering methods: each turns a scene into a frame, through a pass graph. One file per method in workloads/.
#pragma once

#include "pipeline/frame.hpp"
#include "sim/described.hpp"
#include "sim/json_value.hpp"
#include "traces/scene.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

/// Parameters of a workload by name; what is not named keeps its default. `values["k"] = 8`, or set("k=8").
struct WorkloadOptions {
    sim::JsonValue values;

    /// "key=value" as on the command line. Throws sim::InputError when there is no key.
    void set(std::string_view assignment);
};

/// A parameter that trades quality for time, and values worth trying.
struct QualityKnob {
    std::string parameter;
    std::vector<std::string> values; ///< as set() takes them
};

struct Workload {
    std::string id;
    std::string summary; ///< one line
    std::vector<sim::FieldInfo> parameters;
    std::function<pipeline::Frame(const Scene&, const pipeline::View&, const WorkloadOptions&)> build;
    std::vector<QualityKnob> quality; ///< of workloads whose truth is known

    /// Itself, with these knobs.
    Workload with(std::vector<QualityKnob> knobs) && {
        quality = std::move(knobs);
        return std::move(*this);
    }
};

/// All workloads, in the order in which help lists them.
const std::vector<Workload>& workloads();

/// Throws sim::InputError for an unknown workload, naming what is near.
const Workload& workload_named(const std::string& workload);

/// The frame of a workload. Throws sim::InputError for an unknown workload or parameter (naming what is near) and for
/// values out of range.
pipeline::Frame build_frame(const Scene& scene, const pipeline::View& view, const std::string& workload,
                            const WorkloadOptions& options = {});

} // namespace traces
